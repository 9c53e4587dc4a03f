#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace curvewright {

/// When a minimisation by Nelder-Mead stops.
struct NelderMeadOptions {
    int max_iterations = 400;
    /// The iteration ends when the spread of the values and the largest coordinate distance to the best vertex are both
    /// at most this.
    double tolerance = 1e-4;
};

/// The simplex after an iteration, with the function's values.
template <int Dim>
struct NelderMeadSimplex {
    std::array<std::array<double, Dim>, Dim + 1> vertices{};  ///< best first
    std::array<double, Dim + 1> values{};
};

/// How a minimisation by Nelder-Mead ended.
template <int Dim>
struct NelderMeadResult {
    std::array<double, Dim> point{};
    double value = 0.0;
    int iterations = 0;
    bool converged = false;  ///< false: max_iterations were made
};

/// Minimises function(point) by the Nelder-Mead simplex method (Lagarias, Reeds, Wright, Wright, SIAM J. Optim. 9,
/// 1998; coefficients 1, 2, 1/2, 1/2) from the simplex start, start + size e_i. Derivative-free; finds a local minimum.
/// each_iteration(iteration, simplex) is called with the ordered simplex at the start (iteration 0) and after each
/// step.
template <int Dim, class Function, class Callback>
NelderMeadResult<Dim> nelder_mead(Function&& function, const std::array<double, Dim>& start, double size,
                                  const NelderMeadOptions& options, Callback&& each_iteration) {
    using Point = std::array<double, Dim>;
    NelderMeadSimplex<Dim> simplex;
    auto& [vertices, values] = simplex;
    for (int i = 0; i <= Dim; ++i) {
        vertices[i] = start;
        if (i > 0) vertices[i][i - 1] += size;
        values[i] = function(vertices[i]);
    }
    const auto sort = [&] {
        // Insertion sort: stable, so that ties keep their order and the result does not depend on the library.
        for (int i = 1; i <= Dim; ++i)
            for (int j = i; j > 0 && values[j] < values[j - 1]; --j) {
                std::swap(values[j], values[j - 1]);
                std::swap(vertices[j], vertices[j - 1]);
            }
    };
    const auto along = [&](const Point& centroid, double factor) {
        Point point;
        for (int d = 0; d < Dim; ++d) point[d] = centroid[d] + factor * (vertices[Dim][d] - centroid[d]);
        return point;
    };
    const auto replace_worst = [&](const Point& point, double value) {
        vertices[Dim] = point;
        values[Dim] = value;
    };

    sort();
    each_iteration(0, std::as_const(simplex));
    NelderMeadResult<Dim> result;
    for (;; ++result.iterations) {
        double step = 0.0;
        for (int i = 1; i <= Dim; ++i)
            for (int d = 0; d < Dim; ++d) step = std::max(step, std::abs(vertices[i][d] - vertices[0][d]));
        result.converged = values[Dim] - values[0] <= options.tolerance && step <= options.tolerance;
        if (result.converged || result.iterations >= options.max_iterations) break;

        Point centroid{};
        for (int i = 0; i < Dim; ++i)
            for (int d = 0; d < Dim; ++d) centroid[d] += vertices[i][d] / Dim;
        const Point reflected = along(centroid, -1.0);
        const double reflected_value = function(reflected);
        bool shrink = false;
        if (reflected_value < values[0]) {
            const Point expanded = along(centroid, -2.0);
            const double expanded_value = function(expanded);
            if (expanded_value < reflected_value)
                replace_worst(expanded, expanded_value);
            else
                replace_worst(reflected, reflected_value);
        } else if (reflected_value < values[Dim - 1]) {
            replace_worst(reflected, reflected_value);
        } else if (reflected_value < values[Dim]) {
            const Point outside = along(centroid, -0.5);
            const double outside_value = function(outside);
            if (outside_value <= reflected_value)
                replace_worst(outside, outside_value);
            else
                shrink = true;
        } else {
            const Point inside = along(centroid, 0.5);
            const double inside_value = function(inside);
            if (inside_value < values[Dim])
                replace_worst(inside, inside_value);
            else
                shrink = true;
        }
        if (shrink)
            for (int i = 1; i <= Dim; ++i) {
                for (int d = 0; d < Dim; ++d) vertices[i][d] = 0.5 * (vertices[i][d] + vertices[0][d]);
                values[i] = function(vertices[i]);
            }
        sort();
        each_iteration(result.iterations + 1, std::as_const(simplex));
    }
    result.point = vertices[0];
    result.value = values[0];
    return result;
}

}  // namespace curvewright
