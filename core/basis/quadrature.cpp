#include "core/basis/quadrature.h"

#include <cmath>
#include <numbers>
#include <vector>

#include "core/base/error.h"

namespace curvewright {
namespace {

struct LineRule {
    std::vector<double> points, weights;  ///< on [0, 1]
};

/// Gauss-Legendre rule of n points: roots of the Legendre polynomial by Newton's method.
LineRule gauss_legendre(int n) {
    LineRule rule;
    rule.points.resize(static_cast<std::size_t>(n));
    rule.weights.resize(static_cast<std::size_t>(n));
    for (int i = 0; i < n; ++i) {
        double x = std::cos(std::numbers::pi * (i + 0.75) / (n + 0.5)), derivative = 1.0;
        for (int iteration = 0; iteration < 50; ++iteration) {
            double previous = 1.0, value = x;
            for (int k = 2; k <= n; ++k) {
                const double next = ((2 * k - 1) * x * value - (k - 1) * previous) / k;
                previous = value;
                value = next;
            }
            derivative = n * (x * value - previous) / (x * x - 1.0);
            const double step = value / derivative;
            x -= step;
            if (std::abs(step) < 1e-15) break;
        }
        rule.points[static_cast<std::size_t>(n - 1 - i)] = 0.5 * (1.0 + x);
        rule.weights[static_cast<std::size_t>(n - 1 - i)] = 1.0 / ((1.0 - x * x) * derivative * derivative);
    }
    return rule;
}

}  // namespace

QuadratureRule quadrature(Shape shape, int degree) {
    if (shape == Shape::vertex || shape == Shape::pyramid)
        throw Unsupported("There is no quadrature rule for a " + name(shape) + ".");
    const int dim = dimension(shape);
    // How often a direction is collapsed onto the ones before: each multiplies the integrand by one more factor.
    const bool is_collapsed = is_simplex(shape) && dim > 1;
    const int extra = is_collapsed ? dim - 1 : shape == Shape::prism ? 1 : 0;
    const LineRule line = gauss_legendre((degree + extra) / 2 + 1);
    const std::size_t n = line.points.size(), n1 = dim > 1 ? n : 1, n2 = dim > 2 ? n : 1;
    QuadratureRule rule;
    rule.points.setZero(static_cast<Eigen::Index>(n * n1 * n2), 3);
    rule.weights.resize(rule.points.rows());
    Eigen::Index q = 0;
    for (std::size_t k = 0; k < n2; ++k)
        for (std::size_t j = 0; j < n1; ++j)
            for (std::size_t i = 0; i < n; ++i, ++q) {
                const double u = line.points[i], v = dim > 1 ? line.points[j] : 0.0, w = dim > 2 ? line.points[k] : 0.0;
                double weight = line.weights[i] * (dim > 1 ? line.weights[j] : 1.0) * (dim > 2 ? line.weights[k] : 1.0);
                if (is_collapsed && dim == 3) {
                    rule.points.row(q) << u * (1.0 - v) * (1.0 - w), v * (1.0 - w), w;
                    weight *= (1.0 - v) * (1.0 - w) * (1.0 - w);
                } else if (is_collapsed || shape == Shape::prism) {
                    rule.points.row(q) << u * (1.0 - v), v, w;
                    weight *= 1.0 - v;
                } else {
                    rule.points.row(q) << u, v, w;
                }
                rule.weights[q] = weight;
            }
    return rule;
}

}  // namespace curvewright
