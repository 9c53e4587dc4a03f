#include <cstdio>

#include <fmt/format.h>

#include "app/cli/command.h"
#include "app/cli/output.h"
#include "core/base/error.h"
#include "ui/scene/offscreen.h"

namespace curvewright::cli {
namespace {

struct Options {
    std::filesystem::path mesh, output;
    int width = 1200, height = 900;
    PictureGround ground = PictureGround::background;
    SceneOptions scene;
};

/// "WxH".
std::string parse_size(const std::string& text, Options& options) {
    int width = 0, height = 0;
    char rest = 0;
    if (std::sscanf(text.c_str(), "%dx%d%c", &width, &height, &rest) != 2 || width < 16 || height < 16 ||
        width > 16384 || height > 16384)
        return "expected WIDTHxHEIGHT in pixels, 16 to 16384 each, as in 1200x900";
    options.width = width;
    options.height = height;
    return {};
}

int run(const Options& options, const Invocation& invocation, const TaskContext& context) {
    const Stopwatch watch;
    Json timings = Json::object();
    const CurvedMesh mesh = read_input(options.mesh, invocation, context, timings).mesh;
    if (options.output.extension() != ".png")
        throw InvalidInput(options.output.string(), 0, "pictures are written as .png.");
    std::optional<QualityReport> quality;
    if (is_assessable(mesh)) quality = certify(mesh, context, timings);
    const Stopwatch rendering;
    MeshScene scene;
    SceneOptions scene_options = options.scene;
    scene_options.pixel_ratio = std::max(1.0, options.height / 900.0);
    if (mesh.topology().dimension() != 3) scene_options.clip.reset();
    scene.set_options(scene_options);
    scene.set_mesh(&mesh, quality ? &*quality : nullptr);
    render_png(scene, options.width, options.height, options.output, options.ground);
    timings["render"] = rendering.seconds();
    finish_timings(timings, watch);
    if (invocation.common.json)
        print_json(
            {{"mesh", mesh_json(options.mesh, mesh)},
             {"picture", {{"file", options.output.string()}, {"width", options.width}, {"height", options.height}}},
             {"timings", timings}});
    else
        fmt::print("{}: {} x {} pixels\n", options.output.string(), options.width, options.height);
    return exit_done;
}

}  // namespace

void add_render(CLI::App& app, Invocation& invocation) {
    auto* command = add_command(app, invocation, "render", "Picture of the mesh, coloured by scaled Jacobian");
    auto options = std::make_shared<Options>();
    add_input_option(*command, options->mesh, "MESH");
    command->add_option("-o,--output", options->output, "Picture to write")->required()->type_name("PNG");
    command->add_option("--size", "Size in pixels (default 1200x900)")
        ->type_name("WxH")
        ->check([options](const std::string& text) { return parse_size(text, *options); });
    command->add_flag_function(
        "--transparent", [options](std::int64_t) { options->ground = PictureGround::transparent; },
        "No ground: what is not the mesh is transparent");
    command->add_flag("--nodes", options->scene.show_nodes, "Draw the nodes");
    command->add_flag_function(
        "--no-edges", [options](std::int64_t) { options->scene.show_edges = false; },
        "Leave out the edges of the elements");
    command->add_flag_function(
        "--no-legend", [options](std::int64_t) { options->scene.show_legend = false; }, "Leave out the legend");
    command
        ->add_option_function<std::string>(
            "--clip",
            [options](const std::string& axis) {
                ClipPlane plane;
                plane.normal = {0.0, 0.0, 0.0};
                plane.normal[axis[0] - 'x'] = 1.0;
                options->scene.clip = plane;
            },
            "3D: hide the half of the elements beyond the middle in x, y or z")
        ->check(CLI::IsMember({"x", "y", "z"}));
    set_action(*command, invocation, options, run);
}

}  // namespace curvewright::cli
