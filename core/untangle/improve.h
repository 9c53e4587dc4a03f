#pragma once

#include <optional>

#include "core/base/task.h"
#include "core/boundary/boundary_rules.h"
#include "core/mesh/curved_mesh.h"
#include "core/untangle/node_rules.h"
#include "core/untangle/observer.h"

namespace curvewright {

/// What improving raises.
enum class ImproveGoal {
    jacobian,  ///< the least scaled Jacobian
    shape,     ///< the worst mean ratio against the straight-sided elements of the mesh as it was given
};
/// "jacobian", "shape".
inline const char* to_string(ImproveGoal goal) {
    return goal == ImproveGoal::jacobian ? "jacobian" : "shape";
}

/// Options of improve().
struct ImproveOptions {
    ImproveGoal goal = ImproveGoal::jacobian;
    /// Elements below this (scaled Jacobian or mean ratio, as the goal says) are improved.
    double target = 0.9;
    /// No node goes farther than this from where it was given, as a fraction of the mesh's size (the diagonal of its
    /// bounding box).
    std::optional<double> max_move;
    /// Work that may be done at once, see GuaranteedOptions::improve_work: of more elements below the target the worst
    /// are improved first, then the next, until all have been.
    double improve_work = 4e6;
    int layers = 2;  ///< of elements around those below the target whose nodes may move
    /// See GuaranteedOptions; not read for the goal `shape`.
    double shape_weight = 0.034, mean_weight = 0.006, shape_floor = 0.0;
    /// What the boundary's nodes may do.
    BoundaryRules boundary;
    /// Nodes that stay in any case.
    NodeRules nodes;
    /// When cancelled, return the best mesh so far, with StopReason::cancelled, instead of throwing Cancelled.
    bool keeps_best_on_cancel = false;
};

/// What improve() returns.
struct ImproveResult {
    Coordinates coordinates;
    Index sliding_nodes = 0, free_nodes = 0;  ///< of the boundary
    /// Of the boundary from the one that was given, mesh units (see BoundaryShape::largest_distance).
    double largest_boundary_distance = 0.0;
    double largest_move = 0.0;  ///< of any node, mesh units
    StopReason reason = StopReason::converged;
};

/// Diagonal of the box of all nodes, mesh units: what max_move is a fraction of.
double mesh_size(const CurvedMesh& mesh);

/// Raises the quality of a valid mesh: the second stage of untangle_guaranteed() by itself, over every element below
/// the target.
///
/// Every element of the result is proved valid, and its least scaled Jacobian (goal `shape`: its worst mean ratio) is
/// not below that of the mesh given; nodes that may not move stay bit for bit, and with max_move no node is farther
/// from where it was than that says. Free nodes are kept in a ball by a change of variables, x = x0 + v / sqrt(1 +
/// |v|^2 / r^2), sliding ones by the same for their steps along the tangents; what is beyond the limit all the same is
/// not taken. Same result for any number of threads, with and without observer.
///
/// Throws InvalidInput for a mesh with elements that are not proved valid (it says how many), for options out of range
/// and for unknown groups and nodes; Unsupported like assess_quality; Cancelled (but see keeps_best_on_cancel).
ImproveResult improve(const CurvedMesh& mesh, const ImproveOptions& options = {}, UntangleObserver* observer = nullptr,
                      const TaskContext& context = {});

}  // namespace curvewright
