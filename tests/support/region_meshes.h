#pragma once

#include <functional>
#include <string>
#include <vector>

#include "core/mesh/curved_mesh.h"

namespace curvewright::testing {

/// Whether the file has cells on the interface between two regions, and whether a group names them.
enum class InterfaceCells { none, unnamed, named };

/// A mesh of the unit square or cube with its elements in two groups, "near" (centre at x < 0.5) and "far". Cells on
/// the interface, if there are any, are on an entity of their own, named "interface". pre: no element has its centre at
/// 0.5.
CurvedMesh with_regions(const CurvedMesh& mesh, InterfaceCells cells);
/// The same with the elements in "near" that the function says, of any mesh. The elements of a block are sorted by
/// region.
CurvedMesh with_regions(const CurvedMesh& mesh, InterfaceCells cells,
                        const std::function<bool(Index element)>& is_near);

/// The mesh with one more cell on an entity of its own, in the group of that name.
CurvedMesh with_named_cell(const CurvedMesh& mesh, ElementType type, const std::vector<Index>& nodes,
                           const std::string& group);

/// The same mesh with every node of a unit square or cube moved by a smooth map that bends the plane x = 0.5 by up to
/// `height` and leaves the boundary where it is.
CurvedMesh with_bent_middle(const CurvedMesh& mesh, double height);

/// Area or volume of the elements of a group.
double size_of_group(const CurvedMesh& mesh, const std::string& group);

/// The node at a place, within 1e-12 in each coordinate. Throws InvalidInput if there is none.
Index node_at(const CurvedMesh& mesh, double x, double y, double z = 0.0);

}  // namespace curvewright::testing
