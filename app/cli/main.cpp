#include <csignal>
#include <cstdio>
#include <exception>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "app/cli/command.h"
#include "app/cli/progress.h"
#include "app/cli/recorded_command.h"
#include "core/base/error.h"
#include "core/base/parallel.h"

namespace {

using namespace curvewright;
using namespace curvewright::cli;

std::stop_source interrupt;

/// The first signal asks the work to stop; a second one ends the program at once, whatever it is doing.
void on_interrupt(int signal) {
    std::signal(signal, SIG_DFL);
    interrupt.request_stop();  // an atomic operation: no callbacks are registered
}

int run(const Invocation& invocation) {
    set_thread_count(invocation.common.threads);
    std::signal(SIGINT, on_interrupt);
    std::signal(SIGTERM, on_interrupt);
    ProgressBar progress(invocation.common.quiet);
    return invocation.action(invocation, {interrupt.get_token(), progress.callback()});
}

}  // namespace

int main(int argc, char** argv) {
    CLI::App app("Warps, untangles, certifies and converts curved high-order meshes.", "curvewright-cli");
    app.set_version_flag("--version", CURVEWRIGHT_VERSION);
    app.require_subcommand(1);
    app.footer(
        "Exit status: 0 done; 1 bad input or a file that cannot be used; 2 wrong usage; 3 done, but elements are "
        "invalid or undecided, or the motion of a warp stopped early; 4 done and valid, but less than was asked for "
        "explicitly.");
    Invocation invocation;
    add_info(app, invocation);
    add_quality(app, invocation);
    add_histogram(app, invocation);
    add_elevate(app, invocation);
    add_deform(app, invocation);
    add_warp(app, invocation);
    add_untangle(app, invocation);
    add_improve(app, invocation);
    add_convert(app, invocation);
    add_compare(app, invocation);
    add_render(app, invocation);
    add_replay(app, invocation);
    add_animate(app, invocation);
    try {
        app.parse(argc, argv);
        invocation.command = recorded_command(*app.get_subcommands().front());
    } catch (const CLI::ParseError& error) {
        // Help and version end with 0; CLI11's own numbers for the rest are not ours.
        return app.exit(error) == 0 ? exit_done : exit_wrong_usage;
    }
    try {
        const int status = run(invocation);
        if (std::fflush(stdout) != 0) throw InvalidInput("Standard output cannot be written.");
        return status;
    } catch (const Cancelled&) {
        fmt::print(stderr, "Cancelled; nothing was written.\n");
        return exit_cancelled;
    } catch (const std::bad_alloc&) {
        fmt::print(stderr, "Out of memory; nothing was written.\n");
        return exit_bad_input;
    } catch (const std::exception& error) {
        fmt::print(stderr, "{}\n", error.what());
        return exit_bad_input;
    }
}
