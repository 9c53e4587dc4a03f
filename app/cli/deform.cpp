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
    const Stopwatch watch;
    Json timings = Json::object();
    const CurvedMesh input = read_input(options.mesh, invocation, context, timings).mesh;
    const Deformation deformation = read_deformation(options.deformation, context);
    const Stopwatch deforming;
    const CurvedMesh mesh = input.with_coordinates(apply_deformation(input, deformation));
    timings["deform"] = deforming.seconds();
    long moved = 0;
    for (Index node = 0; node < mesh.topology().node_count(); ++node)
        if (mesh.coordinates().row(node) != input.coordinates().row(node)) ++moved;
    // Only the VTK formats carry the quality; for MSH it would be work for nothing.
    std::optional<QualityReport> quality;
    const auto format = options.output.format ? options.output.format : format_of_suffix(options.output.file);
    if ((format == MeshFormat::vtu || format == MeshFormat::vtk) && is_assessable(mesh))
        quality = certify(mesh, context, timings);
    write_output(options.output, mesh, quality ? &*quality : nullptr, &input.coordinates(), timings);
    finish_timings(timings, watch);
    if (invocation.common.json)
        fmt::print("{}\n", Json({{"mesh", mesh_json(options.output.file, mesh)},
                                 {"moved_nodes", moved},
                                 {"timings", timings}})
                               .dump(2));
    else fmt::print("{}: {} nodes moved\n", options.output.file.string(), moved);
    return exit_done;
}

}  // namespace

void add_deform(CLI::App& app, Invocation& invocation) {
    auto* command = add_command(app, invocation, "deform", "Move the boundary nodes only; the interior stays");
    auto options = std::make_shared<Options>();
    command->add_option("mesh", options->mesh, "Mesh")->required()->type_name("IN");
    command->add_option("--deformation", options->deformation, "Operations (.json), node table (.csv) or a mesh")
        ->required()
        ->type_name("D");
    add_output_options(*command, options->output);
    command->callback([&invocation, options] {
        invocation.action = [options](const Invocation& i, const TaskContext& context) {
            return run(*options, i, context);
        };
    });
}

}  // namespace curvewright::cli
