#pragma once

#include <cmath>
#include <deque>
#include <limits>
#include <vector>

#include <Eigen/Core>

namespace curvewright {

/// When a minimisation by L-BFGS stops, and what it remembers.
struct LbfgsOptions {
    int max_iterations = 100;
    int history = 8;
    /// Ends when an iteration lowers the objective by less than this, relative to its size + 1, three times in a row.
    double relative_decrease = 1e-6;
    /// Length of the very first step, in the unit of the variables.
    double first_step = 0.05;
    int max_line_search = 20;
};

/// Why a minimisation by L-BFGS ended.
enum class LbfgsStop {
    converged,  ///< the objective falls no more, or the gradient is zero
    iteration_limit,
    no_step,  ///< no point along the descent direction is better
    stopped,  ///< the caller's callback asked for it
};

/// How a minimisation by L-BFGS ended.
struct LbfgsResult {
    double value = 0.0;
    int iterations = 0, evaluations = 0;
    LbfgsStop reason = LbfgsStop::converged;
};

/// Minimises a smooth function by the limited-memory BFGS method (Nocedal, Wright, "Numerical Optimization", 2nd ed.,
/// alg. 7.4 and 7.5) with a backtracking line search (Armijo's condition with 1e-4; pairs are kept only when s·y > 0).
/// evaluate(x, gradient) returns the value and writes the gradient; infinity marks points outside the domain.
/// after_step(x, value, iteration) is called after every accepted step and returns false to stop. x: the start, which
/// must have a finite value, and the result.
template <class Evaluate, class AfterStep>
LbfgsResult minimize_lbfgs(Eigen::VectorXd& x, const Evaluate& evaluate, const LbfgsOptions& options,
                           const AfterStep& after_step) {
    struct Pair {
        Eigen::VectorXd s, y;
        double rho;
    };
    std::deque<Pair> pairs;
    LbfgsResult result;
    Eigen::VectorXd gradient(x.size()), next_gradient(x.size()), next(x.size()), direction(x.size());
    result.value = evaluate(x, gradient);
    ++result.evaluations;
    int flat = 0;
    std::vector<double> alpha;
    for (;;) {
        const double gradient_norm = gradient.norm();
        if (!(gradient_norm > 0.0)) return result;
        if (result.iterations >= options.max_iterations) {
            result.reason = LbfgsStop::iteration_limit;
            return result;
        }
        direction = -gradient;
        alpha.assign(pairs.size(), 0.0);
        for (std::size_t i = pairs.size(); i-- > 0;) {
            alpha[i] = pairs[i].rho * pairs[i].s.dot(direction);
            direction -= alpha[i] * pairs[i].y;
        }
        if (!pairs.empty()) direction *= 1.0 / (pairs.back().rho * pairs.back().y.squaredNorm());
        for (std::size_t i = 0; i < pairs.size(); ++i)
            direction += (alpha[i] - pairs[i].rho * pairs[i].y.dot(direction)) * pairs[i].s;
        double slope = gradient.dot(direction);
        if (!(slope < 0.0)) {
            pairs.clear();
            direction = -gradient;
            slope = -gradient_norm * gradient_norm;
        }
        double step = pairs.empty() ? options.first_step / gradient_norm : 1.0;
        double value = std::numeric_limits<double>::infinity();
        int tries = 0;
        for (; tries < options.max_line_search; ++tries) {
            next = x + step * direction;
            value = evaluate(next, next_gradient);
            ++result.evaluations;
            if (std::isfinite(value) && value <= result.value + 1e-4 * step * slope) break;
            // The minimum of the parabola through what is known, within bounds; half where nothing is known.
            double shorter = 0.5 * step;
            if (std::isfinite(value)) {
                const double curvature = value - result.value - step * slope;
                if (curvature > 0.0) shorter = -0.5 * slope * step * step / curvature;
            }
            step = std::min(0.5 * step, std::max(0.1 * step, shorter));
        }
        if (tries == options.max_line_search) {
            if (pairs.empty()) {
                result.reason = LbfgsStop::no_step;
                return result;
            }
            pairs.clear();  // once more along the gradient
            continue;
        }
        Pair pair{next - x, next_gradient - gradient, 0.0};
        const double curvature = pair.s.dot(pair.y);
        if (curvature > 1e-12 * pair.s.norm() * pair.y.norm()) {
            pair.rho = 1.0 / curvature;
            pairs.push_back(std::move(pair));
            if (static_cast<int>(pairs.size()) > options.history) pairs.pop_front();
        }
        const double decrease = result.value - value;
        x.swap(next);
        gradient.swap(next_gradient);
        result.value = value;
        ++result.iterations;
        if (!after_step(x, value, result.iterations)) {
            result.reason = LbfgsStop::stopped;
            return result;
        }
        flat = decrease <= options.relative_decrease * (std::abs(value) + 1.0) ? flat + 1 : 0;
        if (flat == 3) return result;
    }
}

}  // namespace curvewright
