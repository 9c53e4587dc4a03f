#include <algorithm>
#include <atomic>
#include <cmath>

#include "benchmarks/cases/reference.h"
#include "benchmarks/warp_tables/measure.h"
#include "benchmarks/warp_tables/measurements.h"
#include "core/base/parallel.h"
#include "core/base/stopwatch.h"

namespace curvewright::benchmarks {
namespace {

constexpr std::size_t sample_size = 2000;

/// Some nodes, evenly spread over the numbers.
std::vector<Index> sample(const std::vector<Index>& nodes) {
    if (nodes.size() <= sample_size) return nodes;
    std::vector<Index> some;
    for (std::size_t i = 0; i < sample_size; ++i) some.push_back(nodes[i * nodes.size() / sample_size]);
    return some;
}

struct TimedWeights {
    double seconds = 0.0;
    WeightTable table;
    double mean_iterations = 0.0;
    Index unconverged = 0;
};

TimedWeights measure_dual(const CurvedMesh& mesh, const NeighbourSets& sets, const InfluenceOptions& influence) {
    return best_of([&] {
        const Stopwatch watch;
        TimedWeights timed;
        timed.table = compute_weights(mesh, sets, convex_weighting(influence.distance_power, influence.sharing_power));
        timed.seconds = watch.seconds();
        return timed;
    });
}

/// Algorithm 3 in the same loop over the nodes.
TimedWeights measure_kkt(const CurvedMesh& mesh, const NeighbourSets& sets, const InfluenceOptions& influence,
                         KktSolver solver) {
    return best_of([&] {
        std::atomic<std::int64_t> iterations = 0;
        std::atomic<Index> unconverged = 0;
        const Stopwatch watch;
        TimedWeights timed;
        timed.table = compute_weights(mesh, sets, [&](const Patch& patch, Eigen::Ref<Eigen::VectorXd> weights) {
            const KktOutcome outcome = kkt_weights(patch.offsets, influences(patch, influence), solver, weights);
            iterations += outcome.iterations;
            if (!outcome.has_converged) ++unconverged;
            return PatchStatus::regular;
        });
        timed.seconds = watch.seconds();
        timed.mean_iterations = static_cast<double>(iterations) / static_cast<double>(sets.centers.size());
        timed.unconverged = unconverged;
        return timed;
    });
}

double largest_difference(const WeightTable& a, const WeightTable& b) {
    double difference = 0.0;
    for (std::size_t k = 0; k < a.weights.size(); ++k)
        difference = std::max(difference, std::abs(a.weights[k] - b.weights[k]));
    return difference;
}

std::vector<WarpCase> cases(const Settings& settings) {
    const int level = settings.is_quick ? 2 : 4;
    return {family_case(settings, 2, level, 2), family_case(settings, 2, level, 3), family_case(settings, 3, level, 2),
            family_case(settings, 3, level, 3), moving_sphere_case(settings)};
}

}  // namespace

void measure_weights(const Settings& settings, Report& report) {
    Table table{
        "weights",
        "Convex weights",
        fmt::format(
            "Newton's method on the dual problem (this program) against Algorithm 3, Newton's method on the full KKT "
            "system "
            "from an infeasible start (residual 1e-8, at most 500 iterations), with the KKT system solved by Eigen's "
            "dense LU with partial pivoting and by SparseLU with COLAMD. Both on the same {} nodes, evenly spread, on "
            "{} "
            "threads; \"all nodes\" is this program on the whole mesh. \"thesis\": all neighbours count alike "
            "(distance "
            "power 0, sharing power 0), \"default\": as the program weighs them. Ratios above 1: this program is "
            "quicker. "
            "Differences are the largest of any weight.",
            Cell(static_cast<Index>(sample_size)).shown, settings.threads),
        {"case", "influence", "nodes", "neighbours", "dual, µs/node", "all nodes, µs/node", "dense KKT, µs/node",
         "sparse KKT, µs/node", "KKT iterations", "not converged", "ratio dense", "ratio sparse", "difference"},
        {}};
    const WarpOptions defaults;
    std::vector<double> dense_ratios, sparse_ratios;
    for (const WarpCase& problem : cases(settings)) {
        const std::vector<Index>& interior = problem.mesh.topology().interior_nodes();
        const NeighbourSets all = find_neighbours(problem.mesh.topology(), interior);
        const NeighbourSets some = find_neighbours(problem.mesh.topology(), sample(interior));
        const double count = static_cast<double>(some.centers.size());
        for (const bool is_thesis : {true, false}) {
            tell(fmt::format("weights: {}, {}", problem.name, is_thesis ? "thesis" : "default"));
            const InfluenceOptions influence =
                is_thesis ? InfluenceOptions{} : InfluenceOptions{defaults.distance_power, defaults.sharing_power};
            const TimedWeights dual = measure_dual(problem.mesh, some, influence);
            const TimedWeights whole = measure_dual(problem.mesh, all, influence);
            const TimedWeights dense = measure_kkt(problem.mesh, some, influence, KktSolver::dense_lu);
            const TimedWeights sparse = measure_kkt(problem.mesh, some, influence, KktSolver::sparse_lu);
            const double dense_ratio = dense.seconds / dual.seconds, sparse_ratio = sparse.seconds / dual.seconds;
            table.add(
                {problem.name, is_thesis ? "thesis" : "default", static_cast<Index>(interior.size()),
                 formatted(static_cast<double>(all.nodes.size()) / static_cast<double>(interior.size()), "{:.1f}"),
                 1e6 * dual.seconds / count, 1e6 * whole.seconds / static_cast<double>(interior.size()),
                 1e6 * dense.seconds / count, 1e6 * sparse.seconds / count, formatted(dense.mean_iterations, "{:.1f}"),
                 dense.unconverged, dense_ratio, sparse_ratio,
                 formatted(largest_difference(dual.table, dense.table), "{:.1e}")});
            if (!is_thesis) continue;
            dense_ratios.push_back(dense_ratio);
            sparse_ratios.push_back(sparse_ratio);
        }
    }
    report.add(table);
    const auto add_target = [&](const char* solver, const std::vector<double>& ratios) {
        const auto [least, largest] = std::minmax_element(ratios.begin(), ratios.end());
        report.add(Target{fmt::format("convex weights against Algorithm 3, its full KKT system solved by {}", solver),
                          "≥ 25 times faster", fmt::format("{:.1f} to {:.1f} times", *least, *largest),
                          *least >= 25.0});
    };
    add_target("SparseLU with COLAMD", sparse_ratios);
    add_target("dense LU", dense_ratios);
}

}  // namespace curvewright::benchmarks
