#pragma once

#include <vector>

#include "core/base/task.h"
#include "core/mesh/curved_mesh.h"

namespace curvewright {

/// Worst mean ratio of every element against its ideal: eta = d det(T)^(2/d) / |T|_F^2 with T = J W^-1, J the Jacobian
/// of the element map and W that of the ideal element at the same point; 1 = similar to the ideal, <= 0 = tangled. The
/// scaled Jacobian tells how evenly an element is stretched, this tells whether it is a sliver. Sampled on a lattice of
/// degree 3 p, of hexahedra and prisms at most 12 (Knupp, "Algebraic mesh quality metrics", SIAM J. Sci. Comput. 23,
/// 2001).
struct ShapeSummary {
    double min = 1.0, mean = 1.0;
};

/// ideal: nodes × 3; the ideal of an element is the straight-sided element on its corners there.
/// Where an ideal has no volume, or a quadrilateral, hexahedron or prism is folded, it is similar to nothing: eta = 0.
/// Pyramids are left out. Throws Unsupported like assess_quality.
ShapeSummary assess_shape(const CurvedMesh& mesh, const Coordinates& ideal, const TaskContext& context = {});

/// The same of every element, in the order of the mesh; NaN for pyramids.
std::vector<double> element_shapes(const CurvedMesh& mesh, const Coordinates& ideal, const TaskContext& context = {});

}  // namespace curvewright
