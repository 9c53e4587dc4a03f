#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/mesh/curved_mesh.h"
#include "core/mesh/node_elements.h"
#include "core/quality/orientation_signs.h"

namespace curvewright {

/// Why an element cannot become valid.
struct Impossibility {
    /// Upper bound of min J / max |J| (max |J| as it is) for all positions of the nodes that may move, for the element
    /// or, where the reason speaks of neighbours, for the least of them.
    double bound = 0.0;
    std::string reason;
    /// Whether this is a proof for every position of the nodes that may move, up to rounding: what is claimed to be
    /// zero or below is so, or is within the rounding error of the coordinates' own differences, so that no certificate
    /// could say valid. Otherwise it is no more than very likely: the margin is thin, or nodes may be farther away than
    /// was looked at.
    bool is_proved = true;
};

/// Looks for a proof that no position of the nodes that may move makes an element (triangle or tetrahedron) valid while
/// those next to it are valid.
///
/// J at a corner depends on the nodes of the edges that meet there: if none of them may move, J stays what it is.
/// If the other edges there have no movable nodes, J at the corner is a linear form of the tangent that the edge has
/// there; the elements around the edge may ask for tangents that do not exist.
/// J is an affine function of the position of any one node everywhere, since it changes the Jacobian by a matrix of
/// rank one. So the largest possible least value of J, over the points where it depends on one movable node alone
/// (corners, or samples of a whole element whose only movable node it is), is a linear program; a feasible point of its
/// dual gives a bound, up to rounding, whatever the accuracy of its solution. The program is set up for each movable
/// node, for the element alone and then with the others around the node; if it is only with the element that these have
/// no solution, the element is what cannot be had. Positions farther away than 1000 extents of the element are not
/// considered; the result is a proof if the mesh has no place that far away. (If all of the boundary stays, every node
/// of a valid mesh is in the hull of the boundary, since a point outside has winding number 0 and so no preimage.)
///
/// signs: the orientation's. is_given_up: elements that need not be valid. None if no proof was
/// found.
std::optional<Impossibility> find_impossibility(const CurvedMesh& mesh, Index element,
                                                const OrientationSigns& signs,
                                                const NodeElements& node_elements,
                                                const std::function<bool(Index node)>& may_move,
                                                const std::function<bool(Index element)>& is_given_up = {});

}  // namespace curvewright
