#include "benchmarks/thesis/warp_times.h"

#include <algorithm>
#include <atomic>
#include <future>

#include "benchmarks/cases/reference.h"
#include "benchmarks/cases/timed.h"

namespace curvewright::benchmarks {
namespace {

struct TimedWeights {
    double seconds = 0.0;
    Index unconverged = 0;
};

TimedWeights affine_by_qr(const WarpCase& problem, const NeighbourSets& sets) {
    const Stopwatch watch;
    compute_weights(problem.mesh, sets, [](const Patch& patch, Eigen::Ref<Eigen::VectorXd> weights) {
        qr_weights(patch.offsets, weights);
        return PatchStatus::regular;
    });
    return {watch.seconds(), 0};
}

TimedWeights convex_by_kkt(const WarpCase& problem, const NeighbourSets& sets) {
    std::atomic<Index> unconverged = 0;
    const Stopwatch watch;
    compute_weights(problem.mesh, sets, [&](const Patch& patch, Eigen::Ref<Eigen::VectorXd> weights) {
        const Eigen::Index n = patch.offsets.rows();
        const KktSolver solver = n + patch.offsets.cols() + 1 <= 32 ? KktSolver::dense_lu : KktSolver::sparse_lu;
        if (!kkt_weights(patch.offsets, Eigen::VectorXd::Ones(n), solver, weights).has_converged) ++unconverged;
        return PatchStatus::regular;
    });
    return {watch.seconds(), unconverged};
}

TimedWeights own_weights(const WarpCase& problem, const NeighbourSets& sets, const WeightFunction& function) {
    const Stopwatch watch;
    compute_weights(problem.mesh, sets, function);
    return {watch.seconds(), 0};
}

}  // namespace

WarpCase as_published(const WarpCase& problem, Weighting weighting) {
    WarpCase same = problem;
    same.options.weighting = weighting;
    same.options.distance_power = same.options.sharing_power = 0.0;
    return same;
}

WarpTimes measure_warp_times(const WarpCase& problem, const Settings& settings, LiteralSolves solves) {
    const Repeats repeats = settings.repeats();
    WarpTimes times;
    std::vector<Index> free;
    const std::vector<bool> is_given = given_nodes(problem);
    for (const Index node : problem.mesh.topology().interior_nodes())
        if (!is_given[static_cast<std::size_t>(node)]) free.push_back(node);
    const auto neighbours =
        best_of([&] { return timed([&] { return find_neighbours(problem.mesh.topology(), free); }); }, repeats);
    times.literal.neighbours = neighbours.seconds;
    times.literal.affine_weights = best_of([&] { return affine_by_qr(problem, neighbours.result); }, repeats).seconds;
    const TimedWeights convex = best_of([&] { return convex_by_kkt(problem, neighbours.result); }, repeats);
    times.literal.convex_weights = convex.seconds;
    times.unconverged = convex.unconverged;

    WarpCase own = problem;
    times.own.neighbours = times.literal.neighbours;
    for (const Weighting weighting : {Weighting::affine, Weighting::convex}) {
        own.options.weighting = weighting;
        const bool is_affine = weighting == Weighting::affine;
        const WeightFunction function = is_affine
                                            ? affine_weighting(own.options.distance_power, own.options.sharing_power)
                                            : convex_weighting(own.options.distance_power, own.options.sharing_power);
        const double weights =
            best_of([&] { return own_weights(problem, neighbours.result, function); }, repeats).seconds;
        const double warp = best_of([&] { return timed_warp(own); }, repeats).seconds;
        (is_affine ? times.own.affine_weights : times.own.convex_weights) = weights;
        (is_affine ? times.own.affine_solve : times.own.convex_solve) =
            std::max(0.0, warp - weights - times.own.neighbours);
    }

    if (solves == LiteralSolves::none) return times;
    const auto solve = [&](Weighting weighting) {
        const WarpCase published = as_published(problem, weighting);
        return solve_by_sparse_lu(published, timed_warp(published).result.coordinates);
    };
    std::future<ReferenceSolve> affine;
    if (solves == LiteralSolves::both)
        affine =
            std::async(settings.threads > 1 ? std::launch::async : std::launch::deferred, solve, Weighting::affine);
    const ReferenceSolve convex_solve = solve(Weighting::convex);
    times.literal.convex_solve = convex_solve.seconds;
    times.difference = convex_solve.difference;
    if (affine.valid()) {
        const ReferenceSolve affine_solve = affine.get();
        times.literal.affine_solve = affine_solve.seconds;
        times.difference = std::max(times.difference, affine_solve.difference);
    }
    return times;
}

}  // namespace curvewright::benchmarks
