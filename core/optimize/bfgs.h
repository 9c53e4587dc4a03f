#pragma once

#include <limits>

#include <Eigen/Cholesky>
#include <Eigen/Core>

namespace curvewright {

/// Where a minimisation by BFGS begins and ends.
struct BfgsOptions {
    int max_iterations = 100;
    /// Ends when the gradient's norm is at most this.
    double gradient_tolerance = 1e-6;
    /// The first approximation of the Hessian is this multiple of the identity, so the first step is -gradient / this.
    double initial_hessian = 1.0;
    /// Halvings of a step before the method gives up.
    int max_halvings = 60;
};

/// The state after an accepted step; iteration 0 is the start.
struct BfgsState {
    int iteration = 0;
    const Eigen::VectorXd& x;
    double value = 0.0;
    double gradient_norm = 0.0;
    double step = 0.0;  ///< fraction of the quasi-Newton step that was taken; 0 at the start
};

/// How a minimisation by BFGS ended; where stands in the caller's x.
struct BfgsResult {
    double value = 0.0;
    int iterations = 0;
    bool converged = false;  ///< false: max_iterations were made or no step lowers the function
};

/// Minimises a function of few variables by the BFGS method with a dense Hessian approximation (thesis, Alg. 5;
/// Nocedal, Wright, "Numerical Optimization", 2nd ed., chapter 6): the direction from a Cholesky factorisation, steps
/// halved until Armijo's condition with 1e-4 holds, an update only if y·s > 0, so that the approximation stays positive
/// definite. evaluate(x, gradient) returns the value and writes the gradient; value(x) returns the value alone.
/// each_iteration(state) is called for the start and after every step. x: the start and the result.
template <class Evaluate, class Value, class EachIteration>
BfgsResult minimize_bfgs(Eigen::VectorXd& x, const Evaluate& evaluate, const Value& value_at,
                         const BfgsOptions& options, const EachIteration& each_iteration) {
    BfgsResult result;
    Eigen::VectorXd gradient(x.size()), next_gradient(x.size());
    Eigen::MatrixXd hessian = options.initial_hessian * Eigen::MatrixXd::Identity(x.size(), x.size());
    result.value = evaluate(x, gradient);
    for (double step = 0.0;;) {
        each_iteration(BfgsState{result.iterations, x, result.value, gradient.norm(), step});
        result.converged = gradient.norm() <= options.gradient_tolerance;
        if (result.converged || result.iterations >= options.max_iterations) return result;
        const Eigen::LLT<Eigen::MatrixXd> factor(hessian);
        const Eigen::VectorXd direction = -factor.solve(gradient);
        const double slope = gradient.dot(direction);
        if (!(slope < 0.0)) return result;  // rounding has spoilt the approximation
        step = 1.0;
        int halvings = 0;
        for (double value = value_at(x + direction);
             // The second comparison counts where rounding swallows the demanded decrease.
             !(value <= result.value + 1e-4 * step * slope && value < result.value);
             value = value_at(x + step * direction)) {
            if (++halvings > options.max_halvings) return result;
            step *= 0.5;
        }
        const Eigen::VectorXd s = step * direction;
        x += s;
        result.value = evaluate(x, next_gradient);
        const Eigen::VectorXd y = next_gradient - gradient;
        const double curvature = y.dot(s);
        if (curvature > 0.0) {
            const Eigen::VectorXd hessian_s = hessian * s;
            hessian += y * y.transpose() / curvature - hessian_s * hessian_s.transpose() / s.dot(hessian_s);
        }
        gradient.swap(next_gradient);
        ++result.iterations;
    }
}

}  // namespace curvewright
