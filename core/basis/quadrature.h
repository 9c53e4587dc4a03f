#pragma once

#include <Eigen/Core>

#include "core/basis/element_type.h"

namespace curvewright {

/// Points and weights for integrals over a reference element; the weights sum to its measure.
struct QuadratureRule {
    Eigen::MatrixX3d points;  ///< n × 3, reference coordinates (unused ones 0)
    Eigen::VectorXd weights;  ///< n, positive
};

/// A rule that integrates polynomials exactly: up to the degree (in total) on simplices, in each direction on
/// quadrilaterals and hexahedra, in the triangle and along the axis on prisms. Products of Gauss-Legendre rules, on
/// simplices of the cube collapsed onto them (Stroud, "Approximate Calculation of Multiple Integrals", 1971).
/// Throws Unsupported for vertices and pyramids.
QuadratureRule quadrature(Shape shape, int degree);

}  // namespace curvewright
