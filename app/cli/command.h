#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include <CLI/CLI.hpp>
#include <nlohmann/json_fwd.hpp>

#include "core/base/task.h"
#include "core/io/mesh_io.h"

namespace curvewright::cli {

/// Exit statuses, part of the interface.
enum ExitStatus {
    exit_done = 0,
    exit_bad_input = 1,
    exit_wrong_usage = 2,
    exit_not_valid = 3,        ///< done, but elements are invalid or undecided
    exit_less_than_asked = 4,  ///< done and valid, but less than was asked for explicitly
    exit_cancelled = 130
};

/// What every command takes.
struct CommonOptions {
    bool json = false;
    bool quiet = false;
    int threads = 0;  ///< 0 = one per processor
};

/// What the user asked for: filled by the options of the chosen command; action runs it and gives the exit status.
struct Invocation {
    CommonOptions common;
    /// What files record of it (see recorded_command.h).
    std::string command;
    std::function<int(const Invocation&, const TaskContext&)> action;
};

/// Input mesh.
struct InputOptions {
    std::filesystem::path file;
    /// Nodes closer than that are merged, relative to the mesh's size. Not given: only where no elements touch.
    std::optional<double> merge_tolerance;
    bool reorients = false;  ///< --reorient
};

/// Output file and its format.
struct OutputOptions {
    std::filesystem::path file;
    std::optional<MeshFormat> format;
    bool binary = false;

    WriteOptions write_options(const QualityReport* quality, const Coordinates* reference) const;
};

/// Adds a sub-command with the common options.
CLI::App* add_command(CLI::App& app, Invocation& invocation, const std::string& name, const std::string& description);
/// Adds -o/--output (or a positional, for convert), --format and --binary.
void add_output_options(CLI::App& command, OutputOptions& options, bool is_positional = false);

/// Adds the input mesh, a required positional, and --reorient.
void add_input_option(CLI::App& command, InputOptions& input, const std::string& placeholder = "IN");
/// Adds --deformation, required.
void add_deformation_option(CLI::App& command, std::filesystem::path& file);

class Work;
/// run(work) with the work of a command.
int run_command(const std::function<int(Work&)>& run, const Invocation& invocation, const TaskContext& context);

/// Makes run(options, …) what happens when the command is chosen. options is filled by the command's options.
template <class Options>
void set_action(CLI::App& command, Invocation& invocation, std::shared_ptr<Options> options,
                int (*run)(const Options&, Work&)) {
    command.callback([&invocation, options, run] {
        invocation.action = [options, run](const Invocation& i, const TaskContext& context) {
            return run_command([&](Work& work) { return run(*options, work); }, i, context);
        };
    });
}

// One per file.
void add_info(CLI::App& app, Invocation& invocation);
void add_quality(CLI::App& app, Invocation& invocation);
void add_histogram(CLI::App& app, Invocation& invocation);
void add_elevate(CLI::App& app, Invocation& invocation);
void add_deform(CLI::App& app, Invocation& invocation);
void add_warp(CLI::App& app, Invocation& invocation);
void add_untangle(CLI::App& app, Invocation& invocation);
void add_improve(CLI::App& app, Invocation& invocation);
void add_convert(CLI::App& app, Invocation& invocation);
void add_compare(CLI::App& app, Invocation& invocation);
void add_render(CLI::App& app, Invocation& invocation);
void add_replay(CLI::App& app, Invocation& invocation);
void add_animate(CLI::App& app, Invocation& invocation);

}  // namespace curvewright::cli
