#include "core/tessellate/solid_basis.h"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>

#include "core/base/error.h"
#include "core/basis/reference_element.h"

namespace curvewright {
namespace {

using Factors = std::array<double, max_order + 1>;

/// Silvester's P_m(t) = prod_{k<m} (p t - k) / (k + 1), m = 0 .. p.
Factors silvester(int order, double t) {
    Factors factors{};
    factors[0] = 1.0;
    for (int m = 1; m <= order; ++m) factors[m] = factors[m - 1] * (order * t - (m - 1)) / m;
    return factors;
}

/// The order + 1 shape functions of a line.
Factors line_functions(int order, double t) {
    const Factors up = silvester(order, t), down = silvester(order, 1.0 - t);
    Factors values{};
    for (int m = 0; m <= order; ++m) values[m] = up[m] * down[order - m];
    return values;
}

/// Jacobi polynomials P_k^(alpha, 0)(x), k = 0 .. order, by their recurrence.
Factors jacobi(int order, double alpha, double x) {
    Factors p{};
    p[0] = 1.0;
    if (order > 0) p[1] = 0.5 * (alpha + (alpha + 2.0) * x);
    for (int k = 2; k <= order; ++k) {
        const double c = 2.0 * k + alpha;
        const double a = 2.0 * k * (k + alpha) * (c - 2.0);
        const double b = (c - 1.0) * (c * (c - 2.0) * x + alpha * alpha);
        const double d = 2.0 * (k + alpha - 1.0) * (k - 1.0) * c;
        p[k] = (b * p[k - 1] - d * p[k - 2]) / a;
    }
    return p;
}

}  // namespace

SolidBasis::SolidBasis(ElementType type) : type_(type) {
    if (dimension(type.shape) != 3)
        throw Unsupported("Only tetrahedra, hexahedra, prisms and pyramids have an inside that can be cut.");
    lattice_ = reference_element(type).lattice;
    if (type.shape != Shape::pyramid) return;
    const auto count = static_cast<Eigen::Index>(lattice_.size());
    Eigen::MatrixXd vandermonde(count, count);  // modes × nodes
    for (Eigen::Index node = 0; node < count; ++node) {
        const LatticePoint& at = lattice_[static_cast<std::size_t>(node)];
        const double p = type.order;
        evaluate_pyramid_modes({at[0] / p, at[1] / p, at[2] / p}, vandermonde.col(node).data());
    }
    nodes_from_modes_ = vandermonde.inverse();
}

void SolidBasis::evaluate_pyramid_modes(const std::array<double, 3>& point, double* modes) const {
    const int p = type_.order;
    const double z = point[2], width = 1.0 - z;
    // At the apex only the functions without a factor of the width are left.
    const double a = width > 1e-14 ? point[0] / width : 0.5, b = width > 1e-14 ? point[1] / width : 0.5;
    const Factors along_x = jacobi(p, 0.0, 2.0 * a - 1.0), along_y = jacobi(p, 0.0, 2.0 * b - 1.0);
    double power = 1.0;
    for (int most = 0; most <= p; ++most) {
        const Factors along_z = jacobi(p - most, 2.0 * most + 2.0, 2.0 * z - 1.0);
        for (int other = 0; other <= most; ++other)
            for (int swap = 0; swap < (other < most ? 2 : 1); ++swap) {
                const double plane = swap == 0 ? along_x[most] * along_y[other] : along_x[other] * along_y[most];
                for (int k = 0; k <= p - most; ++k) *modes++ = plane * power * along_z[k];
            }
        power *= width > 1e-14 ? width : 0.0;
    }
}

void SolidBasis::evaluate(const std::array<double, 3>& point, double* values) const {
    const int p = type_.order;
    const auto [x, y, z] = point;
    switch (type_.shape) {
        case Shape::tetrahedron: {
            const Factors fx = silvester(p, x), fy = silvester(p, y), fz = silvester(p, z),
                          rest = silvester(p, 1.0 - x - y - z);
            for (const auto& [i, j, k] : lattice_) *values++ = fx[i] * fy[j] * fz[k] * rest[p - i - j - k];
            return;
        }
        case Shape::prism: {
            const Factors fx = silvester(p, x), fy = silvester(p, y), rest = silvester(p, 1.0 - x - y),
                          fz = line_functions(p, z);
            for (const auto& [i, j, k] : lattice_) *values++ = fx[i] * fy[j] * rest[p - i - j] * fz[k];
            return;
        }
        case Shape::hexahedron: {
            const Factors fx = line_functions(p, x), fy = line_functions(p, y), fz = line_functions(p, z);
            for (const auto& [i, j, k] : lattice_) *values++ = fx[i] * fy[j] * fz[k];
            return;
        }
        default: {
            constexpr int most_nodes = 506;  // of order 10
            std::array<double, most_nodes> modes;
            evaluate_pyramid_modes(point, modes.data());
            const auto count = static_cast<Eigen::Index>(lattice_.size());
            Eigen::Map<Eigen::VectorXd>(values, count).noalias() =
                nodes_from_modes_ * Eigen::Map<const Eigen::VectorXd>(modes.data(), count);
            return;
        }
    }
}

}  // namespace curvewright
