#include "benchmarks/thesis/peers.h"

#include <fstream>
#include <utility>

#include "core/base/error.h"

namespace curvewright::benchmarks {
namespace {

/// Fields between commas; a field in quotation marks may have commas.
std::vector<std::string> fields_of(const std::string& line) {
    std::vector<std::string> fields(1);
    bool is_quoted = false;
    for (const char c : line) {
        if (c == '"')
            is_quoted = !is_quoted;
        else if (c == ',' && !is_quoted)
            fields.emplace_back();
        else
            fields.back() += c;
    }
    return fields;
}

}  // namespace

Peers::Peers(const std::filesystem::path& file) {
    std::ifstream stream(file);
    if (!stream) throw InvalidInput(file.string() + " cannot be read.");
    bool has_header = false;
    long number = 0;
    for (std::string line; std::getline(stream, line);) {
        ++number;
        if (line.empty() || line.front() == '#') continue;
        const auto fields = fields_of(line);
        if (fields.size() != 9) throw InvalidInput(file.string(), number, "9 fields were expected.");
        if (!std::exchange(has_header, true)) continue;
        try {
            PeerResult result{fields[0], std::stoi(fields[1]), fields[2],
                              fields[3], std::stod(fields[4]), std::stod(fields[5]),
                              {},        std::stoi(fields[7]), std::stod(fields[8])};
            if (!fields[6].empty()) result.largest = std::stod(fields[6]);
            results_.push_back(std::move(result));
        } catch (const std::logic_error&) {
            throw InvalidInput(file.string(), number, "a field is no number.");
        }
    }
}

const PeerResult* Peers::best(const std::string& sample) const {
    const PeerResult* best = nullptr;
    for (const PeerResult& result : results_)
        if (result.sample == sample && result.not_valid == 0 && (!best || result.least > best->least)) best = &result;
    return best;
}

const PeerResult* Peers::quickest(const std::string& sample) const {
    const PeerResult* best = nullptr;
    for (const PeerResult& result : results_)
        if (result.sample == sample && result.not_valid == 0 && (!best || result.seconds < best->seconds))
            best = &result;
    return best;
}

const PeerResult* Peers::find(const std::string& sample, const std::string& setting) const {
    for (const PeerResult& result : results_)
        if (result.sample == sample && result.setting == setting) return &result;
    return nullptr;
}

}  // namespace curvewright::benchmarks
