#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>

#include <fmt/format.h>

#include "app/cli/command.h"
#include "app/cli/output.h"
#include "app/cli/render_colors.h"
#include "app/cli/render_view.h"
#include "core/base/error.h"
#include "core/io/atomic_file.h"
#include "ui/scene/indexed_picture.h"
#include "ui/scene/offscreen.h"

namespace curvewright::cli {
namespace {

struct Options {
    InputOptions input;
    std::filesystem::path output;
    int width = 1200, height = 900;
    PictureGround ground = PictureGround::background;
    SceneOptions scene;
    std::optional<double> clip_position;
    RenderColors colors;
    RenderView view;
    std::optional<int> palette;  ///< number of colours
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

/// Where --clip-at says; else through the middle of what is shown from near, or of the mesh. Seen from somewhere else
/// than usual, what is taken away is on the side of the eye.
void place_clip(ClipPlane& clip, const Options& options, const CurvedMesh& mesh, const std::optional<ShownBall>& ball) {
    const Eigen::RowVector3d normal(clip.normal[0], clip.normal[1], clip.normal[2]);
    Eigen::Index axis = 0;
    normal.cwiseAbs().maxCoeff(&axis);
    if (const auto& to_eye = options.view.to_eye; to_eye && std::abs((*to_eye)[axis]) > 1e-9)
        clip.normal[static_cast<std::size_t>(axis)] = (*to_eye)[axis] > 0.0 ? 1.0 : -1.0;
    std::optional<double> position = options.clip_position;
    if (!position && ball) {
        const auto box = bounding_box(mesh);
        const double extent = box(1, axis) - box(0, axis);
        if (extent > 0.0) position = std::clamp((ball->center[axis] - box(0, axis)) / extent, 0.0, 1.0);
    }
    if (position) clip.position = clip.normal[static_cast<std::size_t>(axis)] < 0.0 ? 1.0 - *position : *position;
}

int run(const Options& options, Work& work) {
    const ReadResult input = read_input(options.input, work);
    const CurvedMesh& mesh = input.mesh;
    const Coloring coloring = find_coloring(options.colors, input, work.context());
    if (options.output.extension() != ".png")
        throw InvalidInput(options.output.string(), 0, "pictures are written as .png.");
    std::optional<QualityReport> quality;
    if (is_assessable(mesh)) quality = certify(mesh, work);
    MeshScene scene;
    SceneOptions scene_options = options.scene;
    scene_options.font = find_text_font();
    scene_options.pixel_ratio = std::max(1.0, options.height / 900.0);
    const QualityReport* its_quality = quality ? &*quality : nullptr;
    const std::optional<ShownBall> ball = find_shown_ball(options.view, mesh, its_quality);
    if (ball) scene_options.magnification = magnification(*ball, mesh);
    if (mesh.topology().dimension() != 3) scene_options.clip.reset();
    if (scene_options.clip) place_clip(*scene_options.clip, options, mesh, ball);
    scene.set_options(scene_options);
    scene.set_coloring(coloring);
    scene.set_mesh(&mesh, its_quality);
    if (options.view.outline) scene.set_highlighted_elements(choose_elements(*options.view.outline, mesh, its_quality));
    apply_view(options.view, ball, options.width, options.height, scene);
    if (options.palette)
        write_text_file(options.output,
                        to_png(reduce_colors(render_pixels(scene, options.width, options.height), *options.palette)));
    else
        render_png(scene, options.width, options.height, options.output, options.ground);
    work.end_phase("render");
    if (work.is_json()) {
        Json json = {
            {"mesh", mesh_json(options.input.file, mesh)},
            {"picture", {{"file", options.output.string()}, {"width", options.width}, {"height", options.height}}},
            {"colors", colors_json(options.colors, scene.shown_scale())}};
        if (ball) json["view"] = ball_json(*ball, mesh);
        work.print(json);
    } else
        fmt::print("{}: {} x {} pixels\n", options.output.string(), options.width, options.height);
    return exit_done;
}

}  // namespace

void add_render(CLI::App& app, Invocation& invocation) {
    auto* command = add_command(app, invocation, "render",
                                "Picture of the mesh, coloured by scaled Jacobian or an array of the file");
    auto options = std::make_shared<Options>();
    add_input_option(*command, options->input, "MESH");
    command->add_option("-o,--output", options->output, "Picture to write")->required()->type_name("PNG");
    command->add_option("--size", "Size in pixels (default 1200x900)")
        ->type_name("WxH")
        ->check([options](const std::string& text) { return parse_size(text, *options); });
    CLI::Option* transparent = command->add_flag_function(
        "--transparent", [options](std::int64_t) { options->ground = PictureGround::transparent; },
        "No ground: what is not the mesh is transparent");
    command
        ->add_option("--palette", options->palette,
                     "At most N colours, 2 to 256: a file of a third or a fourth of the size")
        ->type_name("N")
        ->check(CLI::Range(2, 256))
        ->excludes(transparent);
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
        ->add_option(
            "--clip-at", options->clip_position,
            "Where the plane of --clip or --cut stands: fraction of the mesh's extent (default 0.5; with --focus or "
            "--zoom: through the middle of what is shown)")
        ->check(CLI::Range(0.0, 1.0));
    command->parse_complete_callback([command] {
        if (command->count("--clip-at") > 0 && command->count("--clip") + command->count("--cut") == 0)
            throw CLI::ValidationError("--clip-at", "is for --clip or --cut");
    });
    add_view_options(*command, options->view);
    add_color_options(*command, options->colors);
    set_action(*command, invocation, options, run);
}

}  // namespace curvewright::cli
