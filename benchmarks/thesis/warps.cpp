#include <algorithm>
#include <optional>
#include <utility>

#include "benchmarks/cases/timed.h"
#include "benchmarks/thesis/measurements.h"
#include "benchmarks/thesis/published.h"
#include "benchmarks/thesis/warp_times.h"
#include "core/base/error.h"
#include "core/quality/quality.h"

namespace curvewright::benchmarks {
namespace {

/// The guaranteed method, which improves every element, takes minutes on the largest meshes.
constexpr std::size_t most_nodes_to_improve = 10000;

QualitySummary judge(const WarpCase& problem, const Coordinates& coordinates) {
    QualityOptions options;
    options.orientation_sign = orientation_signs(problem.mesh);
    return assess_quality(problem.mesh.with_coordinates(coordinates), options).summary;
}

std::vector<Cell> cells(const QualitySummary& quality) {
    return {fixed(quality.min), fixed(quality.mean), fixed(quality.max), quality.invalid + quality.undecided};
}

std::vector<Cell> cells(const published::Distortion& distortion) {
    return {fixed(distortion.least), fixed(distortion.mean), fixed(distortion.largest)};
}

std::vector<Cell> cells(const PhaseTimes& times) {
    const auto cell = [](const std::optional<double>& seconds) { return seconds ? Cell(*seconds) : Cell(); };
    return {times.neighbours, times.affine_weights, cell(times.affine_solve), times.convex_weights,
            cell(times.convex_solve)};
}

/// The three tables while they grow.
struct Tables {
    Comparison counts{
        {"table", "2.3"}, "the warps, their meshes", "", "example", {"elements", "order", "interior nodes"}};
    Comparison times{
        {"table", "2.4"},
        "the warps, their times",
        "Wall clock. Thesis: Xeon E5-2680 v3. Literal: Algorithms 2 and 3 on all threads, Eigen's SparseLU "
        "with COLAMD on one, the two systems at the same time. Best: this program's weights and solver (everything "
        "else of a "
        "warp included). The elastic body has no weights: "
        "its time is that of the whole warp.",
        "example",
        {"neighbours, s", "affine weights, s", "affine solve, s", "convex weights, s", "convex solve, s",
         "whole warp, s"}};
    Comparison quality{{"table", "2.5"},
                       "the warps, scaled Jacobian",
                       "Certified min J / max J. Literal: all neighbours count alike; minima depend on dimensions, "
                       "which the thesis does not give. Best: convex weights in which "
                       "near neighbours count more (the default), the elastic body, and on meshes of at most 10,000 "
                       "interior nodes the guaranteed method after the best of these. Peer: the best result of "
                       "another program that leaves nothing invalid; where the boundary moves far, Gmsh's optimizers "
                       "leave invalid elements, and a plain elastic body in SciPy remains.",
                       "example",
                       {"weights", "least", "mean", "largest", "not valid", "s"}};
    Tally literal_near, best_above, best_valid, quicker, above_peer;
};

void add_peers(const published::WarpExample& example, Index elements, const Peers& peers, Tables& tables) {
    const auto remark = [&](const PeerResult& peer) {
        return peer.elements == elements ? std::string()
                                         : fmt::format("on a mesh of {} elements", Cell(peer.elements).shown);
    };
    if (const PeerResult* affine = peers.find(example.sample, "affine weights"))
        tables.times.add(By::peer, example.name, affine->name(),
                         {Cell(), Cell(), Cell(), Cell(), Cell(), affine->seconds}, remark(*affine));
    if (const PeerResult* elastic = peers.find(example.sample, "elastic body"))
        tables.times.add(By::peer, example.name, elastic->name(),
                         {Cell(), Cell(), Cell(), Cell(), Cell(), elastic->seconds}, remark(*elastic));
    if (const PeerResult* best = peers.best(example.sample))
        tables.quality.add(By::peer, example.name, best->name(),
                           {"", fixed(best->least), fixed(best->mean), best->largest ? fixed(*best->largest) : Cell(),
                            best->not_valid, best->seconds},
                           remark(*best));
}

/// A result of table 2.5.
struct Outcome {
    Coordinates coordinates;
    QualitySummary quality;
    bool is_valid() const { return quality.invalid + quality.undecided == 0; }
};

/// Warps as published and with what this program has beyond that.
void compare_quality(const published::WarpExample& example, const WarpCase& problem, const Settings& settings,
                     const Peers& peers, Tables& tables) {
    const auto add = [&](By by, const std::string& method, const char* weights, const QualitySummary& quality,
                         double seconds) {
        std::vector<Cell> row{weights};
        for (const Cell& cell : cells(quality)) row.push_back(cell);
        row.emplace_back(seconds);
        tables.quality.add(by, example.name, method, row);
    };
    const auto run = [&](By by, const char* method, const char* weights, const WarpCase& variant) {
        const TimedWarp warp = best_of([&] { return timed_warp(variant); }, settings.repeats());
        Outcome outcome{warp.result.coordinates, judge(variant, warp.result.coordinates)};
        add(by, method, weights, outcome.quality, warp.seconds);
        if (variant.options.weighting == Weighting::elastic)
            tables.times.add(By::best, example.name, method, {Cell(), Cell(), Cell(), Cell(), Cell(), warp.seconds});
        return outcome;
    };
    const Outcome affine = run(By::literal, "as published", "affine", as_published(problem, Weighting::affine));
    const Outcome convex = run(By::literal, "as published", "convex", as_published(problem, Weighting::convex));
    std::vector<Outcome> outcomes{run(By::best, "near neighbours count more", "convex", problem)};
    WarpCase body = problem;
    body.options.weighting = Weighting::elastic;
    outcomes.push_back(run(By::best, "elastic body", "none", body));
    body.options.stiffening = 1.0;
    outcomes.push_back(run(By::best, "elastic body, small elements stiffer", "none", body));
    const auto rank = [](const Outcome& a, const Outcome& b) {
        return std::pair(a.is_valid(), a.quality.min) < std::pair(b.is_valid(), b.quality.min);
    };
    Outcome best = *std::max_element(outcomes.begin(), outcomes.end(), rank);
    if (problem.mesh.topology().interior_nodes().size() <= most_nodes_to_improve) {
        const UntangleCase warped{example.sample, problem.mesh.with_coordinates(best.coordinates),
                                  problem.mesh.coordinates()};
        const auto improved = timed_guaranteed(warped, true);
        best.quality = judge(problem, improved.result.coordinates);
        add(By::best, "the best of these, then the guaranteed method", "none", best.quality, improved.seconds);
    }

    const auto is_near = [](const Outcome& here, double thesis) { return here.quality.min >= thesis - 0.05; };
    tables.literal_near.add(is_near(affine, example.affine.least) && is_near(convex, example.convex.least),
                            example.name);
    tables.best_above.add(best.quality.min > std::max(example.affine.least, example.convex.least), example.name);
    tables.best_valid.add(best.is_valid(), example.name);
    if (const PeerResult* peer = peers.best(example.sample))
        tables.above_peer.add(best.quality.min >= peer->least - 5e-4, example.name);
}

}  // namespace

void measure_warps(const Settings& settings, const Peers& peers, ThesisReport& report) {
    const bool wants_times = settings.wants("table", "2.4");
    const bool wants_quality = settings.wants("table", "2.5");
    if (!wants_times && !wants_quality && !settings.wants("table", "2.3")) return;
    Tables tables;
    for (const auto& example : published::warp_examples()) {
        tables.counts.add(By::thesis, example.name, "", {example.elements, example.order, example.interior_nodes},
                          example.remark);
        tables.times.add(By::thesis, example.name, "",
                         {example.neighbours, example.affine_weights, example.affine_solve, example.convex_weights,
                          example.convex_solve});
        for (const bool is_affine : {true, false}) {
            const auto& distortion = is_affine ? example.affine : example.convex;
            std::vector<Cell> row{is_affine ? "affine" : "convex"};
            for (const Cell& cell : cells(distortion)) row.push_back(cell);
            tables.quality.add(By::thesis, example.name, "", row);
        }
        const auto leave_out = [&](NotRun why, const std::string& explanation = "") {
            for (Comparison* table : {&tables.counts, &tables.times, &tables.quality})
                table->leave_out(example.name, why, explanation);
        };
        if (settings.is_quick && example.interior_nodes > 10000) {
            leave_out(NotRun::quick);
            continue;
        }
        std::optional<WarpCase> problem;
        try {
            problem = sample_warp_case(settings.samples, example.sample);
        } catch (const InvalidInput& error) {
            leave_out(NotRun::missing, error.what());
            continue;
        }
        const MeshTopology& topology = problem->mesh.topology();
        const auto nodes = static_cast<Index>(topology.interior_nodes().size());
        tables.counts.add(By::here, example.name, "remade", {topology.element_count(), topology.order(), nodes});
        if (wants_times) {
            tell(fmt::format("table 2.4: {}, {} nodes", example.name, nodes));
            const LiteralSolves solves = nodes > settings.example_lu_limit     ? LiteralSolves::none
                                         : nodes > settings.example_both_limit ? LiteralSolves::convex
                                                                               : LiteralSolves::both;
            const WarpTimes times = measure_warp_times(*problem, settings, solves);
            std::string remark = fmt::format("SparseLU and this program differ by {:.0e}", times.difference);
            if (solves == LiteralSolves::convex) remark += "; affine not run: the same matrix but for its numbers";
            if (solves == LiteralSolves::none)
                remark = fmt::format("SparseLU not run, it takes minutes: --lu-limit {}", nodes);
            if (times.unconverged) remark += fmt::format("; Alg. 3 did not converge at {} nodes", times.unconverged);
            tables.times.add(By::literal, example.name, "Alg. 2, Alg. 3, SparseLU", cells(times.literal), remark);
            tables.times.add(By::best, example.name, "this program's weights", cells(times.own));
            tables.quicker.add(
                *times.own.convex_solve + times.own.convex_weights < example.convex_weights + example.convex_solve,
                example.name);
        }
        if (wants_quality) {
            tell(fmt::format("table 2.5: {}", example.name));
            compare_quality(example, *problem, settings, peers, tables);
        }
        add_peers(example, topology.element_count(), peers, tables);
    }
    report.add(tables.counts);
    report.add(tables.times);
    if (wants_times)
        tables.quicker.tell_in(report, "table 2.4: convex weights and solution quicker than in the thesis",
                               "all examples");
    report.add(tables.quality);
    tables.literal_near.tell_in(report, "table 2.5: literal minima, affine and convex, at least the thesis's less .05",
                                "all examples");
    tables.best_above.tell_in(report, "table 2.5: best minimum above both of the thesis's", "all examples");
    tables.best_valid.tell_in(report, "table 2.5: every element valid in the best result", "all examples");
    tables.above_peer.tell_in(report, "table 2.5: best minimum at least the best peer's", "all examples");
}

}  // namespace curvewright::benchmarks
