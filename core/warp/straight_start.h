#pragma once

#include "core/warp/warp.h"

namespace curvewright {

/// Moves the interior nodes of a mesh whose boundary was curved, corners included, to where the weights of the
/// straight-sided mesh on the same corners put them when its boundary moves to that of the given mesh. Where the
/// interior nodes of the given mesh lie does not matter but for the corners. Nodes of the boundary and of interfaces
/// stay bit for bit.
///
/// With an untangling method that moves high-order nodes only it makes the combination that the thesis plans (4.4).
/// Throws Unsupported (pyramids above order 1; see Warper), InvalidInput, SolverFailure, Cancelled.
WarpResult warp_from_straight(const CurvedMesh& mesh, const WarpOptions& options = {}, const TaskContext& context = {});

}  // namespace curvewright
