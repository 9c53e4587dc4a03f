#pragma once

#include <array>

#include <Eigen/Core>

#include "core/basis/element_type.h"

namespace curvewright {

/// Shape functions of a Lagrange element at a set of points.
struct BasisTable {
    /// points × nodes: value of every shape function (a row sums to 1).
    Eigen::MatrixXd values;
    /// Per reference direction, points × nodes: derivative (a row sums to 0). Only the first `dimension` are filled.
    std::array<Eigen::MatrixXd, 3> gradients;
};

/// Evaluates the equispaced Lagrange basis, nodes in this program's order.
/// points: n × 3, reference coordinates in [0, 1]; the reference simplex has corners 0 and the unit vectors, prism and
/// hexahedron are products of it with [0, 1]. Simplices by Silvester's products of barycentric coordinates (Silvester,
/// "High-order polynomial triangular finite elements", 1969), exact at the nodes.
/// Throws Unsupported for pyramids, whose basis is rational.
BasisTable lagrange_basis(ElementType type, const Eigen::Ref<const Eigen::MatrixX3d>& points);

/// The points of the lattice of a degree on a reference element, of any degree: lattice / degree, points × 3.
Eigen::MatrixX3d lattice_points(Shape shape, int degree);

/// Reference coordinates of the nodes: lattice / order, nodes × 3.
Eigen::MatrixX3d reference_nodes(ElementType type);

}  // namespace curvewright
