#include <fmt/format.h>

#include "app/cli/command.h"
#include "app/cli/output.h"
#include "core/io/deformation_file.h"

namespace curvewright::cli {
namespace {

struct Options {
    std::filesystem::path mesh, deformation;
    OutputOptions output;
};

int run(const Options& options, const Invocation& invocation, const TaskContext& context) {
    check_output(options.output);
    const Stopwatch watch;
    Json timings = Json::object();
    const ReadResult read = read_input(options.mesh, invocation, context, timings);
    const CurvedMesh& input = read.mesh;
    const Deformation deformation = read_deformation(options.deformation, context);
    const Stopwatch deforming;
    const CurvedMesh mesh = input.with_coordinates(apply_deformation(input, deformation));
    timings["deform"] = deforming.seconds();
    long moved = 0;
    for (Index node = 0; node < mesh.topology().node_count(); ++node)
        if (mesh.coordinates().row(node) != input.coordinates().row(node)) ++moved;
    const auto quality = certify_for(options.output, mesh, context, timings);
    write_output(options.output, mesh, read.fields, quality ? &*quality : nullptr, &input.coordinates(), invocation,
                 timings);
    finish_timings(timings, watch);
    if (invocation.common.json)
        print_json({{"mesh", mesh_json(options.output.file, mesh)}, {"moved_nodes", moved}, {"timings", timings}});
    else
        fmt::print("{}: {} nodes moved\n", options.output.file.string(), moved);
    return exit_done;
}

}  // namespace

void add_deform(CLI::App& app, Invocation& invocation) {
    auto* command = add_command(app, invocation, "deform", "Move the boundary nodes only; the interior stays");
    auto options = std::make_shared<Options>();
    add_input_option(*command, options->mesh);
    add_deformation_option(*command, options->deformation);
    add_output_options(*command, options->output);
    set_action(*command, invocation, options, run);
}

}  // namespace curvewright::cli
