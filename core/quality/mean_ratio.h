#pragma once

#include <cmath>

namespace curvewright {

/// A squared norm below this is taken for this: what has shrunk to a point is similar to nothing.
constexpr double smallest_squared_norm = 1e-100;

/// det(T)^2 / |T|^6 (2D: det(T) / |T|^2) with the sign of det(T), which orders as the mean ratio of T does. For arrays
/// of values.
template <int Dim, class Determinant, class SquaredNorm>
auto power_of_ratio(const Determinant& det, const SquaredNorm& norm) {
    if constexpr (Dim == 2)
        return det / norm;
    else
        return det * det.abs() / (norm * norm * norm);
}

/// The mean ratio whose power_of_ratio() this is.
template <int Dim>
double mean_ratio(double power) {
    return Dim == 2 ? 2.0 * power : 3.0 * std::cbrt(power);
}

/// The determinant of a Dim × Dim matrix of arrays; at(i, j): an entry.
template <int Dim, class At>
auto determinant_of(const At& at) {
    if constexpr (Dim == 2)
        return at(0, 0) * at(1, 1) - at(0, 1) * at(1, 0);
    else
        return at(0, 0) * (at(1, 1) * at(2, 2) - at(1, 2) * at(2, 1)) +
               at(0, 1) * (at(1, 2) * at(2, 0) - at(1, 0) * at(2, 2)) +
               at(0, 2) * (at(1, 0) * at(2, 1) - at(1, 1) * at(2, 0));
}

}  // namespace curvewright
