#include "core/untangle/improve.h"

#include <algorithm>
#include <cstdlib>

#include <fmt/format.h>

#include "app/cli/command.h"
#include "app/cli/global_check.h"
#include "app/cli/node_options.h"
#include "app/cli/output.h"
#include "app/cli/target.h"
#include "core/quality/shape_quality.h"

namespace curvewright::cli {
namespace {

struct Options {
    InputOptions input;
    OutputOptions output;
    ImproveOptions improve;
    bool has_target = false;
    NodeArguments nodes;
    std::vector<std::string> boundary;  ///< rules as given
};

ShapeSummary summary_of(const std::vector<double>& shapes) {
    ShapeSummary summary{shapes.empty() ? 1.0 : *std::min_element(shapes.begin(), shapes.end()),
                         shapes.empty() ? 1.0 : 0.0};
    for (const double shape : shapes) summary.mean += shape / static_cast<double>(shapes.size());
    return summary;
}

Json shape_json(const ShapeSummary& shape) {
    return {{"min", shape.min}, {"mean", shape.mean}};
}

/// A mesh with its quality.
struct State {
    const CurvedMesh& mesh;
    QualityReport quality;
    std::vector<double> shapes;
};

Json result_json(const Options& options, const State& before, const State& after, const ImproveResult& result) {
    Json json = {
        {"mesh", mesh_json(options.output.file, after.mesh)},
        {"goal", to_string(options.improve.goal)},
        {"target", options.improve.target},
        {"stopped", to_string(result.reason)},
        {"largest_move", result.largest_move},
        {"orientation", to_string(before.quality.orientation)},
        {"scaled_jacobian", summary_json(after.quality.summary)},
        {"shape", shape_json(summary_of(after.shapes))},
        {"before",
         {{"scaled_jacobian", summary_json(before.quality.summary)}, {"shape", shape_json(summary_of(before.shapes))}}},
        {"worst", worst_json(after.mesh, after.quality)}};
    if (options.improve.max_move) json["max_move"] = *options.improve.max_move;
    if (!options.boundary.empty())
        json["boundary"] = {{"sliding_nodes", result.sliding_nodes},
                            {"free_nodes", result.free_nodes},
                            {"largest_distance", result.largest_boundary_distance}};
    return json;
}

void print_result(const Options& options, const State& before, const State& after, const ImproveResult& result,
                  double seconds) {
    fmt::print("{}: {}\n", options.output.file.string(), mesh_line(after.mesh));
    fmt::print("before  {}; mean ratio {:.4g}\nafter   {}; mean ratio {:.4g}\n", summary_line(before.quality.summary),
               summary_of(before.shapes).min, summary_line(after.quality.summary), summary_of(after.shapes).min);
    fmt::print("{:.3f} s to improve; no node went farther than {:.3g}\n", seconds, result.largest_move);
    if (!options.boundary.empty())
        fmt::print("boundary: {} sliding nodes, {} free ones; at most {:.3g} away from the input's\n",
                   result.sliding_nodes, result.free_nodes, result.largest_boundary_distance);
}

const std::vector<double>& values_of(const State& state, const std::vector<double>& jacobians, ImproveGoal goal) {
    return goal == ImproveGoal::shape ? state.shapes : jacobians;
}

int run(const Options& options, Work& work) {
    check_output(options.output);
    const ReadResult read = read_input(options.input, work);
    const CurvedMesh& input = read.mesh;
    ImproveOptions improving = options.improve;
    improving.nodes = options.nodes.rules(input.topology());
    for (const std::string& rule : options.boundary) improving.boundary.add(rule);
    State before{input, certify(input, work), {}};
    note_assessment(read.mesh.topology(), before.quality, work);
    before.shapes = element_shapes(input, input.coordinates(), work.context());
    work.end_phase("shape");
    const ImproveResult result = improve(input, improving, nullptr, work.context());
    work.end_phase("improve");
    if (improving.keeps_best_on_cancel) work.ignore_stop();

    const CurvedMesh mesh = input.with_coordinates(result.coordinates);
    State after{mesh, certify_result(mesh, before.quality, work), {}};
    after.shapes = element_shapes(mesh, input.coordinates(), work.context());
    work.end_phase("shape");
    const bool is_cancelled = result.reason == StopReason::cancelled;
    if (is_cancelled && !note_cancelled(after.quality, options.output.file, work)) return exit_cancelled;
    const GlobalCheck global(mesh, after.quality, work);
    write_output(options.output, mesh, read.fields, &after.quality, &input.coordinates(), work);

    const Target target{improving.target, options.has_target, improving.goal};
    const TargetOutcome outcome = compare(target, values_of(after, scaled_jacobians(after.quality), improving.goal));
    if (mesh.coordinates() == input.coordinates())
        work.note(outcome.is_reached()
                      ? fmt::format("Every element has at least the target {:g}; nothing was changed.", target.value)
                      : std::string("Nothing better was found; nothing was changed."));
    const int status = note_target(target, outcome, work);
    if (work.is_json()) {
        Json json = result_json(options, before, after, result);
        global.add_to(json, mesh);
        work.print(json);
    } else {
        print_result(options, before, after, result, work.seconds("improve"));
        fmt::print("{}\n", global.line());
    }
    return is_cancelled ? exit_cancelled : worse_status(status, global.status());
}

}  // namespace

void add_improve(CLI::App& app, Invocation& invocation) {
    auto* command = add_command(app, invocation, "improve",
                                "Raise the quality of a valid mesh; the boundary stays unless told otherwise");
    auto options = std::make_shared<Options>();
    add_input_option(*command, options->input);
    add_output_options(*command, options->output);
    command
        ->add_option_function<std::string>(
            "--goal",
            [options](const std::string& goal) {
                options->improve.goal = goal == "shape" ? ImproveGoal::shape : ImproveGoal::jacobian;
            },
            "What is raised: jacobian (default), the least scaled Jacobian, or shape, the worst mean ratio against "
            "the straight-sided elements")
        ->check([](const std::string& goal) {
            if (goal == "jacobian" || goal == "shape") return std::string();
            return goal == "solver"
                       ? std::string("the goal solver is not available yet; jacobian or shape was expected")
                       : "the goal must be jacobian or shape, not " + goal;
        })
        ->type_name("jacobian|shape");
    add_target_option(*command, options->improve.target, "Elements below this are improved");
    command
        ->add_option_function<double>(
            "--max-move", [options](const double& distance) { options->improve.max_move = distance; },
            "No node goes farther than this from where it was read, as a fraction of the mesh's size (the diagonal of "
            "its bounding box)")
        ->type_name("T")
        ->check([](const std::string& text) {
            const double distance = std::strtod(text.c_str(), nullptr);
            return distance > 0.0 && distance <= 1.0 ? std::string()
                                                     : "the distance must be greater than 0 and at most 1";
        });
    command
        ->add_option(
            "--boundary", options->boundary,
            "What boundary nodes may do: fixed (default), slide along the boundary as it was read, or free; for all or "
            "for a group; may be given several times")
        ->type_name("MODE|GROUP=MODE");
    command
        ->add_option("--shape-floor", options->improve.shape_floor,
                     "Worst mean ratio that may be left, where that can be had; 0 = none (goal jacobian)")
        ->type_name("F")
        ->check(CLI::Range(0.0, 0.999));
    add_node_options(*command, options->nodes);
    add_keep_best_option(*command, options->improve.keeps_best_on_cancel);
    command->parse_complete_callback([command, options] { options->has_target = command->count("--target") > 0; });
    set_action(*command, invocation, options, run);
}

}  // namespace curvewright::cli
