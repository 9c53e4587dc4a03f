#pragma once

#include <vector>

#include "core/base/task.h"
#include "core/mesh/curved_mesh.h"

namespace curvewright {

/// Length, area or volume of every curved element (of the mesh's dimension), in the mesh's unit, in its order: the
/// integral of |J| over each quadrature point's share, so that what is folded over counts twice. Exact for valid
/// elements of flat and solid meshes. NaN for pyramids, whose shape functions are rational. Throws Cancelled.
std::vector<double> element_sizes(const CurvedMesh& mesh, const TaskContext& context = {});

}  // namespace curvewright
