#pragma once

#include <optional>

#include "core/base/task.h"
#include "core/mesh/curved_mesh.h"
#include "core/mesh/node_sources.h"

namespace curvewright {

/// What a mesh of another order does with the shape of its cells.
enum class ElevatedGeometry {
    kept,     ///< nodes are images of their lattice points under the old cell's own polynomial map
    straight  ///< nodes are the affine (multilinear) images of the lattice: only the corners count
};

/// Options of elevate.
struct ElevateOptions {
    int order = 1;  ///< of the result, 1 to 10
    ElevatedGeometry geometry = ElevatedGeometry::kept;
};

/// How far the elements of a mesh of another order are from those they were made of: the largest distance between the
/// images of one reference point under both maps, at the points of a lattice that is twice as fine as the old nodes'.
/// What lies between these points can differ by a little more.
struct GeometryDistance {
    double absolute = 0.0;  ///< in the mesh's unit of length
    double relative = 0.0;  ///< to the diagonal of the old mesh's bounding box
    Index element = 0;      ///< where it is
    Index unmeasured = 0;   ///< pyramids above order 1, whose map is not known here
};

/// What elevate returns.
struct ElevateResult {
    CurvedMesh mesh;
    NodeSources sources;
    /// Not given where the geometry is the same by construction: kept, and no element's order was lowered.
    std::optional<GeometryDistance> distance;
};

/// The mesh of another order: every cell of every dimension becomes a Lagrange cell of that order. With
/// ElevatedGeometry::kept a raised order leaves the geometry as it is, exactly but for rounding, since the polynomials
/// of the old order are among those of the new one; a lowered order interpolates at the coarser lattice. Cells of order
/// 1 give the same positions either way, bit for bit.
///
/// Corner nodes and all elements, entities and groups keep their tags; so do other nodes whose lattice point is one of
/// the new lattice (kept geometry only). New nodes are shared between cells that shared all nodes of the edge or face
/// they lie on, get the tags after the highest one and the entity of the lowest-dimensional cell that they lie on.
/// Nodes of no cell are kept.
///
/// Cells of several orders: edges and faces with the same corners become one. Throws Unsupported if neighbouring
/// elements of different orders do not agree on where it lies (kept geometry), for orders outside 1..10 and for
/// pyramids that would get another order above 1; Cancelled.
ElevateResult elevate(const CurvedMesh& mesh, const ElevateOptions& options, const TaskContext& context = {});

/// The mesh alone, its geometry kept.
CurvedMesh elevate(const CurvedMesh& mesh, int order, const TaskContext& context = {});

}  // namespace curvewright
