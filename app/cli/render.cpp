#include <cstdio>
#include <optional>

#include <fmt/format.h>

#include "app/cli/command.h"
#include "app/cli/output.h"
#include "app/cli/render_colors.h"
#include "core/base/error.h"
#include "ui/scene/offscreen.h"

namespace curvewright::cli {
namespace {

struct Options {
    std::filesystem::path mesh, output;
    int width = 1200, height = 900;
    PictureGround ground = PictureGround::background;
    SceneOptions scene;
    std::optional<double> clip_position;
    RenderColors colors;
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
    const ReadResult input = read_input(options.mesh, invocation, context, timings);
    const CurvedMesh& mesh = input.mesh;
    const Coloring coloring = find_coloring(options.colors, input, context);
    if (options.output.extension() != ".png")
        throw InvalidInput(options.output.string(), 0, "pictures are written as .png.");
    std::optional<QualityReport> quality;
    if (is_assessable(mesh)) quality = certify(mesh, context, timings);
    const Stopwatch rendering;
    MeshScene scene;
    SceneOptions scene_options = options.scene;
    scene_options.font = find_text_font();
    scene_options.pixel_ratio = std::max(1.0, options.height / 900.0);
    if (ClipPlane* clip = scene_options.clip ? &*scene_options.clip : nullptr; clip && options.clip_position) {
        const bool is_flipped = clip->normal[0] + clip->normal[1] + clip->normal[2] < 0.0;
        clip->position = is_flipped ? 1.0 - *options.clip_position : *options.clip_position;
    }
    if (mesh.topology().dimension() != 3) scene_options.clip.reset();
    scene.set_options(scene_options);
    scene.set_coloring(coloring);
    scene.set_mesh(&mesh, quality ? &*quality : nullptr);
    render_png(scene, options.width, options.height, options.output, options.ground);
    timings["render"] = rendering.seconds();
    finish_timings(timings, watch);
    if (invocation.common.json)
        print_json(
            {{"mesh", mesh_json(options.mesh, mesh)},
             {"picture", {{"file", options.output.string()}, {"width", options.width}, {"height", options.height}}},
             {"colors", colors_json(options.colors, scene.shown_scale())},
             {"timings", timings}});
    else
        fmt::print("{}: {} x {} pixels\n", options.output.string(), options.width, options.height);
    return exit_done;
}

}  // namespace

void add_render(CLI::App& app, Invocation& invocation) {
    auto* command = add_command(app, invocation, "render",
                                "Picture of the mesh, coloured by scaled Jacobian or an array of the file");
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
    command->add_flag("--node-numbers", options->scene.show_node_numbers, "Write the tags of the nodes beside them");
    command->add_flag("--element-numbers", options->scene.show_element_numbers,
                      "Write the tags of the elements on them");
    command->add_flag("--orthographic", options->scene.is_orthographic,
                      "3D: parallel projection instead of perspective");
    const auto add_clip = [&](const char* name, ClipStyle style, const char* help) {
        return command
            ->add_option_function<std::string>(
                name,
                [options, style](const std::string& axis) {
                    ClipPlane plane;
                    plane.normal = {0.0, 0.0, 0.0};
                    // A section is on the side of the eye, which looks from +x, -y and +z.
                    const bool is_flipped = style == ClipStyle::cut && axis == "y";
                    plane.normal[static_cast<std::size_t>(axis[0] - 'x')] = is_flipped ? -1.0 : 1.0;
                    plane.style = style;
                    options->scene.clip = plane;
                },
                help)
            ->check(CLI::IsMember({"x", "y", "z"}));
    };
    CLI::Option* clip = add_clip("--clip", ClipStyle::whole_elements,
                                 "3D: hide the elements beyond a plane across x, y or z (in the middle)");
    CLI::Option* cut =
        add_clip("--cut", ClipStyle::cut, "3D: cut through the elements at that plane and show the section");
    cut->excludes(clip);
    command
        ->add_option("--clip-at", options->clip_position,
                     "Where the plane of --clip or --cut stands: fraction of the mesh's extent (default 0.5)")
        ->check(CLI::Range(0.0, 1.0));
    command->parse_complete_callback([command] {
        if (command->count("--clip-at") > 0 && command->count("--clip") + command->count("--cut") == 0)
            throw CLI::ValidationError("--clip-at", "is for --clip or --cut");
    });
    add_color_options(*command, options->colors);
    set_action(*command, invocation, options, run);
}

}  // namespace curvewright::cli
