#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/mesh/curved_mesh.h"

namespace curvewright {

/// Proof that an element cannot become valid.
struct Impossibility {
    double bound = 0.0;  ///< upper bound of min J / max |J| for all positions of the nodes that may move
    std::string reason;
};

/// Looks for a proof that no position of the nodes that may move makes an element (triangle or tetrahedron) valid.
///
/// J at a corner depends on the nodes of the edges that meet there: if none of them may move, J stays what it is.
/// J everywhere is an affine function of the position of any one node, since it changes the Jacobian by a matrix of
/// rank one. If a single node of the element may move, the largest possible least value of J over sample points is a
/// linear program; a feasible point of its dual is a bound, up to rounding, whatever the accuracy of its solution.
/// Positions farther away than 1000 extents of the element are not considered. sign: the orientation's, see
/// JacobianBounds. None if no proof was found.
std::optional<Impossibility> find_impossibility(const CurvedMesh& mesh, Index element, double sign,
                                                const std::function<bool(Index node)>& may_move);

}  // namespace curvewright
