#include "core/optimize/bfgs.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

namespace curvewright {
namespace {

template <class Evaluate>
BfgsResult minimize(Eigen::VectorXd& x, const Evaluate& evaluate, const BfgsOptions& options) {
    Eigen::VectorXd unused;
    return minimize_bfgs(
        x, evaluate, [&](const Eigen::VectorXd& v) { return evaluate(v, unused); }, options, [](const BfgsState&) {});
}

TEST(Bfgs, FindsTheMinimumOfQuadratics) {
    std::mt19937 random(1);
    std::uniform_real_distribution<double> uniform(-1.0, 1.0);
    for (int n = 1; n <= 8; ++n) {
        const Eigen::MatrixXd root = Eigen::MatrixXd::NullaryExpr(n, n, [&] { return uniform(random); });
        const Eigen::MatrixXd hessian = root * root.transpose() + 0.1 * Eigen::MatrixXd::Identity(n, n);
        const Eigen::VectorXd center = Eigen::VectorXd::NullaryExpr(n, [&] { return uniform(random); });
        Eigen::VectorXd x = Eigen::VectorXd::Zero(n);
        const BfgsResult result = minimize(x,
                                           [&](const Eigen::VectorXd& v, Eigen::VectorXd& gradient) {
                                               gradient = hessian * (v - center);
                                               return 0.5 * (v - center).dot(gradient);
                                           },
                                           {.max_iterations = 500, .gradient_tolerance = 1e-9});
        EXPECT_TRUE(result.converged) << n;
        EXPECT_LT((x - center).norm(), 1e-7) << n;
    }
}

TEST(Bfgs, FollowsRosenbrocksValley) {
    Eigen::VectorXd x(2);
    x << -1.2, 1.0;
    const BfgsResult result = minimize(x,
                                       [](const Eigen::VectorXd& v, Eigen::VectorXd& gradient) {
                                           const double a = 1.0 - v[0], b = v[1] - v[0] * v[0];
                                           gradient.resize(2);
                                           gradient << -2.0 * a - 400.0 * v[0] * b, 200.0 * b;
                                           return a * a + 100.0 * b * b;
                                       },
                                       {.max_iterations = 200, .gradient_tolerance = 1e-8});
    EXPECT_TRUE(result.converged);
    EXPECT_LT((x - Eigen::Vector2d(1.0, 1.0)).norm(), 1e-7);
}

TEST(Bfgs, TheFirstStepIsTheGradientOverTheInitialHessian) {
    Eigen::VectorXd x(2);
    x << 3.0, -4.0;
    std::vector<Eigen::VectorXd> seen;
    const auto linear = [](const Eigen::VectorXd& v, Eigen::VectorXd& gradient) {
        gradient = Eigen::Vector2d(1.0, 2.0);
        return v[0] + 2.0 * v[1];
    };
    Eigen::VectorXd unused;
    const BfgsResult result = minimize_bfgs(
        x, linear, [&](const Eigen::VectorXd& v) { return linear(v, unused); },
        BfgsOptions{.max_iterations = 3, .initial_hessian = 4.0},
        [&](const BfgsState& state) {
            EXPECT_EQ(state.iteration, static_cast<int>(seen.size()));
            EXPECT_DOUBLE_EQ(state.gradient_norm, std::sqrt(5.0));
            seen.push_back(state.x);
        });
    // No curvature: no update, so that every step is the same.
    ASSERT_EQ(seen.size(), 4u);
    for (int i = 0; i < 4; ++i)
        EXPECT_LT((seen[i] - (Eigen::Vector2d(3.0, -4.0) - i * Eigen::Vector2d(0.25, 0.5))).norm(), 1e-14);
    EXPECT_FALSE(result.converged);
    EXPECT_EQ(result.iterations, 3);
}

TEST(Bfgs, HalvesStepsUntilTheDecreaseSufficesAndStaysWhereNoneDoes) {
    Eigen::VectorXd x = Eigen::VectorXd::Constant(1, 1.0);
    double step = -1.0;
    const auto square = [](const Eigen::VectorXd& v, Eigen::VectorXd& gradient) {
        gradient = 2.0 * v;
        return v.squaredNorm();
    };
    Eigen::VectorXd unused;
    minimize_bfgs(
        x, square, [&](const Eigen::VectorXd& v) { return square(v, unused); },
        BfgsOptions{.max_iterations = 1, .initial_hessian = 0.25}, [&](const BfgsState& state) { step = state.step; });
    EXPECT_EQ(step, 0.125);  // 8: too far by all means, 4 and 2: no decrease, 1: exact
    EXPECT_EQ(x[0], 0.0);

    // A gradient that is wrong: no step along it lowers the value.
    x[0] = 1.0;
    const BfgsResult result = minimize(x,
                                       [](const Eigen::VectorXd& v, Eigen::VectorXd& gradient) {
                                           gradient = -2.0 * v;
                                           return v.squaredNorm();
                                       },
                                       {});
    EXPECT_EQ(x[0], 1.0);
    EXPECT_FALSE(result.converged);
    EXPECT_EQ(result.iterations, 0);
}

TEST(Bfgs, EndsAtOnceWhereTheGradientIsZero) {
    Eigen::VectorXd x = Eigen::VectorXd::Constant(4, 2.0);
    const BfgsResult result = minimize(x,
                                       [](const Eigen::VectorXd& v, Eigen::VectorXd& gradient) {
                                           gradient.setZero(v.size());
                                           return 7.0;
                                       },
                                       {});
    EXPECT_TRUE(result.converged);
    EXPECT_EQ(result.iterations, 0);
    EXPECT_EQ(result.value, 7.0);
}

}  // namespace
}  // namespace curvewright
