#pragma once

#include <filesystem>
#include <initializer_list>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "app/cli/command.h"
#include "core/base/stopwatch.h"
#include "core/io/provenance.h"

namespace curvewright::cli {

using Json = nlohmann::ordered_json;

/// A command at work: what it was asked, the notes it has for the user, and where its time goes.
class Work {
  public:
    Work(const Invocation& invocation, const TaskContext& context) : invocation_(invocation), context_(context) {}

    const TaskContext& context() const { return context_; }
    /// From now on the work goes on to its end whatever the user asks: what was reached so far is to be kept.
    void ignore_stop() { context_.stop = {}; }
    bool is_json() const { return invocation_.common.json; }
    /// The command as files record it (see recorded_command.h).
    const std::string& command() const { return invocation_.command; }
    bool is_quiet() const { return invocation_.common.quiet; }

    /// One sentence that the user should know besides the result: on standard error at once, unless --quiet, and among
    /// the "notes" of --json in any case.
    void note(const std::string& sentence);
    void notes(const std::string& prefix, const std::vector<std::string>& sentences);

    /// The time since the last phase ended, or since the start, belongs to this one, so that the phases add up to the
    /// total. A phase may end several times.
    void end_phase(const std::string& phase);
    /// The same, but parts of the time (seconds) have names of their own.
    void end_phase(const std::string& phase, const std::vector<std::pair<std::string, double>>& parts);
    /// Seconds by phase; without the total.
    const Json& timings() const { return timings_; }
    double seconds(const std::string& phase) const { return timings_.value(phase, 0.0); }

    /// The mesh that the command works on, for the provenance of what it writes; the first one counts. To be
    /// called before it is read.
    void set_input(const std::filesystem::path& file);
    /// Who makes what is written: this program, the command, and the input with the hash of its bytes.
    Provenance provenance() const;

    /// Prints the result as one JSON object on standard output, with "notes" and "timings" at its end. Bytes that are
    /// no UTF-8 (in file or group names) become U+FFFD.
    void print(Json json);

  private:
    void add(const std::string& phase, double seconds);

    const Invocation& invocation_;
    TaskContext context_;
    std::vector<std::string> notes_;
    std::filesystem::path input_;
    std::filesystem::file_time_type input_time_{};  ///< before it was read
    Json timings_ = Json::object();
    Stopwatch watch_;
    double phase_began_ = 0.0;
};

}  // namespace curvewright::cli
