#include "core/warp/warp.h"

#include <fmt/format.h>

#include "app/cli/command.h"
#include "app/cli/output.h"
#include "app/cli/warp_options.h"
#include "core/io/deformation_file.h"

namespace curvewright::cli {
namespace {

/// What became of the mesh, at once or in increments.
struct Outcome {
    CurvedMesh mesh;
    WarpReport report;
    Assessment quality;
    std::optional<IncrementReport> increments;

    bool is_complete() const { return !increments || increments->is_complete(); }
};

Outcome move(const WarpArguments& arguments, const CurvedMesh& input, const Deformation& deformation,
             const Assessment& before, const TaskContext& context, Json& timings) {
    WarpOptions options = arguments.warp;
    options.prescribed_nodes = prescribed_interior_nodes(input, deformation);
    if (arguments.steps) {
        const BoundaryPath path = [&](double fraction) { return apply_deformation(input, deformation, fraction); };
        IncrementalResult result = warp_in_increments(input, path, options, arguments.increments(), context);
        return {input.with_coordinates(std::move(result.coordinates)),
                std::move(result.report),
                {std::move(result.quality), {}},
                std::move(result.increments)};
    }
    WarpResult result = warp(input, apply_deformation(input, deformation), options, context);
    CurvedMesh mesh = input.with_coordinates(std::move(result.coordinates));
    Assessment quality = assess_result(mesh, before, context, timings);
    return {std::move(mesh), std::move(result.report), std::move(quality), {}};
}

Json tags_json(const MeshTopology& topology, const std::vector<Index>& nodes) {
    Json tags = Json::array();
    for (Index node : nodes) tags.push_back(topology.node_tag(node).value);
    return tags;
}

void add_weights(Json& json, const WarpOptions& options) {
    json["weights"] = to_string(options.weighting);
    if (options.weighting == Weighting::elastic) {
        json["poisson_ratio"] = options.poisson_ratio;
        json["stiffening"] = options.stiffening;
    } else {
        json["distance_power"] = options.distance_power;
        json["sharing_power"] = options.sharing_power;
        json["neighbours"] = to_string(options.neighbours);
    }
}

Json increments_json(int asked, const IncrementReport& report, const MeshTopology& topology) {
    Json steps = Json::array(), failed = nullptr;
    for (const IncrementStep& step : report.steps)
        steps.push_back({{"fraction", step.fraction},
                         {"min", step.summary.min},
                         {"invalid", step.summary.invalid},
                         {"undecided", step.summary.undecided},
                         {"accepted", step.is_accepted}});
    if (!report.is_complete() && report.failed_element)
        failed = {{"fraction", report.failed_fraction},
                  {"element", topology.element_tag(*report.failed_element).value},
                  {"scaled_jacobian", report.failed_scaled_jacobian}};
    return {{"asked", asked == 0 ? Json("auto") : Json(asked)},
            {"accepted", report.accepted},
            {"tried", report.steps.size()},
            {"fraction", report.fraction},
            {"complete", report.is_complete()},
            {"failed", failed},
            {"steps", steps}};
}

Json result_json(const WarpArguments& arguments, const Assessment& before, const Outcome& outcome,
                 const Json& timings) {
    const MeshTopology& topology = outcome.mesh.topology();
    const WarpReport& report = outcome.report;
    Json json = {{"mesh", mesh_json(arguments.output.file, outcome.mesh)},
                 {"orientation", before.report ? Json(to_string(before.report->orientation)) : Json()}};
    add_assessment(json, outcome.quality);
    add_assessment(json["before"], before);
    json["worst"] = outcome.quality.report ? worst_json(outcome.mesh, *outcome.quality.report) : Json::array();
    add_weights(json, arguments.warp);
    json["condensed_nodes"] = report.condensed_nodes;
    if (outcome.increments) json["increments"] = increments_json(*arguments.steps, *outcome.increments, topology);
    json["solver"] = {{"name", to_string(report.solver)},
                      {"iterations", report.iterations},
                      {"residual", report.residual},
                      {"note", report.solver_note}};
    json["outside_hull"] = tags_json(topology, report.outside_hull);
    json["degenerate"] = tags_json(topology, report.degenerate);
    json["timings"] = timings;
    return json;
}

void print_result(const WarpArguments& arguments, const Assessment& before, const Outcome& outcome) {
    fmt::print("{}: {}\n", arguments.output.file.string(), mesh_line(outcome.mesh));
    if (before.report)
        fmt::print("before  {}\n", summary_line(before.report->summary));
    else
        fmt::print("quality not assessed yet for such elements: {}\n", before.note);
    if (outcome.quality.report) fmt::print("after   {}\n", summary_line(outcome.quality.report->summary));
    if (outcome.increments) fmt::print("{}\n", describe(*outcome.increments, outcome.mesh.topology()));
    fmt::print("{}\n", outcome.report.solver_note);
}

void report_nodes(const MeshTopology& topology, const std::vector<Index>& nodes, const std::string& what) {
    if (nodes.empty()) return;
    std::string list;
    for (std::size_t i = 0; i < nodes.size() && i < 5; ++i)
        list += fmt::format("{}{}", i > 0 ? ", " : "", topology.node_tag(nodes[i]).value);
    fmt::print(stderr, "{} {} {} (node {}{})\n", nodes.size(), nodes.size() == 1 ? "node" : "nodes", what, list,
               nodes.size() > 5 ? ", ..." : "");
}

/// What the user should know besides the result.
void print_remarks(const WarpArguments& arguments, const Outcome& outcome, const Invocation& invocation) {
    if (invocation.common.quiet) return;
    const MeshTopology& topology = outcome.mesh.topology();
    for (const std::string& name : arguments.without_effect)
        fmt::print(stderr, "{} has no effect with --weights {}.\n", name, to_string(arguments.warp.weighting));
    report_nodes(topology, outcome.report.outside_hull,
                 "outside the hull of the neighbours: affine weights were taken");
    report_nodes(topology, outcome.report.degenerate, "with neighbours that do not span the space");
    // On standard output where that is for people.
    if (!outcome.is_complete() && invocation.common.json)
        fmt::print(stderr, "{}\n", describe(*outcome.increments, topology));
    if (outcome.quality.report && outcome.quality.report->summary.invalid > 0) {
        const QualitySummary& summary = outcome.quality.report->summary;
        fmt::print(stderr, "{} of {} elements are invalid; --increments auto{} may help.\n", summary.invalid,
                   summary.elements(),
                   arguments.warp.weighting == Weighting::elastic
                       ? ""
                       : ", --weights elastic or another --distance-power (0, 4)");
    }
}

int run(const WarpArguments& arguments, const Invocation& invocation, const TaskContext& context) {
    check_output(arguments.output);
    const Stopwatch watch;
    Json timings = Json::object();
    const ReadResult read = read_input(arguments.mesh, invocation, context, timings);
    const CurvedMesh& input = read.mesh;
    const Deformation deformation = read_deformation(arguments.deformation, context);
    const Assessment before = assess(input, context, timings);
    if (before.report) warn_about_orientation(*before.report, invocation);
    const Outcome outcome = move(arguments, input, deformation, before, context, timings);
    timings["neighbours"] = outcome.report.neighbours_seconds;
    timings["weights"] = outcome.report.weights_seconds;
    timings["solve"] = outcome.report.solve_seconds;
    write_output(arguments.output, outcome.mesh, read.fields,
                 outcome.quality.report ? &*outcome.quality.report : nullptr, &input.coordinates(), invocation,
                 timings);
    finish_timings(timings, watch);

    print_remarks(arguments, outcome, invocation);
    if (invocation.common.json)
        print_json(result_json(arguments, before, outcome, timings));
    else
        print_result(arguments, before, outcome);
    if (!outcome.is_complete()) return exit_not_valid;
    return outcome.quality.report ? validity_status(outcome.quality.report->summary) : exit_done;
}

}  // namespace

void add_warp(CLI::App& app, Invocation& invocation) {
    auto* command = add_command(app, invocation, "warp", "Move the boundary and let the interior follow");
    auto arguments = std::make_shared<WarpArguments>();
    add_warp_options(*command, *arguments);
    set_action(*command, invocation, arguments, run);
}

}  // namespace curvewright::cli
