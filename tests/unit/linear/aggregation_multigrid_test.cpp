#include "core/linear/aggregation_multigrid.h"

#include <cmath>

#include <gtest/gtest.h>

#include "core/warp/elasticity.h"
#include "core/warp/equations.h"
#include "tests/support/mesh_factory.h"
#include "tests/unit/linear/test_systems.h"

namespace curvewright {
namespace {

using testing::grid_system;
using testing::random_vectors;

/// Largest factor by which a cycle changes the energy norm of the error, after the first cycles.
double reduction(const SparseRows& a, const AggregationMultigrid& multigrid) {
    MultiVector error = random_vectors(a.rows(), 1, 1);
    const auto energy = [&] { return std::sqrt((error.transpose() * (a * error))(0, 0)); };
    double worst = 0.0, before = energy();
    for (int cycle = 0; cycle < 12; ++cycle) {
        error -= multigrid.apply(a * error);
        const double after = energy();
        if (cycle >= 2) worst = std::max(worst, after / before);
        before = after;
    }
    return worst;
}

TEST(AggregationMultigrid, ReducesTheErrorOfALaplacianByAFixedFactor) {
    for (const int n : {47, 95, 191}) {
        const SparseRows a = to_sparse(grid_system(n).matrix);
        const AggregationMultigrid multigrid(a, 1, Eigen::MatrixXd::Ones(a.rows(), 1));
        EXPECT_GE(multigrid.level_count(), 2);
        EXPECT_LT(multigrid.operator_complexity(), 1.6);
        EXPECT_LT(reduction(a, multigrid), 0.55) << n;
    }
}

TEST(AggregationMultigrid, StretchedLaplacianIsCoarsenedAlongTheStrongDirection) {
    // 100 times stronger along x: aggregates must follow, or the factor comes close to 1.
    std::vector<Eigen::Triplet<double>> entries;
    constexpr int n = 63;
    const auto id = [](int i, int j) { return j * n + i; };
    for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i) {
            entries.emplace_back(id(i, j), id(i, j), 202.0);
            if (i > 0) entries.emplace_back(id(i, j), id(i - 1, j), -100.0);
            if (i + 1 < n) entries.emplace_back(id(i, j), id(i + 1, j), -100.0);
            if (j > 0) entries.emplace_back(id(i, j), id(i, j - 1), -1.0);
            if (j + 1 < n) entries.emplace_back(id(i, j), id(i, j + 1), -1.0);
        }
    SparseRows a(n * n, n * n);
    a.setFromTriplets(entries.begin(), entries.end());
    const AggregationMultigrid multigrid(a, 1, Eigen::MatrixXd::Ones(a.rows(), 1));
    EXPECT_LT(reduction(a, multigrid), 0.6);
}

TEST(AggregationMultigrid, SmallSystemsAreSolvedAtOnce) {
    const SparseRows a = to_sparse(grid_system(15).matrix);
    const AggregationMultigrid multigrid(a, 1, Eigen::MatrixXd::Ones(a.rows(), 1));
    EXPECT_EQ(multigrid.level_count(), 1);
    EXPECT_EQ(multigrid.operator_complexity(), 1.0);
    const MultiVector exact = random_vectors(a.rows(), 20, 2);  // more than the sweeps take at once
    EXPECT_LT((multigrid.apply(a * exact) - exact).norm(), 1e-12 * exact.norm());
}

TEST(AggregationMultigrid, IsSymmetricAndTheSameForManyVectorsAsForOne) {
    const SparseRows a = to_sparse(grid_system(63).matrix);
    const AggregationMultigrid multigrid(a, 1, Eigen::MatrixXd::Ones(a.rows(), 1));
    const MultiVector b = random_vectors(a.rows(), 20, 3), x = multigrid.apply(b);
    const Eigen::MatrixXd products = b.transpose() * x;
    EXPECT_LT((products - products.transpose()).norm(), 1e-12 * products.norm());
    for (const Eigen::Index v : {0, 15, 19}) {
        const MultiVector alone = multigrid.apply(b.col(v));
        EXPECT_LT((alone - x.col(v)).norm(), 1e-13 * alone.norm());
    }
}

TEST(AggregationMultigrid, RigidModesServeElasticity) {
    for (const int dim : {2, 3}) {
        const CurvedMesh mesh = dim == 2 ? testing::square_mesh(40, 1) : testing::cube_mesh(10, 1);
        // Held at one side only: a beam, whose rigid modes are nearly free.
        std::vector<bool> is_given(static_cast<std::size_t>(mesh.topology().node_count()), false);
        Numbering numbering;
        numbering.number_of.assign(is_given.size(), -1);
        for (const bool given : {false, true})
            for (Index node = 0; node < mesh.topology().node_count(); ++node) {
                if ((mesh.coordinates()(node, 0) == 0.0) != given) continue;
                numbering.number_of[static_cast<std::size_t>(node)] = static_cast<Index>(numbering.nodes.size());
                numbering.nodes.push_back(node);
                if (!given) numbering.free = numbering.solved = static_cast<Index>(numbering.nodes.size());
            }
        numbering.group_offsets = {numbering.free};
        const CondensedEquations equations = condense(numbering, elastic_equations(mesh, numbering, ElasticMaterial{}));
        const SparseRows a = to_sparse(equations.matrix);
        const Eigen::MatrixXd modes = vertex_space(mesh, numbering, dim).near_null;
        EXPECT_EQ(modes.cols(), dim == 2 ? 3 : 6);
        const AggregationMultigrid rigid(a, dim, modes), constant(a, dim, modes.leftCols(dim));
        EXPECT_GE(rigid.level_count(), 2);
        EXPECT_LT(rigid.operator_complexity(), dim == 2 ? 2.0 : 2.5);
        const double with_modes = reduction(a, rigid);
        EXPECT_LT(with_modes, 0.75) << dim;
        EXPECT_LT(with_modes, reduction(a, constant));
    }
}

TEST(AggregationMultigrid, DecoupledAndSingularMatrices) {
    // A diagonal matrix has no couplings to aggregate along; it must come out solved all the same.
    constexpr int n = 1500;
    SparseRows diagonal(n, n);
    for (int i = 0; i < n; ++i) diagonal.insert(i, i) = 1.0 + i;
    const AggregationMultigrid multigrid(diagonal, 1, Eigen::MatrixXd::Ones(n, 1));
    const MultiVector exact = random_vectors(n, 2, 5);
    EXPECT_LT((multigrid.apply(diagonal * exact) - exact).norm(), 1e-12 * exact.norm());

    SparseRows singular(3, 3);
    singular.insert(0, 0) = 1.0;
    singular.insert(1, 1) = 1.0;
    EXPECT_THROW(AggregationMultigrid(singular, 1, Eigen::MatrixXd::Ones(3, 1)), SolverFailure);
}

TEST(AggregationMultigrid, Cancels) {
    const SparseRows a = to_sparse(grid_system(63).matrix);
    std::stop_source source;
    source.request_stop();
    EXPECT_THROW(AggregationMultigrid(a, 1, Eigen::MatrixXd::Ones(a.rows(), 1), {source.get_token(), {}}), Cancelled);
}

}  // namespace
}  // namespace curvewright
