#pragma once

#include "core/base/task.h"
#include "core/mesh/curved_mesh.h"
#include "core/untangle/node_rules.h"
#include "core/untangle/observer.h"
#include "core/untangle/untangle_result.h"

namespace curvewright {

/// The unit in which (4.1) measures a node's displacement.
enum class DisplacementUnit {
    mesh_unit,    ///< the mesh's unit of length: the thesis to the letter. Depends on it, and so does a good beta.
    edge_length,  ///< the distance of the edge's end points: the result does not depend on the mesh's unit
};

/// How beta of (4.1) is found.
enum class BetaChoice {
    given,      ///< SignedAngleOptions::beta for every node: Alg. 6
    automatic,  ///< for every edge the beta that gives the best certified quality
};

/// Options of untangle_signed_angles().
struct SignedAngleOptions {
    BetaChoice beta_choice = BetaChoice::given;
    /// Weight of the angle term against the displacement term, in (0, 1]; stretched layers want small values (thesis
    /// 4.1). Not read when it is chosen automatically.
    double beta = 0.5;
    /// Automatic choice: always edge_length.
    DisplacementUnit displacement = DisplacementUnit::mesh_unit;
    int max_passes = 50;
    /// |X_k - X_{k-1}|_F / |X_k|_F at which the passes end (thesis, Alg. 6).
    double convergence = 1e-4;
    int simplex_iterations = 400;
    /// Nelder-Mead ends when the spread of the objective and the step, in the unit of displacement, are both below
    /// this.
    double simplex_tolerance = 1e-4;
    /// Size of the starting simplex, as a fraction of the length of the node's edge.
    double simplex_size = 0.05;
    /// Take back a pass that leaves more invalid elements, or a lower certified minimum, than the state before it, and
    /// stop there. Off = the thesis's method to the letter. The automatic choice never makes a pass worse.
    bool reject_worse_pass = false;
    /// Automatic choice: edges whose two triangles have at least this scaled Jacobian are left alone.
    double target = 0.5;
    /// Nodes that stay in any case.
    NodeRules nodes;
    /// When cancelled, return the mesh after the last whole pass (automatic choice: the best such), with
    /// StopReason::cancelled, instead of throwing Cancelled.
    bool keeps_best_on_cancel = false;
};

/// Untangles curved triangles of order 2 and up by signed angles (thesis, chapter 4, Alg. 6): pass 1 moves every
/// high-order node of every interior edge, in mesh order, to the minimum of (4.1) by Nelder-Mead; pass 2 moves the
/// nodes inside the triangles: to the mean of the triangle's high-order edge nodes (order 3, as the thesis has it), or
/// to the blend of its edges (higher orders, beyond the thesis; see FaceRule). Corners and boundary nodes stay bit for
/// bit where they are. Multi-threaded, with the same result for any number of threads: nodes whose triangles have none
/// in common move at the same time, and all others in mesh order.
///
/// With BetaChoice::automatic (beyond the thesis) the passes go over edges instead of nodes: an edge's nodes move one
/// after the other with a beta of a fixed range, the face nodes of its two triangles follow, and the beta that gives
/// the two the highest certified minimum is kept, if that is higher than before and no element became invalid. The mesh
/// never gets worse: neither the number of elements that are not valid nor the certified minimum.
///
/// Throws Unsupported for other elements or orders, InvalidInput for options out of range, Cancelled.
UntangleResult untangle_signed_angles(const CurvedMesh& mesh, const SignedAngleOptions& options = {},
                                      UntangleObserver* observer = nullptr, const TaskContext& context = {});

}  // namespace curvewright
