#include "core/session/replay.h"

#include <algorithm>
#include <iostream>
#include <iterator>

#include <fmt/format.h>

#include "app/cli/command.h"
#include "app/cli/global_check.h"
#include "app/cli/output.h"
#include "core/session/session_file.h"

namespace curvewright::cli {
namespace {

struct Options {
    std::filesystem::path session;
    OutputOptions output;
};

std::vector<Action> read_actions(const std::filesystem::path& session) {
    if (session != "-") return read_session(session);
    const std::string text{std::istreambuf_iterator<char>(std::cin), {}};
    return parse_session(text, "standard input");
}

int run(const Options& options, Work& work) {
    const bool writes = !options.output.file.empty();
    if (writes) check_output(options.output);
    const std::vector<Action> actions = read_actions(options.session);
    Replay replay(options.session == "-" ? std::filesystem::path() : options.session.parent_path());
    for (std::size_t i = 0; i < actions.size(); ++i) {
        work.context().report(fmt::format("Action {} of {}", i + 1, actions.size()),
                              static_cast<double>(i) / static_cast<double>(actions.size()));
        replay.perform(actions[i], {work.context().stop, {}});
    }
    work.end_phase("replay");
    for (const std::string& note : replay.notes()) work.note(note);
    const Assessment before = assess(replay.opened(), work);
    const Assessment quality = assess_result(replay.mesh(), before, work);
    work.set_input(replay.mesh_file());  // after it was read: the session names it
    const auto global = check_globally(replay.mesh(), quality, work);
    if (writes)
        write_output(options.output, replay.mesh(), replay.fields(), quality.report ? &*quality.report : nullptr,
                     &replay.opened().coordinates(), work);
    const std::filesystem::path file = writes ? options.output.file : std::filesystem::path(replay.mesh_file());
    if (work.is_json()) {
        Json json = {{"mesh", mesh_json(file, replay.mesh())}, {"actions", actions.size()}};
        add_assessment(json, quality);
        add_assessment(json["before"], before);
        json["worst"] = quality.report ? worst_json(replay.mesh(), *quality.report) : Json::array();
        if (global) global->add_to(json, replay.mesh());
        work.print(json);
    } else {
        fmt::print("{}: {}\n", file.string(), mesh_line(replay.mesh()));
        fmt::print("{} {} replayed\n", actions.size(), actions.size() == 1 ? "action" : "actions");
        if (quality.report) fmt::print("{}\n", summary_line(quality.report->summary));
        if (global) fmt::print("{}\n", global->line());
    }
    if (!quality.report) return exit_done;
    return worse_status(validity_status(quality.report->summary), global->status());
}

}  // namespace

void add_replay(CLI::App& app, Invocation& invocation) {
    auto* command = add_command(app, invocation, "replay", "Do again what was done in a session of the window");
    auto options = std::make_shared<Options>();
    command->add_option("SESSION", options->session, "Session, one action per line; - = standard input")->required();
    add_output_options(*command, options->output);
    command->get_option("--output")->required(false);
    set_action(*command, invocation, options, run);
}

}  // namespace curvewright::cli
