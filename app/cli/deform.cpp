#include <fmt/format.h>

#include "app/cli/command.h"
#include "app/cli/global_check.h"
#include "app/cli/output.h"
#include "core/io/deformation_file.h"
#include "core/mesh/conformity.h"

namespace curvewright::cli {
namespace {

struct Options {
    InputOptions input;
    std::filesystem::path deformation;
    OutputOptions output;
};

int run(const Options& options, Work& work) {
    check_output(options.output);
    const ReadResult read = read_input(options.input, work);
    const CurvedMesh& input = read.mesh;
    require_conforming(input, work.context());
    const Deformation deformation = read_deformation(options.deformation, work.context());
    const CurvedMesh mesh = input.with_coordinates(apply_deformation(input, deformation));
    work.end_phase("deform");
    long moved = 0;
    for (Index node = 0; node < mesh.topology().node_count(); ++node)
        if (mesh.coordinates().row(node) != input.coordinates().row(node)) ++moved;
    // Judged with the input's orientation; the interior stays behind, so that elements may be tangled: only what a warp
    // could not mend, a boundary that crosses itself, decides the status.
    Assessment original;
    if (is_assessable(input))
        original.report.emplace().orientation_sign = orientation_sign(find_orientation(input), input);
    const Assessment moved_quality = assess_result(mesh, original, work);
    const auto& quality = moved_quality.report;
    const auto global = check_globally(mesh, moved_quality, work);
    write_output(options.output, mesh, read.fields, quality ? &*quality : nullptr, &input.coordinates(), work);
    if (work.is_json()) {
        Json json = {{"mesh", mesh_json(options.output.file, mesh)}, {"moved_nodes", moved}};
        if (global) global->add_to(json, mesh);
        work.print(json);
    } else {
        fmt::print("{}: {} nodes moved\n", options.output.file.string(), moved);
        if (global) fmt::print("{}\n", global->line());
    }
    return global ? global->boundary_status() : exit_done;
}

}  // namespace

void add_deform(CLI::App& app, Invocation& invocation) {
    auto* command = add_command(app, invocation, "deform", "Move the boundary nodes only; the interior stays");
    auto options = std::make_shared<Options>();
    add_input_option(*command, options->input);
    add_deformation_option(*command, options->deformation);
    add_output_options(*command, options->output);
    set_action(*command, invocation, options, run);
}

}  // namespace curvewright::cli
