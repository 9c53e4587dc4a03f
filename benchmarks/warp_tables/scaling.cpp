#include <map>

#include "benchmarks/cases/reference.h"
#include "benchmarks/warp_tables/measure.h"
#include "benchmarks/warp_tables/measurements.h"

namespace curvewright::benchmarks {

void measure_scaling(const Settings& settings, int dimension, Report& report) {
    const std::string family = dimension == 2 ? "circle" : "sphere";
    const int last = settings.last_level(dimension), middle = (last + 1) / 2;
    const std::string what = dimension == 2 ? "unit disc, triangles" : "unit ball, tetrahedra";
    Table table{
        family,
        fmt::format("Scaling: {} family ({})", family, what),
        "Convex weights, default options. Total: the wall clock of the whole warp; \"rest\" is numbering, "
        "condensation and the way back to the mesh, \"solve\" includes the making of the preconditioner. SparseLU: "
        "factorisation and solution with the matrix of all interior nodes (same weights, without assembly); ratio: "
        "that over the total without neighbours and weights; difference: largest distance between the two "
        "results over the size of the mesh. No numbers: above the limit of the reference.",
        {"level", "order", "elements", "interior nodes", "neighbours, s", "weights, s", "solve, s", "rest, s",
         "total, s", "iterations", "residual", "µs/node", "SparseLU, s", "ratio", "difference"},
        {}};
    Plot total{family + "_total", fmt::format("Warp of the {} family", family), "interior nodes", "seconds", {}};
    Plot solve{
        family + "_solve", fmt::format("Linear system of the {} family", family), "interior nodes", "seconds", {}};
    for (const int order : {2, 3}) {
        Series totals{fmt::format("P{}, whole warp", order), order - 2, false, {}};
        Series weights{fmt::format("P{}, neighbours and weights", order), order, false, {}};
        Series solves{fmt::format("P{}, multilevel solver", order), order - 2, false, {}};
        Series references{fmt::format("P{}, SparseLU with COLAMD", order), order - 2, true, {}};
        std::map<int, double> per_node;
        for (int level = 0; level <= last; ++level) {
            const WarpCase problem = family_case(settings, dimension, level, order);
            tell(fmt::format("{}, {} nodes", problem.name, problem.mesh.topology().interior_nodes().size()));
            const TimedWarp timed = best_of([&] { return timed_warp(problem); });
            const WarpReport& r = timed.result.report;
            per_node[level] = timed.microseconds_per_node();
            std::vector<Cell> row{level,
                                  order,
                                  problem.mesh.topology().element_count(),
                                  r.interior_nodes,
                                  r.neighbours_seconds,
                                  r.weights_seconds,
                                  r.solve_seconds,
                                  timed.remaining_seconds() - r.solve_seconds,
                                  timed.seconds,
                                  r.iterations,
                                  formatted(r.residual, "{:.1e}"),
                                  per_node[level]};
            const auto nodes = static_cast<double>(r.interior_nodes);
            totals.points.emplace_back(nodes, timed.seconds);
            weights.points.emplace_back(nodes, timed.equations_seconds());
            solves.points.emplace_back(nodes, timed.remaining_seconds());
            if (settings.runs_reference(dimension, r.interior_nodes)) {
                const ReferenceSolve reference = solve_by_sparse_lu(problem, timed.result.coordinates);
                references.points.emplace_back(nodes, reference.seconds);
                row.insert(row.end(), {reference.seconds, reference.seconds / timed.remaining_seconds(),
                                       formatted(reference.difference, "{:.1e}")});
            }
            row.resize(table.columns.size());
            table.add(std::move(row));
        }
        const double growth = per_node[last] / per_node[middle];
        report.add(Target{
            fmt::format("{} family, P{}: time per node, level {} over level {}", family, order, last, middle), "≤ 2",
            fmt::format("{:.2f} ({:.2f} over {:.2f} µs)", growth, per_node[last], per_node[middle]), growth <= 2.0});
        total.series.push_back(totals);
        total.series.push_back(weights);
        solve.series.push_back(solves);
        solve.series.push_back(references);
    }
    report.add(table, {total, solve});
}

}  // namespace curvewright::benchmarks
