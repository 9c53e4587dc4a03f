#pragma once

#include "core/boundary/boundary_parts.h"
#include "core/edit/selection.h"
#include "core/warp/response.h"

namespace curvewright {

/// How the weight of a node falls from 1 at the selection to 0 at the radius; t = distance / radius.
enum class Falloff {
    smooth,  ///< 1 - 3 t^2 + 2 t^3: level at both ends
    sphere,  ///< sqrt(1 - t^2)
    root,    ///< sqrt(1 - t)
    linear,  ///< 1 - t
    sharp,   ///< (1 - t)^2
};
/// "smooth", "sphere", "root", "linear", "sharp".
const char* to_string(Falloff falloff);
/// t >= 0; 0 from t = 1 on.
double falloff_weight(Falloff falloff, double t);

/// How far a selection reaches, and how its hold falls off.
struct SoftSelection {
    double radius = 0.0;  ///< mesh units; 0 = the selected nodes alone
    Falloff falloff = Falloff::smooth;
    /// Along the boundary (so that the far side of a thin body stays), else as the crow flies.
    bool follows_boundary = true;
};

/// The boundary nodes that a motion of `selected` takes along, and their shares: 1 for these, less by the falloff for
/// boundary nodes within the radius, none for pinned nodes. Distances are those of the positions x, along facets from
/// node to node (in 2D along the curve, in 3D by the shortest way over nodes that share a facet). Nodes with weight 0
/// are not listed. Selected interior nodes are in the result, with weight 1.
DraggedSet soft_selection(const BoundaryParts& boundary, const MeshTopology& topology, const Coordinates& x,
                          const IndexSet& selected, const IndexSet& pinned, const SoftSelection& options);

}  // namespace curvewright
