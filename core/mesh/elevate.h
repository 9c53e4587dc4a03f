#pragma once

#include "core/base/task.h"
#include "core/mesh/curved_mesh.h"

namespace curvewright {

/// The straight-sided mesh of the given order (1 to 10) on the same corners: every cell of every dimension becomes a
/// Lagrange cell of that order whose nodes are the affine (multilinear) images of the lattice. Corner nodes and all
/// elements, entities and groups keep their tags; new nodes are shared between neighbours, get the tags after the
/// highest one and the entity of the lowest-dimensional cell that they lie on. Nodes of no cell are kept, nodes of the
/// old order that are not corners go. Throws Unsupported for orders outside 1..10 and for pyramids above order 1, Cancelled.
CurvedMesh elevate(const CurvedMesh& mesh, int order, const TaskContext& context = {});

}  // namespace curvewright
