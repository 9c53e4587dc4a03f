#pragma once

#include <array>
#include <vector>

#include <Eigen/Core>

#include "core/basis/element_type.h"
#include "core/basis/node_ordering.h"

namespace curvewright {

/// Values of the shape functions of a three-dimensional Lagrange element at single points: what drawing needs most,
/// without gradients and without allocations. Tetrahedra, hexahedra and prisms as lagrange_basis; pyramids by the
/// rational functions of Bergot, Cohen and Duruflé (2010), which on every face are the polynomials of that face.
class SolidBasis {
  public:
    /// Throws Unsupported if the shape is not three-dimensional.
    explicit SolidBasis(ElementType type);

    ElementType type() const { return type_; }
    int node_count() const { return static_cast<int>(lattice_.size()); }
    /// Writes node_count() values; they sum to 1. point: reference coordinates, as for lagrange_basis; a pyramid has
    /// its base in z = 0 on [0, 1]^2 and its apex at (0, 0, 1).
    void evaluate(const std::array<double, 3>& point, double* values) const;

  private:
    /// nodes of one column: the functions that span the pyramid's space.
    void evaluate_pyramid_modes(const std::array<double, 3>& point, double* modes) const;

    ElementType type_;
    std::vector<LatticePoint> lattice_;
    Eigen::MatrixXd nodes_from_modes_;  ///< pyramids: nodes × modes
};

}  // namespace curvewright
