#include <fmt/format.h>

#include "app/cli/command.h"
#include "app/cli/output.h"

namespace curvewright::cli {
namespace {

struct Options {
    std::filesystem::path mesh;
    OutputOptions output;
    bool flip = false;
};

int run(const Options& options, const Invocation& invocation, const TaskContext& context) {
    const Stopwatch watch;
    Json timings = Json::object();
    CurvedMesh mesh = read_input(options.mesh, invocation, context, timings).mesh;
    if (options.flip) mesh = flip_orientation(mesh);
    std::optional<QualityReport> quality;
    const auto format = options.output.format ? options.output.format : format_of_suffix(options.output.file);
    if ((format == MeshFormat::vtu || format == MeshFormat::vtk) && is_assessable(mesh))
        quality = certify(mesh, context, timings);
    write_output(options.output, mesh, quality ? &*quality : nullptr, nullptr, timings);
    finish_timings(timings, watch);
    if (invocation.common.json)
        fmt::print("{}\n",
                   Json({{"mesh", mesh_json(options.output.file, mesh)}, {"timings", timings}}).dump(2));
    else fmt::print("{}: {}\n", options.output.file.string(), mesh_line(mesh));
    return exit_done;
}

}  // namespace

void add_convert(CLI::App& app, Invocation& invocation) {
    auto* command = add_command(app, invocation, "convert", "Write the mesh in another format; nothing moves");
    auto options = std::make_shared<Options>();
    command->add_option("mesh", options->mesh, "Mesh")->required()->type_name("IN");
    add_output_options(*command, options->output, true);
    command->add_flag("--flip", options->flip, "Number the elements the other way round (clockwise meshes)");
    command->callback([&invocation, options] {
        invocation.action = [options](const Invocation& i, const TaskContext& context) {
            return run(*options, i, context);
        };
    });
}

}  // namespace curvewright::cli
