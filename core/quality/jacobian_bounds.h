#pragma once

#include <array>
#include <vector>

#include <Eigen/Core>

#include "core/basis/bernstein.h"
#include "core/quality/bernstein_minimum.h"
#include "core/quality/quality.h"

namespace curvewright {

/// The Jacobian determinant of a curved element in Bernstein-Bézier form, and proved bounds of it.
///
/// The reference element is a product of simplices; an element map of order p has degree p in each of them. A partial
/// derivative lowers the degree of its own factor by one, so that J has the degree (p - 1) dim on a simplex,
/// (2 p - 1, 2 p - 1) on a quadrilateral, 3 p - 1 in each direction on a hexahedron, and 3 p - 2 in the triangle and
/// 3 p - 1 along the axis on a prism. The Bézier coefficients of the derivatives follow from the nodes by a small
/// matrix, and J is a sum of products of them, computed by Bernstein multiplication (Farin, "Curves and Surfaces for
/// CAGD", 17.8). That needs far fewer operations than sampling J at its own lattice and converting, and it is better
/// conditioned. Rounding is bounded a priori: see coefficient_error.
///
/// One object per thread: it owns work space. The tables it uses are shared.
class JacobianBounds {
  public:
    /// type: triangle, quadrilateral, tetrahedron, hexahedron or prism of order 1..max_order. Throws Unsupported for
    /// others.
    explicit JacobianBounds(ElementType type);

    /// Certified quality of one element. x: nodes × 3 (2D: z is not read). sign: +1, or -1 for meshes of negative
    /// orientation: J is multiplied by it.
    ElementQuality bound(const Eigen::Ref<const Eigen::MatrixX3d>& x, double sign, const QualityOptions& options);

    /// Bézier coefficients of sign·J·2^-exponent() (positions of form()) of the last element given to compute(), and a
    /// bound of their rounding error. The power of two makes every coordinate's extent about 1, so that no product
    /// over- or underflows whatever the unit of length. NaN if the element's extent is not finite.
    const std::vector<double>& coefficients() const { return coefficients_; }
    double coefficient_error() const { return error_; }
    int exponent() const { return exponent_; }
    const BernsteinForm& form() const;
    void compute(const Eigen::Ref<const Eigen::MatrixX3d>& x, double sign);

  private:
    struct Tables;
    static const Tables& tables(ElementType type);
    /// Fills positions_ and exponent_. extents: of the scaled coordinates. False if they are not finite.
    bool place(const Eigen::Ref<const Eigen::MatrixX3d>& x, std::array<double, 3>& extents);
    /// Fills the column c of derivatives_.
    template <class Matrices, class Real>
    void differentiate(const std::vector<Matrices>& matrices, int c, std::array<std::vector<Real>, 2>& work);
    const double* derivative(int direction, int coordinate) const;

    const Tables& tables_;
    int dimension_;
    std::vector<double> coefficients_;
    double error_ = 0.0;
    int exponent_ = 0;
    Eigen::MatrixXd positions_;    ///< nodes (ordered as a product) × dimension: relative to node 0, scaled
    Eigen::MatrixXd derivatives_;  ///< (coefficients of all directions) × dimension
    std::array<std::vector<double>, 3> minors_;
    std::vector<double> box_, negated_;
    std::array<std::vector<double>, 2> work_;
    std::array<std::vector<long double>, 2> extended_work_;
    BernsteinMinimizer minimizer_;
};

}  // namespace curvewright
