#include "core/optimize/lbfgs.h"

#include <gtest/gtest.h>

namespace curvewright {
namespace {

const auto go_on = [](const Eigen::VectorXd&, double, int) { return true; };

/// Rosenbrock's valley in pairs of variables; minimum 0 at (1, …, 1).
double rosenbrock(const Eigen::VectorXd& x, Eigen::VectorXd& gradient) {
    double value = 0.0;
    for (Eigen::Index i = 0; i < x.size(); i += 2) {
        const double a = x[i + 1] - x[i] * x[i], b = 1.0 - x[i];
        value += 100.0 * a * a + b * b;
        gradient[i] = -400.0 * a * x[i] - 2.0 * b;
        gradient[i + 1] = 200.0 * a;
    }
    return value;
}

TEST(Lbfgs, FindsTheEndOfRosenbrocksValley) {
    Eigen::VectorXd x(10);
    for (Eigen::Index i = 0; i < x.size(); ++i) x[i] = i % 2 == 0 ? -1.2 : 1.0;
    LbfgsOptions options;
    options.max_iterations = 500;
    options.relative_decrease = 1e-16;
    const LbfgsResult result = minimize_lbfgs(x, rosenbrock, options, go_on);
    EXPECT_LT((x - Eigen::VectorXd::Ones(10)).norm(), 1e-6);
    EXPECT_LT(result.value, 1e-12);
    EXPECT_LT(result.iterations, 200);
}

TEST(Lbfgs, ValuesNeverRise) {
    Eigen::VectorXd x = Eigen::VectorXd::Constant(4, -2.0);
    double last = std::numeric_limits<double>::infinity();
    int steps = 0;
    minimize_lbfgs(x, rosenbrock, {}, [&](const Eigen::VectorXd&, double value, int iteration) {
        EXPECT_LT(value, last);
        EXPECT_EQ(iteration, ++steps);
        last = value;
        return true;
    });
    EXPECT_GT(steps, 5);
}

TEST(Lbfgs, StaysWhereTheFunctionIsFinite) {
    // -log(1 - |x|^2) + 5 x_0: infinite outside the unit ball.
    Eigen::VectorXd x = Eigen::VectorXd::Zero(3);
    const auto evaluate = [](const Eigen::VectorXd& v, Eigen::VectorXd& gradient) {
        const double room = 1.0 - v.squaredNorm();
        gradient = 2.0 * v / room;
        gradient[0] += 5.0;
        return room > 0.0 ? -std::log(room) + 5.0 * v[0] : std::numeric_limits<double>::infinity();
    };
    LbfgsOptions options;
    options.first_step = 10.0;
    options.relative_decrease = 1e-14;
    minimize_lbfgs(x, evaluate, options, go_on);
    // 2 x / (1 - x^2) = -5
    EXPECT_NEAR(x[0], (1.0 - std::sqrt(26.0)) / 5.0, 1e-6);
    EXPECT_LT(x.tail(2).norm(), 1e-6);
}

TEST(Lbfgs, SaysWhyItStopped) {
    Eigen::VectorXd x = Eigen::VectorXd::Constant(2, -1.0);
    LbfgsOptions options;
    options.max_iterations = 2;
    EXPECT_EQ(minimize_lbfgs(x, rosenbrock, options, go_on).reason, LbfgsStop::iteration_limit);
    EXPECT_EQ(minimize_lbfgs(x, rosenbrock, {}, [](const Eigen::VectorXd&, double, int) { return false; }).reason,
              LbfgsStop::stopped);
    // A gradient that points the wrong way.
    const auto liar = [](const Eigen::VectorXd& v, Eigen::VectorXd& gradient) {
        gradient = -2.0 * v;
        return v.squaredNorm();
    };
    EXPECT_EQ(minimize_lbfgs(x, liar, {}, go_on).reason, LbfgsStop::no_step);
    x.setZero();
    EXPECT_EQ(minimize_lbfgs(x, liar, {}, go_on).reason, LbfgsStop::converged);
}

}  // namespace
}  // namespace curvewright
