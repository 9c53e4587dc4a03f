#pragma once

#include <array>
#include <vector>

#include "core/basis/element_type.h"

namespace curvewright {

/// Integer coordinates of a node on the lattice of its reference element, each 0..order; unused ones are 0.
/// Simplices: i + j + k <= order. Prism: i + j <= order. Pyramid: i, j <= order - k (the apex is (0, 0, order)).
using LatticePoint = std::array<int, 3>;

/// The lattice points of an element in VTK's order for Lagrange cells (vtkHigherOrder*, VTK file version >= 2.1), which
/// is also the order of this program. VTK 9.1 has no Lagrange pyramid: pyramids keep Gmsh's order.
std::vector<LatticePoint> vtk_node_order(ElementType type);

/// The same lattice points in Gmsh's order (Gmsh reference manual, "Node ordering").
std::vector<LatticePoint> gmsh_node_order(ElementType type);

/// permutation[i] = position in Gmsh's list of the node that stands at position i in ours.
const std::vector<int>& gmsh_permutation(ElementType type);

}  // namespace curvewright
