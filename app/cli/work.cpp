#include "app/cli/work.h"

#include <algorithm>

#include <fmt/format.h>

#include "core/base/sha256.h"

namespace curvewright::cli {

void Work::note(const std::string& sentence) {
    if (std::find(notes_.begin(), notes_.end(), sentence) != notes_.end()) return;
    notes_.push_back(sentence);
    if (!is_quiet()) fmt::print(stderr, "{}\n", sentence);
}

void Work::notes(const std::string& prefix, const std::vector<std::string>& sentences) {
    for (const std::string& sentence : sentences) note(fmt::format("{}: {}", prefix, sentence));
}

void Work::add(const std::string& phase, double seconds) {
    timings_[phase] = timings_.value(phase, 0.0) + seconds;
}

void Work::end_phase(const std::string& phase) {
    end_phase(phase, {});
}

void Work::end_phase(const std::string& phase, const std::vector<std::pair<std::string, double>>& parts) {
    const double now = watch_.seconds();
    double rest = now - phase_began_;
    for (const auto& [name, seconds] : parts) {
        add(name, seconds);
        rest -= seconds;
    }
    add(phase, std::max(rest, 0.0));
    phase_began_ = now;
}

void Work::set_input(const std::filesystem::path& file) {
    if (!input_.empty()) return;
    input_ = file;
    std::error_code ignored;
    input_time_ = std::filesystem::last_write_time(file, ignored);
}

Provenance Work::provenance() const {
    Provenance provenance;
    provenance.version = CURVEWRIGHT_VERSION;
    provenance.command = invocation_.command;
    provenance.input = input_.filename().string();
    std::error_code ignored;
    // A pipe has no content any more, and a file that was written meanwhile is another one.
    if (std::filesystem::is_regular_file(input_, ignored) &&
        std::filesystem::last_write_time(input_, ignored) == input_time_)
        provenance.input_sha256 = sha256_of_file(input_);
    return provenance;
}

void Work::print(Json json) {
    end_phase("finish");
    json["notes"] = notes_;
    json["timings"] = timings_;
    json["timings"]["total"] = watch_.seconds();
    fmt::print("{}\n", json.dump(2, ' ', false, Json::error_handler_t::replace));
}

}  // namespace curvewright::cli
