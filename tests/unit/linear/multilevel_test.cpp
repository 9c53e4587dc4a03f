#include "core/linear/multilevel.h"

#include <gtest/gtest.h>
#include <Eigen/Cholesky>
#include <Eigen/LU>

#include "core/base/parallel.h"
#include "tests/unit/linear/test_systems.h"

namespace curvewright {
namespace {

using testing::block_matrix;
using testing::BlockMap;
using testing::grid_system;
using testing::random_vectors;

MultiVector apply(const MultilevelPreconditioner& preconditioner, const MultiVector& r) {
    MultiVector z;
    MultilevelPreconditioner::Workspace work;
    preconditioner.apply(r, z, work, {});
    return z;
}

TEST(Multilevel, IsSymmetricAndPositiveForASymmetricMatrix) {
    for (int block = 1; block <= 3; ++block) {
        const LinearSystem system = grid_system(31, block);
        const MultilevelPreconditioner preconditioner(system.matrix, system.coarse, system.sweep);
        const MultiVector r = random_vectors(system.matrix.rows * block, 4, 2);
        const Eigen::MatrixXd products = r.transpose() * apply(preconditioner, r);
        EXPECT_LT((products - products.transpose()).cwiseAbs().maxCoeff(), 1e-12 * products.norm());
        EXPECT_GT(products.selfadjointView<Eigen::Lower>().ldlt().vectorD().minCoeff(), 0.0);
    }
}

TEST(Multilevel, OneApplicationRemovesAlmostTheWholeOfASmoothError) {
    const LinearSystem system = grid_system(63);
    MultiVector smooth(system.matrix.rows, 1);
    // Interpolated from the coarse grid, so that what is left is the work of the smoother and of the multigrid.
    const double pi = 3.14159265358979;
    Eigen::VectorXd coarse(31 * 31);
    for (int j = 0; j < 31; ++j)
        for (int i = 0; i < 31; ++i) coarse[j * 31 + i] = std::sin(pi * (i + 1) / 32.0) * std::sin(pi * (j + 1) / 32.0);
    smooth = system.coarse.prolongation * coarse;
    MultiVector b;
    multiply(system.matrix, smooth, b);
    const auto error_with = [&](const CoarseSpace& space) {
        return (apply(MultilevelPreconditioner(system.matrix, space, system.sweep), b) - smooth).norm() / smooth.norm();
    };
    EXPECT_LT(error_with(system.coarse), 0.3);
    EXPECT_GT(error_with({}), 0.9);  // Gauss-Seidel alone does nothing to it
}

TEST(Multilevel, WithoutCoarseSpaceItIsOneSymmetricGaussSeidelSweep) {
    const LinearSystem system = grid_system(9, 2, 3.0, false);
    const Eigen::MatrixXd a = to_sparse(system.matrix);
    const MultilevelPreconditioner preconditioner(system.matrix, {});
    EXPECT_EQ(preconditioner.description(), "Gauss-Seidel");
    const MultiVector r = random_vectors(a.rows(), 3, 4);
    // By blocks: (D + L) x = r, then (D + U) (z - x) = r - A x.
    Eigen::MatrixXd lower = Eigen::MatrixXd::Zero(a.rows(), a.rows()), upper = lower;
    for (Eigen::Index i = 0; i < a.rows(); ++i)
        for (Eigen::Index j = 0; j < a.rows(); ++j) {
            if (j / 2 <= i / 2) lower(i, j) = a(i, j);
            if (j / 2 >= i / 2) upper(i, j) = a(i, j);
        }
    const Eigen::MatrixXd x = lower.fullPivLu().solve(Eigen::MatrixXd(r));
    const Eigen::MatrixXd z = x + upper.fullPivLu().solve(r - a * x);
    EXPECT_LT((apply(preconditioner, r) - z).cwiseAbs().maxCoeff(), 1e-13);
}

TEST(Multilevel, StagesGiveWhatTheSequentialSweepGives) {
    LinearSystem system = grid_system(95, 2);
    const MultiVector r = random_vectors(system.matrix.rows * 2, 3, 4);
    const MultiVector sequential = apply(MultilevelPreconditioner(system.matrix, system.coarse), r);
    for (const int threads : {1, 2, 4}) {
        set_thread_count(threads);
        EXPECT_EQ(apply(MultilevelPreconditioner(system.matrix, system.coarse, system.sweep), r), sequential);
    }
    set_thread_count(0);
}

TEST(Multilevel, RefusesAStageWithCoupledPieces) {
    LinearSystem system = grid_system(31);
    ASSERT_GT(system.sweep.stages.size(), 2u);
    system.sweep.stages = {0, system.sweep.stages.back()};  // all bands at once: neighbours among them
    EXPECT_THROW(MultilevelPreconditioner(system.matrix, system.coarse, system.sweep), SolverFailure);
}

TEST(Multilevel, RefusesASingularDiagonalBlock) {
    Eigen::Matrix2d singular;
    singular << 1, 2, 2, 4;
    const BlockMap blocks{{{0, 0}, Eigen::Matrix2d::Identity()}, {{1, 1}, singular}};
    EXPECT_THROW(MultilevelPreconditioner(block_matrix(blocks, 2, 2, 2), {}), SolverFailure);
}

TEST(Multilevel, RefusesARowWithoutDiagonal) {
    const Eigen::MatrixXd one = Eigen::MatrixXd::Ones(1, 1);
    const BlockMap blocks{{{0, 0}, 2.0 * one}, {{0, 1}, one}, {{1, 0}, one}};
    const BlockMatrix matrix = block_matrix(blocks, 2, 2, 1);
    EXPECT_THROW(MultilevelPreconditioner(matrix, {}), SolverFailure);
}

TEST(Multilevel, DescribesItself) {
    const LinearSystem system = grid_system(31);
    EXPECT_EQ(MultilevelPreconditioner(system.matrix, system.coarse).description(),
              "Gauss-Seidel and 1 level over 225 vertices");
}

TEST(Multilevel, RowScaleMakesAScaledSymmetricSystemAsEasyAsTheSymmetricOne) {
    // Rows of a symmetric matrix divided by factors that vary: the given scale undoes them in the coarse equations.
    LinearSystem system = grid_system(63);
    const MultiVector b = random_vectors(system.matrix.rows, 1, 1);
    const Eigen::MatrixXd reference = apply(MultilevelPreconditioner(system.matrix, system.coarse), b);
    Eigen::VectorXd scale(system.matrix.rows);
    for (Eigen::Index i = 0; i < scale.size(); ++i) scale[i] = 1.0 + 0.9 * std::sin(0.1 * static_cast<double>(i));
    MultiVector scaled_b = b;
    for (Index row = 0; row < system.matrix.rows; ++row) {
        for (std::size_t k = system.matrix.offsets[row]; k < system.matrix.offsets[row + 1]; ++k)
            system.matrix.values[k] /= scale[row];
        scaled_b.row(row) /= scale[row];
    }
    system.coarse.row_scale = scale;
    EXPECT_LT((apply(MultilevelPreconditioner(system.matrix, system.coarse), scaled_b) - reference).norm(),
              1e-12 * reference.norm());
}

TEST(Multilevel, Cancels) {
    const LinearSystem system = grid_system(31);
    std::stop_source source;
    const TaskContext context{source.get_token(), {}};
    const MultilevelPreconditioner preconditioner(system.matrix, system.coarse, system.sweep, context);
    source.request_stop();
    EXPECT_THROW(MultilevelPreconditioner(system.matrix, system.coarse, system.sweep, context), Cancelled);
    MultiVector z;
    MultilevelPreconditioner::Workspace work;
    EXPECT_THROW(preconditioner.apply(random_vectors(system.matrix.rows, 1, 1), z, work, context), Cancelled);
}

}  // namespace
}  // namespace curvewright
