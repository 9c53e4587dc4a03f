#include "core/linear/krylov.h"

#include <limits>

#include <gtest/gtest.h>

#include "core/base/parallel.h"
#include "tests/unit/linear/test_systems.h"

namespace curvewright {
namespace {

using testing::grid_system;
using testing::random_vectors;

MultiVector image(const BlockMatrix& matrix, const MultiVector& x) {
    MultiVector b;
    multiply(matrix, x, b);
    return b;
}

TEST(Krylov, SolvesManufacturedSystemsOfEveryBlockAndNumberOfVectors) {
    for (const double convection : {0.0, 8.0})
        for (int block = 1; block <= 3; ++block) {
            const LinearSystem system = grid_system(31, block, convection);
            const MultilevelPreconditioner preconditioner(system.matrix, system.coarse, system.sweep);
            for (int vectors = 1; vectors <= 4; ++vectors) {
                const MultiVector exact = random_vectors(system.matrix.rows * block, vectors, 3);
                const MultiVector b = image(system.matrix, exact);
                MultiVector x;
                const KrylovResult result =
                    solve_krylov(system.matrix, system.is_symmetric, preconditioner, b, x, {}, {});
                EXPECT_TRUE(result.has_converged);
                EXPECT_LT((x - exact).norm(), 1e-9 * exact.norm()) << convection << " " << block << " " << vectors;
                // The residual told is that of the solution given.
                double residual = 0.0;
                for (Eigen::Index v = 0; v < vectors; ++v)
                    residual = std::max(residual, (b - image(system.matrix, x)).col(v).norm() / b.col(v).norm());
                EXPECT_NEAR(result.residual, residual, 1e-15);
                EXPECT_GT(result.iterations, 2);
            }
        }
}

TEST(Krylov, IterationsDoNotGrowWithTheSystem) {
    for (const double convection : {0.0, 8.0}) {
        std::vector<int> iterations;
        for (const int n : {15, 31, 63, 127}) {
            const LinearSystem system = grid_system(n, 1, convection);
            const MultilevelPreconditioner preconditioner(system.matrix, system.coarse, system.sweep);
            MultiVector x;
            iterations.push_back(solve_krylov(system.matrix, system.is_symmetric, preconditioner,
                                              random_vectors(system.matrix.rows, 1, 1), x, {}, {})
                                     .iterations);
        }
        EXPECT_LE(iterations.back(), iterations.front() + 6);
        EXPECT_LE(iterations.back(), 24);
    }
}

TEST(Krylov, ColumnsOfDifferentDifficultyDoNotDisturbEachOther) {
    for (const double convection : {0.0, 8.0}) {
        const LinearSystem system = grid_system(31, 2, convection);
        const MultilevelPreconditioner preconditioner(system.matrix, system.coarse, system.sweep);
        const Eigen::Index rows = system.matrix.rows * 2;
        MultiVector b(rows, 4), x;
        b.col(0) = 1e-150 * random_vectors(rows, 1, 1);
        b.col(1).setZero();
        b.col(2) = image(system.matrix, MultiVector::Ones(rows, 1));
        b.col(3) = 1e100 * random_vectors(rows, 1, 2);
        const KrylovResult result = solve_krylov(system.matrix, system.is_symmetric, preconditioner, b, x, {}, {});
        EXPECT_TRUE(result.has_converged);
        EXPECT_TRUE(x.col(1).isZero(0.0));
        EXPECT_LT((x.col(2).array() - 1.0).abs().maxCoeff(), 1e-9);
        for (const int v : {0, 2, 3}) {
            MultiVector alone;
            solve_krylov(system.matrix, system.is_symmetric, preconditioner, b.col(v), alone, {}, {});
            EXPECT_LT((alone - x.col(v)).norm(), 1e-9 * alone.norm()) << v;
        }
    }
}

TEST(Krylov, StopsAtTheIterationsAllowedAndSaysSo) {
    for (const double convection : {0.0, 8.0}) {
        const LinearSystem system = grid_system(31, 1, convection);
        const MultilevelPreconditioner preconditioner(system.matrix, system.coarse, system.sweep);
        MultiVector x;
        const KrylovResult result = solve_krylov(system.matrix, system.is_symmetric, preconditioner,
                                                 random_vectors(system.matrix.rows, 2, 1), x, {1e-12, 3}, {});
        EXPECT_FALSE(result.has_converged);
        EXPECT_EQ(result.iterations, 3);
        EXPECT_GT(result.residual, 1e-11);
        EXPECT_LT(result.residual, 1.0);
    }
}

TEST(Krylov, ReachesTheResidualThatRoundingAllows) {
    // Far below what a recursively updated residual is worth: restarts from the true one must not loop for ever.
    const LinearSystem system = grid_system(31, 1, 8.0);
    const MultilevelPreconditioner preconditioner(system.matrix, system.coarse, system.sweep);
    MultiVector x;
    const KrylovResult result = solve_krylov(system.matrix, false, preconditioner,
                                             random_vectors(system.matrix.rows, 1, 1), x, {1e-30, 200}, {});
    EXPECT_FALSE(result.has_converged);
    EXPECT_LT(result.residual, 1e-13);
}

TEST(Krylov, RightHandSideThatIsNotFiniteDoesNotConverge) {
    const LinearSystem system = grid_system(15);
    const MultilevelPreconditioner preconditioner(system.matrix, system.coarse, system.sweep);
    for (const double value : {std::numeric_limits<double>::infinity(), std::numeric_limits<double>::quiet_NaN()}) {
        MultiVector b = random_vectors(system.matrix.rows, 2, 1), x;
        b(7, 1) = value;
        EXPECT_FALSE(solve_krylov(system.matrix, true, preconditioner, b, x, {}, {}).has_converged) << value;
    }
}

TEST(Krylov, SameBitsForEveryThreadCount) {
    for (const double convection : {0.0, 8.0}) {
        const LinearSystem system = grid_system(111, 1, convection);
        const MultiVector b = random_vectors(system.matrix.rows, 3, 1);
        std::vector<MultiVector> results(3);
        for (std::size_t i = 0; i < 3; ++i) {
            set_thread_count(1 << i);
            const MultilevelPreconditioner preconditioner(system.matrix, system.coarse, system.sweep);
            solve_krylov(system.matrix, system.is_symmetric, preconditioner, b, results[i], {}, {});
        }
        set_thread_count(0);
        EXPECT_EQ(results[0], results[1]);
        EXPECT_EQ(results[0], results[2]);
    }
}

TEST(Krylov, ReportsProgressThatOnlyGrowsAndCancels) {
    for (const double convection : {0.0, 8.0}) {
        const LinearSystem system = grid_system(31, 1, convection);
        const MultilevelPreconditioner preconditioner(system.matrix, system.coarse, system.sweep);
        const MultiVector b = random_vectors(system.matrix.rows, 1, 1);
        MultiVector x;
        double last = -1.0;
        int reports = 0;
        solve_krylov(system.matrix, system.is_symmetric, preconditioner, b, x, {},
                     {{}, [&](std::string_view phase, double fraction) {
                          EXPECT_EQ(phase, "Solving");
                          EXPECT_GE(fraction, last);
                          EXPECT_LE(fraction, 1.0);
                          last = fraction;
                          ++reports;
                      }});
        EXPECT_GT(reports, 3);
        EXPECT_GT(last, 0.5);
        std::stop_source source;
        int left = 3;
        const ProgressCallback stop = [&](std::string_view, double) {
            if (--left == 0) source.request_stop();
        };
        EXPECT_THROW(
            solve_krylov(system.matrix, system.is_symmetric, preconditioner, b, x, {}, {source.get_token(), stop}),
            Cancelled);
        EXPECT_EQ(left, 0);
    }
}

}  // namespace
}  // namespace curvewright
