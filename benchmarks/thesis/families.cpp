#include <map>
#include <optional>

#include "benchmarks/thesis/measurements.h"
#include "benchmarks/thesis/published.h"
#include "benchmarks/thesis/warp_times.h"
#include "core/base/error.h"

namespace curvewright::benchmarks {
namespace {

const char* family_name(int dimension) {
    return dimension == 2 ? "circle" : "sphere";
}

/// The levels that --quick runs.
bool is_run(const Settings& settings, int dimension, int level) {
    return !settings.is_quick || level <= (dimension == 2 ? 3 : 2);
}

Comparison counts_of(const Settings& settings, int dimension) {
    Comparison counts(
        {"table", dimension == 2 ? "2.1" : "2.2"}, fmt::format("the {} family", family_name(dimension)),
        "Elements and nodes of the meshes that figures 2.2 and 2.3 measure, at orders 2 and 3. Each level "
        "is a mesh of its own, of a size chosen to give the thesis's number of elements.",
        "level", {"elements", "nodes, P2", "interior, P2", "nodes, P3", "interior, P3"});
    for (const auto& level : published::family_levels(dimension)) {
        const std::string what = fmt::format("{}", level.level);
        counts.add(By::thesis, what, "",
                   {level.elements, level.nodes_p2, level.interior_p2, level.nodes_p3, level.interior_p3},
                   level.remark);
        if (!is_run(settings, dimension, level.level)) {
            counts.leave_out(what, NotRun::quick);
            continue;
        }
        try {
            std::vector<Cell> cells;
            for (const int order : {2, 3}) {
                const WarpCase problem = family_case(settings.families, dimension, level.level, order);
                const MeshTopology& topology = problem.mesh.topology();
                if (order == 2) cells.emplace_back(topology.element_count());
                cells.emplace_back(topology.node_count());
                cells.emplace_back(static_cast<Index>(topology.interior_nodes().size()));
            }
            counts.add(By::here, what, "remade", cells);
        } catch (const InvalidInput& error) {
            counts.leave_out(what, NotRun::missing, error.what());
        }
    }
    return counts;
}

/// The curves of one family in the plots.
struct Curves {
    std::map<std::string, Series> by_name;
    std::vector<std::string> order;

    void add(const std::string& name, int color, bool is_literal, double nodes, double seconds) {
        if (!by_name.contains(name)) {
            by_name[name] = {name, color, is_literal, {}};
            order.push_back(name);
        }
        by_name[name].points.emplace_back(nodes, seconds);
    }
    std::vector<Series> series() const {
        std::vector<Series> all;
        for (const std::string& name : order) all.push_back(by_name.at(name));
        return all;
    }
};

std::vector<Cell> solve_cells(Index nodes, const PhaseTimes& times) {
    const auto cell = [](const std::optional<double>& seconds) { return seconds ? Cell(*seconds) : Cell(); };
    return {nodes, cell(times.affine_solve), cell(times.convex_solve)};
}

}  // namespace

void count_families(const Settings& settings, ThesisReport& report) {
    for (const int dimension : {2, 3})
        if (const char* number = dimension == 2 ? "2.1" : "2.2"; settings.wants("table", number)) {
            tell(fmt::format("table {}", number));
            report.add(counts_of(settings, dimension));
        }
}

void measure_families(const Settings& settings, ThesisReport& report) {
    if (!settings.wants_any({{"figure", "2.2"}, {"figure", "2.3"}})) return;
    Comparison weights({"figure", "2.2"}, "times of the weights",
                       fmt::format("Seconds on {} threads for the weights of all interior nodes. The thesis shows "
                                   "plots without numbers. Literal: Algorithm 2 (QR) and Algorithm 3 (Newton's method "
                                   "on the KKT system). Best: this program's.",
                                   settings.threads),
                       "mesh", {"interior nodes", "neighbours, s", "affine weights, s", "convex weights, s"});
    Comparison solves(
        {"figure", "2.3"}, "times of the linear systems",
        "Seconds for the linear system with all its right-hand sides. Literal: Eigen's SparseLU with "
        "COLAMD on the matrix of all interior nodes; affine and convex at the same time, one thread each. "
        "Best: everything of a warp but neighbours and weights: numbering, equations, condensation, "
        "preconditioner, solution, coordinates. In 3D the factors grow faster than the mesh; SparseLU is "
        "left out above the limit that the remark names.",
        "mesh", {"interior nodes", "affine, s", "convex, s"});
    std::vector<Plot> weight_plots, solve_plots;
    Tally quicker_weights, quicker_solves, solved;
    for (const int dimension : {2, 3}) {
        Curves weight_curves, solve_curves;
        for (const int order : {2, 3})
            for (const auto& level : published::family_levels(dimension)) {
                const std::string what = fmt::format("{} {}, P{}", family_name(dimension), level.level, order);
                weights.expect(what);
                solves.expect(what);
                const auto leave_out = [&](NotRun why, const std::string& explanation = "") {
                    weights.leave_out(what, why, explanation);
                    solves.leave_out(what, why, explanation);
                };
                if (!is_run(settings, dimension, level.level)) {
                    leave_out(NotRun::quick);
                    continue;
                }
                std::optional<WarpCase> problem;
                try {
                    problem = family_case(settings.families, dimension, level.level, order);
                } catch (const InvalidInput& error) {
                    leave_out(NotRun::missing, error.what());
                    continue;
                }
                const auto nodes = static_cast<Index>(problem->mesh.topology().interior_nodes().size());
                const Index limit = dimension == 2 ? settings.family_lu_limit_2d : settings.family_lu_limit_3d;
                const bool runs_lu = nodes <= limit && settings.wants("figure", "2.3");
                tell(fmt::format("figures 2.2 and 2.3: {}, {} nodes", what, nodes));
                const WarpTimes times =
                    measure_warp_times(*problem, settings, runs_lu ? LiteralSolves::both : LiteralSolves::none);
                const auto weight_cells = [&](const PhaseTimes& t) {
                    return std::vector<Cell>{nodes, t.neighbours, t.affine_weights, t.convex_weights};
                };
                weights.add(By::literal, what, "Alg. 2, Alg. 3", weight_cells(times.literal),
                            times.unconverged ? fmt::format("Alg. 3 did not converge at {} nodes", times.unconverged)
                                              : std::string());
                weights.add(By::best, what, "Cholesky, dual Newton", weight_cells(times.own));
                solves.add(By::literal, what, "SparseLU, COLAMD", solve_cells(nodes, times.literal),
                           runs_lu ? fmt::format("differs from this program's result by {:.0e}", times.difference)
                                   : fmt::format("not run: more than {} nodes", Cell(limit).shown));
                solves.add(By::best, what, "multilevel", solve_cells(nodes, times.own));
                const auto x = static_cast<double>(nodes);
                const int color = 2 * (order - 2);
                const auto name = [&](const char* kind, const char* method) {
                    return fmt::format("P{}, {}, {}", order, kind, method);
                };
                weight_curves.add(name("affine", "Alg. 2"), color, true, x, times.literal.affine_weights);
                weight_curves.add(name("convex", "Alg. 3"), color + 1, true, x, times.literal.convex_weights);
                weight_curves.add(name("affine", "this program"), color, false, x, times.own.affine_weights);
                weight_curves.add(name("convex", "this program"), color + 1, false, x, times.own.convex_weights);
                solved.add(runs_lu, what);
                if (runs_lu) {
                    solve_curves.add(name("affine", "SparseLU"), color, true, x, *times.literal.affine_solve);
                    solve_curves.add(name("convex", "SparseLU"), color + 1, true, x, *times.literal.convex_solve);
                    quicker_solves.add(*times.own.convex_solve < *times.literal.convex_solve, what);
                }
                solve_curves.add(name("affine", "this program"), color, false, x, *times.own.affine_solve);
                solve_curves.add(name("convex", "this program"), color + 1, false, x, *times.own.convex_solve);
                quicker_weights.add(times.own.convex_weights < times.literal.convex_weights, what);
            }
        const char* part = dimension == 2 ? "a" : "b";
        weight_plots.push_back({fmt::format("figure_2.2{}", part),
                                fmt::format("Figure 2.2 ({}): weights on the {} family", part, family_name(dimension)),
                                "interior nodes", "seconds", weight_curves.series()});
        solve_plots.push_back(
            {fmt::format("figure_2.3{}", part),
             fmt::format("Figure 2.3 ({}): linear system on the {} family", part, family_name(dimension)),
             "interior nodes", "seconds", solve_curves.series()});
    }
    report.add(weights, weight_plots);
    if (settings.wants("figure", "2.2"))
        quicker_weights.tell_in(report, "figure 2.2: convex weights quicker than Algorithm 3", "all meshes");
    report.add(solves, solve_plots);
    if (settings.wants("figure", "2.3")) {
        solved.tell_in(report, "figure 2.3: SparseLU was run", "all meshes within its limit of nodes");
        quicker_solves.tell_in(report, "figure 2.3: linear system quicker than SparseLU", "all of these meshes");
    }
}

}  // namespace curvewright::benchmarks
