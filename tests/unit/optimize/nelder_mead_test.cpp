#include "core/optimize/nelder_mead.h"

#include <gtest/gtest.h>

namespace curvewright {
namespace {

const auto silent = [](int, const auto&) {};

TEST(NelderMead, FindsTheMinimumOfAQuadratic) {
    const auto f = [](const std::array<double, 2>& p) { return std::pow(p[0] - 1, 2) + 4 * std::pow(p[1] + 2, 2) + 3; };
    const auto result = nelder_mead<2>(f, {0, 0}, 0.1, {400, 1e-8}, silent);
    EXPECT_TRUE(result.converged);
    EXPECT_NEAR(result.point[0], 1.0, 1e-6);
    EXPECT_NEAR(result.point[1], -2.0, 1e-6);
    EXPECT_NEAR(result.value, 3.0, 1e-10);
}

TEST(NelderMead, FindsTheMinimumOfRosenbrocksValley) {
    const auto f = [](const std::array<double, 2>& p) {
        return 100 * std::pow(p[1] - p[0] * p[0], 2) + std::pow(1 - p[0], 2);
    };
    const auto result = nelder_mead<2>(f, {-1.2, 1}, 0.1, {1000, 1e-8}, silent);
    EXPECT_TRUE(result.converged);
    EXPECT_NEAR(result.point[0], 1.0, 1e-5);
    EXPECT_NEAR(result.point[1], 1.0, 1e-5);
}

TEST(NelderMead, WorksInThreeDimensionsAndOnCorners) {
    const auto f = [](const std::array<double, 3>& p) {
        return std::abs(p[0] - 1) + std::abs(p[1]) + std::abs(p[2] + 1);
    };
    const auto result = nelder_mead<3>(f, {0.3, 0.4, 0.2}, 0.2, {2000, 1e-8}, silent);
    EXPECT_LT(result.value, 1e-3);
}

TEST(NelderMead, ReportsOrderedSimplicesThatNeverGetWorse) {
    const auto f = [](const std::array<double, 2>& p) { return std::pow(p[0] - 3, 4) + p[1] * p[1]; };
    double best = 1e300;
    int calls = 0;
    const auto result = nelder_mead<2>(f, {0, 1}, 0.5, {60, 1e-6}, [&](int iteration, const auto& simplex) {
        EXPECT_EQ(iteration, calls++);
        EXPECT_LE(simplex.values[0], simplex.values[1]);
        EXPECT_LE(simplex.values[1], simplex.values[2]);
        EXPECT_LE(simplex.values[0], best);
        best = simplex.values[0];
    });
    EXPECT_EQ(calls, result.iterations + 1);
    EXPECT_EQ(result.value, best);
}

TEST(NelderMead, StopsAtTheIterationLimit) {
    const auto f = [](const std::array<double, 2>& p) { return p[0] + p[1]; };  // unbounded below
    const auto result = nelder_mead<2>(f, {0, 0}, 1.0, {25, 1e-4}, silent);
    EXPECT_FALSE(result.converged);
    EXPECT_EQ(result.iterations, 25);
}

}  // namespace
}  // namespace curvewright
