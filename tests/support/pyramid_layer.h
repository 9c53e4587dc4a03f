#pragma once

#include "core/mesh/curved_mesh.h"

namespace curvewright::testing {

/// The nodes of pyramid_layer_mesh that are inside the mesh.
inline constexpr int node_of_hexahedra = 13, node_of_pyramids = 22;

/// Two layers of 2 × 2 hexahedra of side 1 on [0, 2]^2 × [0, 2], on them four pyramids with their apices at z = 3, four
/// tetrahedra between these, and a pyramid upside down that fills the hole in their middle. Order 1; 8 hexahedra, then
/// 4 tetrahedra, then 5 pyramids. Two nodes are interior: one of hexahedra only, at (1, 1, 1), and one that belongs to
/// all pyramids, at (1, 1, 2).
CurvedMesh pyramid_layer_mesh();

}  // namespace curvewright::testing
