#pragma once

#include <array>
#include <vector>

#include <Eigen/Core>

#include "core/quality/quality.h"

namespace curvewright {

/// The Jacobian determinant of a curved simplex in Bernstein-Bézier form, and proved bounds of it.
///
/// The partial derivatives of the element map are polynomials of degree p - 1; their Bézier coefficients follow from
/// the nodes by one small matrix each, and J is a sum of products of them, computed by Bernstein multiplication (Farin,
/// "Curves and Surfaces for CAGD", 17.8). That needs far fewer operations than sampling J at its own lattice of degree
/// d (p - 1) and converting, and it is better conditioned. Rounding is bounded a priori: see coefficient_error.
///
/// One object per thread: it owns work space. The tables it uses are shared.
class JacobianBounds {
  public:
    /// type: triangle or tetrahedron of order 1..max_order.
    explicit JacobianBounds(ElementType type);

    /// Certified quality of one element. x: nodes × 3 (triangles: z is not read). sign: +1, or -1 for meshes of
    /// negative orientation: J is multiplied by it.
    ElementQuality bound(const Eigen::Ref<const Eigen::MatrixX3d>& x, double sign, const QualityOptions& options);

    /// Bézier coefficients of sign·J·2^-exponent() (degree d (p - 1), positions of BernsteinSimplex) of the last element
    /// given to compute(), and a bound of their rounding error. The power of two makes every coordinate's extent about 1,
    /// so that no product over- or underflows whatever the unit of length. NaN if the element's extent is not finite.
    const std::vector<double>& coefficients() const { return coefficients_; }
    double coefficient_error() const { return error_; }
    int exponent() const { return exponent_; }
    void compute(const Eigen::Ref<const Eigen::MatrixX3d>& x, double sign);

  private:
    struct Tables;
    struct Extremum {
        double attained = 0.0;  ///< value at a point of the element, up to rounding
        double bound = 0.0;     ///< proved bound on the far side of the extremum
        double error = 0.0;     ///< rounding bound of `attained`
        std::array<double, 3> point{};
    };
    static const Tables& tables(ElementType type);
    /// Minimum of the polynomial with the given coefficients. magnitude: some attained |J|, as large as known.
    Extremum minimize(const std::vector<double>& coefficients, double magnitude, bool settle_sign,
                      const QualityOptions& options) const;

    ElementType type_;
    int dimension_;
    const Tables& tables_;
    std::vector<double> coefficients_;
    double error_ = 0.0;
    int exponent_ = 0;
    std::array<std::array<Eigen::VectorXd, 3>, 3> derivative_;  ///< [direction][coordinate]
    std::vector<double> minor_, product_, negated_;
};

}  // namespace curvewright
