#include "core/warp/warp.h"

#include <fmt/format.h>

#include "app/cli/command.h"
#include "app/cli/output.h"
#include "core/io/deformation_file.h"

namespace curvewright::cli {
namespace {

struct Options {
    std::filesystem::path mesh, deformation;
    OutputOptions output;
    WarpOptions warp;
};

Json tags_json(const MeshTopology& topology, const std::vector<Index>& nodes) {
    Json tags = Json::array();
    for (Index node : nodes) tags.push_back(topology.node_tag(node).value);
    return tags;
}

void report_nodes(const MeshTopology& topology, const std::vector<Index>& nodes, const std::string& what) {
    if (nodes.empty()) return;
    std::string list;
    for (std::size_t i = 0; i < nodes.size() && i < 5; ++i)
        list += fmt::format("{}{}", i > 0 ? ", " : "", topology.node_tag(nodes[i]).value);
    fmt::print(stderr, "{} {} {} (node {}{})\n", nodes.size(), nodes.size() == 1 ? "node" : "nodes", what, list,
               nodes.size() > 5 ? ", ..." : "");
}

int run(const Options& options, const Invocation& invocation, const TaskContext& context) {
    check_output(options.output);
    const Stopwatch watch;
    Json timings = Json::object();
    const CurvedMesh input = read_input(options.mesh, invocation, context, timings).mesh;
    const Deformation deformation = read_deformation(options.deformation, context);
    const QualityReport before = certify(input, context, timings);
    warn_about_orientation(before, invocation);
    WarpOptions warp_options = options.warp;
    warp_options.prescribed_nodes = prescribed_interior_nodes(input, deformation);
    const WarpResult result = warp(input, apply_deformation(input, deformation), warp_options, context);
    timings["neighbours"] = result.report.neighbours_seconds;
    timings["weights"] = result.report.weights_seconds;
    timings["solve"] = result.report.solve_seconds;
    const CurvedMesh mesh = input.with_coordinates(result.coordinates);
    const QualityReport after = certify_result(mesh, before, context, timings);
    write_output(options.output, mesh, &after, &input.coordinates(), timings);
    finish_timings(timings, watch);

    const WarpReport& report = result.report;
    if (!invocation.common.quiet) {
        report_nodes(mesh.topology(), report.outside_hull,
                     "outside the hull of the neighbours: affine weights were taken");
        report_nodes(mesh.topology(), report.degenerate, "with neighbours that do not span the space");
        if (after.summary.invalid > 0)
            fmt::print(stderr,
                       "{} of {} elements are invalid; another --distance-power (0, 4) or --weights may help.\n",
                       after.summary.invalid, after.summary.elements());
    }
    if (invocation.common.json) {
        const Json json = {{"mesh", mesh_json(options.output.file, mesh)},
                           {"orientation", to_string(before.orientation)},
                           {"scaled_jacobian", summary_json(after.summary)},
                           {"before", {{"scaled_jacobian", summary_json(before.summary)}}},
                           {"worst", worst_json(mesh, after)},
                           {"weights", to_string(options.warp.weighting)},
                           {"distance_power", options.warp.distance_power},
                           {"solver",
                            {{"name", to_string(report.solver)},
                             {"iterations", report.iterations},
                             {"residual", report.residual},
                             {"note", report.solver_note}}},
                           {"outside_hull", tags_json(mesh.topology(), report.outside_hull)},
                           {"degenerate", tags_json(mesh.topology(), report.degenerate)},
                           {"timings", timings}};
        print_json(json);
    } else {
        fmt::print("{}: {}\n", options.output.file.string(), mesh_line(mesh));
        fmt::print("before  {}\nafter   {}\n{}\n", summary_line(before.summary), summary_line(after.summary),
                   report.solver_note);
    }
    return validity_status(after.summary);
}

}  // namespace

void add_warp(CLI::App& app, Invocation& invocation) {
    auto* command = add_command(app, invocation, "warp", "Move the boundary and let the interior follow");
    auto options = std::make_shared<Options>();
    add_input_option(*command, options->mesh);
    add_deformation_option(*command, options->deformation);
    add_output_options(*command, options->output);
    command
        ->add_option_function<std::string>(
            "--weights",
            [options](const std::string& text) {
                options->warp.weighting = text == "affine"    ? Weighting::affine
                                          : text == "elastic" ? Weighting::elastic
                                                              : Weighting::convex;
            },
            "convex (default), affine or elastic")
        ->check(CLI::IsMember({"convex", "affine", "elastic"}));
    command
        ->add_option("--distance-power", options->warp.distance_power,
                     "A neighbour at distance r counts r^-K; 0 = all alike, as in the thesis")
        ->type_name("K")
        ->check(CLI::Range(0.0, 8.0))
        ->capture_default_str();
    command
        ->add_option_function<std::string>(
            "--solver",
            [options](const std::string& text) {
                options->warp.solver = text == "direct"      ? SolverChoice::direct
                                       : text == "iterative" ? SolverChoice::iterative
                                                             : SolverChoice::automatic;
            },
            "auto (default: iterative, direct if that fails), direct or iterative")
        ->check(CLI::IsMember({"auto", "direct", "iterative"}));
    set_action(*command, invocation, options, run);
}

}  // namespace curvewright::cli
