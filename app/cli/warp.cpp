#include "core/warp/warp.h"

#include <algorithm>

#include <fmt/format.h>

#include "app/cli/command.h"
#include "app/cli/global_check.h"
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

/// The parts that the warp has timed itself, and the rest of it.
void end_warp_phase(const WarpReport& report, Work& work) {
    work.end_phase("warp", {{"neighbours", report.neighbours_seconds},
                            {"weights", report.weights_seconds},
                            {"solve", report.solve_seconds}});
}

Outcome move(const WarpArguments& arguments, const CurvedMesh& input, const Deformation& deformation,
             const Assessment& before, Work& work) {
    WarpOptions options = arguments.warp;
    options.prescribed_nodes = prescribed_interior_nodes(input, deformation);
    if (arguments.steps) {
        const BoundaryPath path = [&](double fraction) { return apply_deformation(input, deformation, fraction); };
        IncrementalResult result = warp_in_increments(input, path, options, arguments.increments(), work.context());
        if (arguments.keeps_best) work.ignore_stop();
        end_warp_phase(result.report, work);
        return {input.with_coordinates(std::move(result.coordinates)),
                std::move(result.report),
                {std::move(result.quality), {}},
                std::move(result.increments)};
    }
    WarpResult result = warp(input, apply_deformation(input, deformation), options, work.context());
    end_warp_phase(result.report, work);
    CurvedMesh mesh = input.with_coordinates(std::move(result.coordinates));
    Assessment quality = assess_result(mesh, before, work);
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

Json result_json(const WarpArguments& arguments, const Assessment& before, const Outcome& outcome) {
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

void note_nodes(const MeshTopology& topology, const std::vector<Index>& nodes, const std::string& what, Work& work) {
    if (nodes.empty()) return;
    std::string list;
    for (std::size_t i = 0; i < nodes.size() && i < 5; ++i)
        list += fmt::format("{}{}", i > 0 ? ", " : "", topology.node_tag(nodes[i]).value);
    work.note(fmt::format("{} {} {} (node {}{}).", nodes.size(), nodes.size() == 1 ? "node" : "nodes", what, list,
                          nodes.size() > 5 ? ", ..." : ""));
}

/// What the user should know besides the result.
void note_remarks(const WarpArguments& arguments, const Outcome& outcome, Work& work) {
    const MeshTopology& topology = outcome.mesh.topology();
    for (const std::string& name : arguments.without_effect)
        work.note(fmt::format("{} has no effect with --weights {}.", name, to_string(arguments.warp.weighting)));
    note_nodes(topology, outcome.report.outside_hull, "outside the hull of the neighbours: affine weights were taken",
               work);
    note_nodes(topology, outcome.report.degenerate, "with neighbours that do not span the space", work);
    // On standard output where that is for people.
    if (!outcome.is_complete() && work.is_json()) work.note(describe(*outcome.increments, topology));
    if (outcome.quality.report && outcome.quality.report->summary.invalid > 0) {
        const QualitySummary& summary = outcome.quality.report->summary;
        work.note(fmt::format(
            "{} of {} elements are invalid; --increments auto{} may help.", summary.invalid, summary.elements(),
            arguments.warp.weighting == Weighting::elastic ? ""
                                                           : ", --weights elastic or another --distance-power (0, 4)"));
    }
}

int run(const WarpArguments& arguments, Work& work) {
    check_output(arguments.output);
    const ReadResult read = read_input(arguments.input, work);
    const CurvedMesh& input = read.mesh;
    const Deformation deformation = read_deformation(arguments.deformation, work.context());
    const Assessment before = assess(input, work);
    if (before.report) note_assessment(input.topology(), *before.report, work);
    const Outcome outcome = move(arguments, input, deformation, before, work);
    const bool is_cancelled = outcome.increments && outcome.increments->is_cancelled;
    if (is_cancelled && outcome.increments->accepted == 0) {
        fmt::print(stderr, "Cancelled before the first step of the motion was reached; nothing was written.\n");
        return exit_cancelled;
    }
    const auto global = check_globally(outcome.mesh, outcome.quality, work);
    write_output(arguments.output, outcome.mesh, read.fields,
                 outcome.quality.report ? &*outcome.quality.report : nullptr, &input.coordinates(), work);

    if (is_cancelled)
        work.note(fmt::format("Cancelled; the last valid mesh, {:.4g} % of the motion, was written to {}.",
                              100.0 * outcome.increments->fraction, arguments.output.file.string()));
    note_remarks(arguments, outcome, work);
    if (work.is_json()) {
        Json json = result_json(arguments, before, outcome);
        if (global) global->add_to(json, outcome.mesh);
        work.print(json);
    } else {
        print_result(arguments, before, outcome);
        if (global) fmt::print("{}\n", global->line());
    }
    if (is_cancelled) return exit_cancelled;
    if (!outcome.is_complete()) return exit_not_valid;
    if (!global) return exit_done;
    return worse_status(validity_status(outcome.quality.report->summary), global->status());
}

}  // namespace

void add_warp(CLI::App& app, Invocation& invocation) {
    auto* command = add_command(app, invocation, "warp", "Move the boundary and let the interior follow");
    auto arguments = std::make_shared<WarpArguments>();
    add_warp_options(*command, *arguments);
    set_action(*command, invocation, arguments, run);
}

}  // namespace curvewright::cli
