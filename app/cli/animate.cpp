#include <cmath>
#include <cstdio>
#include <fstream>
#include <limits>
#include <map>
#include <memory>

#include <fmt/format.h>

#include "app/cli/command.h"
#include "app/cli/output.h"
#include "app/cli/warp_options.h"
#include "core/base/error.h"
#include "core/io/animation_file.h"
#include "core/io/deformation_file.h"
#include "core/session/frames.h"
#include "core/session/timeline_frames.h"
#include "core/timeline/recorder.h"
#include "core/untangle/trace_reader.h"
#include "ui/scene/offscreen.h"

namespace curvewright::cli {
namespace {

struct Options {
    InputOptions input;
    std::filesystem::path deformation, trace;  ///< one of the two: what is shown
    std::filesystem::path output;              ///< folder for pictures, or an animation's file
    int frames = 60;
    int width = 1920, height = 1080;
    bool goes_back = false, shows_legend = true, is_transparent = false;
    double frames_per_second = 30., quality = 90.;  ///< of an animation
    bool is_lossless = false;
    WarpOptions warp;
    StepLevel level = StepLevel::patch;  ///< of a trace
};

/// "WxH", both even, as videos need it.
std::string parse_size(const std::string& text, Options& options) {
    int width = 0, height = 0;
    char rest = 0;
    if (std::sscanf(text.c_str(), "%dx%d%c", &width, &height, &rest) != 2 || width < 16 || height < 16 ||
        width > 8192 || height > 8192 || width % 2 != 0 || height % 2 != 0)
        return "expected WIDTHxHEIGHT in pixels, even numbers from 16 to 8192, as in 1920x1080";
    options.width = width;
    options.height = height;
    return {};
}

std::filesystem::path file_of(const Options& options, int number) {
    return options.output / fmt::format("{}-{:04}.png", options.input.file.stem().string(), number);
}

/// Puts a frame into the scene. The view is fitted to the first one and stays where it is.
void show(MeshScene& scene, FrameSource& film, int index, int number, int count, double& least,
          const TaskContext& context) {
    context.report(fmt::format("Frame {} of {}", number + 1, count), static_cast<double>(number) / count);
    const Frame frame = film.make(index, {context.stop, {}});
    scene.set_mesh(&frame.mesh, frame.quality ? &*frame.quality : nullptr);
    scene.set_highlighted_elements(frame.highlighted);
    if (frame.quality) least = std::min(least, frame.quality->summary.min);
}

PictureGround ground_of(const Options& options) {
    return options.is_transparent ? PictureGround::transparent : PictureGround::background;
}

void write_pictures(const Options& options, MeshScene& scene, FrameSource& film, int pictures, double& least,
                    const TaskContext& context) {
    std::error_code error;
    std::filesystem::create_directories(options.output, error);
    if (error)
        throw InvalidInput(options.output.string(), 0, fmt::format("the folder cannot be made ({}).", error.message()));
    std::vector<std::filesystem::path> written;
    try {
        const int frames = film.count();
        for (int index = 0; index < frames; ++index) {
            show(scene, film, index, index, frames, least, context);
            written.push_back(file_of(options, index + 1));
            render_png(scene, options.width, options.height, written.back(), ground_of(options));
            if (!options.goes_back || index == 0 || index == frames - 1) continue;
            // The way back shows the same.
            written.push_back(file_of(options, pictures - index + 1));
            std::filesystem::copy_file(file_of(options, index + 1), written.back(),
                                       std::filesystem::copy_options::overwrite_existing);
        }
    } catch (...) {
        // A command that does not succeed leaves nothing.
        for (const std::filesystem::path& file : written) std::filesystem::remove(file, error);
        throw;
    }
}

/// Returns the size of the file. The way back is drawn once more, so that one frame is kept, not all of them.
std::uintmax_t write_animation(const Options& options, MeshScene& scene, FrameSource& film, int pictures, double& least,
                               const TaskContext& context) {
    AnimationFile file(options.output, {options.width, options.height, options.frames_per_second, options.is_lossless,
                                        options.quality});
    for (int number = 0; number < pictures; ++number) {
        show(scene, film, there_and_back(number, film.count()), number, pictures, least, context);
        file.add(rgba_from_top(render_pixels(scene, options.width, options.height, ground_of(options))),
                 {context.stop, {}});
    }
    return file.finish({context.stop, {}});
}

/// The way of a warp. certified with the orientation that the mesh has at its start.
std::unique_ptr<FrameSource> film_of_warp(const CurvedMesh& mesh, const Options& options, Work& work) {
    auto deformation = std::make_shared<const Deformation>(read_deformation(options.deformation, work.context()));
    std::optional<OrientationSigns> sign;
    if (is_assessable(mesh)) sign = certify(mesh, work).orientation_sign;
    WarpOptions warp_options = options.warp;
    warp_options.prescribed_nodes = prescribed_interior_nodes(mesh, *deformation);
    const CurvedMesh end = mesh.with_coordinates(
        warp(mesh, apply_deformation(mesh, *deformation), warp_options, work.context()).coordinates);
    return std::make_unique<MotionFrames>(
        end, sign, std::vector<MotionLeg>{{"Warp", mesh.coordinates(), end.coordinates(), deformation, options.warp}},
        options.frames);
}

/// The steps of an untangling.
std::unique_ptr<FrameSource> film_of_trace(const CurvedMesh& mesh, const Options& options, const TaskContext& context) {
    std::ifstream stream(options.trace);
    if (!stream) throw InvalidInput(options.trace.string(), 0, "the file cannot be opened.");
    Recorder recorder({}, context);
    read_trace(stream, options.trace.string(), mesh, recorder, context);
    const auto recording = recorder.finish();
    return std::make_unique<TimelineFrames>(recording, options.level, options.frames, 0, recording->step_count() - 1);
}

int run(const Options& options, Work& work) {
    const CurvedMesh mesh = read_input(options.input, work).mesh;
    const std::unique_ptr<FrameSource> film =
        options.trace.empty() ? film_of_warp(mesh, options, work) : film_of_trace(mesh, options, work.context());
    MeshScene scene;
    SceneOptions scene_options;
    scene_options.font = find_text_font();
    scene_options.pixel_ratio = std::max(1.0, options.height / 900.0);
    scene_options.show_legend = options.shows_legend;
    scene.set_options(scene_options);
    const int pictures = options.goes_back ? 2 * (film->count() - 1) : film->count();
    const bool is_animation = AnimationFile::is_animation(options.output);
    double least = std::numeric_limits<double>::infinity();
    std::uintmax_t bytes = 0;
    if (is_animation)
        bytes = write_animation(options, scene, *film, pictures, least, work.context());
    else
        write_pictures(options, scene, *film, pictures, least, work.context());
    work.end_phase("render");
    const double seconds = pictures / options.frames_per_second;
    if (work.is_json()) {
        Json result = {{"mesh", mesh_json(options.input.file, mesh)},
                       {"min_on_the_way", least <= 1.0 ? Json(least) : Json()}};
        if (is_animation)
            result["animation"] = {{"file", options.output.string()},
                                   {"count", pictures},
                                   {"width", options.width},
                                   {"height", options.height},
                                   {"frames_per_second", options.frames_per_second},
                                   {"seconds", seconds},
                                   {"lossless", options.is_lossless},
                                   {"bytes", bytes}};
        else
            result["pictures"] = {{"folder", options.output.string()},
                                  {"first", file_of(options, 1).filename().string()},
                                  {"count", pictures},
                                  {"width", options.width},
                                  {"height", options.height}};
        work.print(result);
    } else if (is_animation) {
        fmt::print("{} pictures of {} x {} pixels, {:.2f} s, {:.0f} kB: {}\n", pictures, options.width, options.height,
                   seconds, std::ceil(static_cast<double>(bytes) / 1000.), options.output.string());
    } else {
        fmt::print("{} pictures of {} x {} pixels, {} to {}\n", pictures, options.width, options.height,
                   file_of(options, 1).string(), file_of(options, pictures).filename().string());
    }
    return exit_done;
}

}  // namespace

void add_animate(CLI::App& app, Invocation& invocation) {
    auto* command = add_command(app, invocation, "animate",
                                "Pictures or an animation of a warp on its way, or of the steps of an untangling");
    auto options = std::make_shared<Options>();
    add_input_option(*command, options->input, "MESH");
    auto* deformation =
        command->add_option("--deformation", options->deformation, "Operations (.json), node table (.csv) or a mesh")
            ->type_name("D");
    command
        ->add_option("--trace", options->trace,
                     "Instead: the steps that untangle --trace has written of this mesh, at most --frames of them")
        ->type_name("FILE.jsonl")
        ->excludes(deformation);
    const std::map<std::string, StepLevel> levels{
        {"pass", StepLevel::pass}, {"patch", StepLevel::patch}, {"iteration", StepLevel::iteration}};
    command->add_option("--level", options->level, "Steps of a trace that are shown: pass, patch (default), iteration")
        ->type_name("LEVEL")
        ->transform(CLI::CheckedTransformer(levels).description(""));
    command
        ->add_option("-o,--output", options->output,
                     "Folder for the pictures, MESH-0001.png and so on; or a file that ends in .webp for an animation "
                     "that browsers play in a loop")
        ->required()
        ->type_name("FOLDER|FILE.webp");
    command->add_option("--frames", options->frames, "Pictures from the start to the end")
        ->type_name("N")
        ->check(CLI::Range(2, 9999))
        ->capture_default_str();
    command->add_option("--size", "Size in pixels, even (default 1920x1080)")
        ->type_name("WxH")
        ->check([options](const std::string& text) { return parse_size(text, *options); });
    command->add_flag("--there-and-back", options->goes_back, "And back again, for a video that runs in a loop");
    command->add_flag("--transparent", options->is_transparent, "No ground: what is not the mesh is transparent");
    command->add_flag_function(
        "--no-legend", [options](std::int64_t) { options->shows_legend = false; }, "Leave out the legend");
    command->add_option("--fps", options->frames_per_second, "Animation: pictures per second")
        ->type_name("N")
        ->check(CLI::Range(0.1, AnimationFile::max_rate))
        ->capture_default_str();
    command->add_option("--quality", options->quality, "Animation: from 0, small, to 100, fine")
        ->type_name("Q")
        ->check(CLI::Range(0., 100.))
        ->capture_default_str();
    command->add_flag("--lossless", options->is_lossless, "Animation: every pixel as it was drawn")
        ->excludes("--quality");
    command->parse_complete_callback([command, options] {
        if (options->deformation.empty() == options->trace.empty())
            throw CLI::RequiredError("--deformation or --trace");
        if (options->trace.empty() && command->count("--level") > 0)
            throw CLI::ValidationError("--level", "is for --trace");
        if (AnimationFile::is_animation(options->output)) return;
        for (const char* name : {"--fps", "--quality", "--lossless"})
            if (command->count(name) > 0) throw CLI::ValidationError(name, "is for an output that ends in .webp");
    });
    add_weight_options(*command, options->warp);
    set_action(*command, invocation, options, run);
}

}  // namespace curvewright::cli
