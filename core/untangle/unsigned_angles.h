#pragma once

#include <vector>

#include "core/base/task.h"
#include "core/mesh/curved_mesh.h"
#include "core/untangle/node_rules.h"
#include "core/untangle/untangle_result.h"

namespace curvewright {

/// How the gradient of the sum of angles is computed.
enum class AngleGradient {
    exact,
    central_differences,  ///< of sixth order: the thesis's choice, some ten times slower
};

/// Options of untangle_unsigned_angles(); as they are, the method is better than the thesis's, see literal().
struct UnsignedAngleOptions {
    AngleGradient gradient = AngleGradient::exact;
    int max_passes = 20;
    /// The first quasi-Newton step of an edge is a first step × (edge length)² × gradient. The sum of the angles is
    /// flat around its minimisers, so the first step decides which of them is reached; of several, the one with the
    /// best certified quality is taken.
    std::vector<double> first_steps = {0.0025, 0.005, 0.01, 0.02, 0.04, 0.08};
    /// Begin from the straight edge as well as from the nodes as they are.
    bool tries_straight_edge = true;
    /// Put the face nodes of the edge's triangles where its curved edges ask for.
    bool moves_face_nodes = true;
    /// Keep a move only where it raises the least certified scaled Jacobian of the edge's triangles; where no such move
    /// is left but tangled elements are, make a pass that takes the moves as they come. The best state that was seen is
    /// returned, so that the result is never worse than the mesh given.
    bool is_guarded = true;
    /// Edges with a triangle below this scaled Jacobian are moved; 0 = only those of elements that are not valid.
    double target = 0.5;
    /// Step of the central differences, as a fraction of the edge's length.
    double difference_step = 1e-6;
    /// |gradient| × edge length at which an edge is done.
    double gradient_tolerance = 1e-4;
    int max_iterations = 100;
    /// Nodes that stay in any case. An edge with such a node stays as it is.
    NodeRules nodes;
    /// When cancelled, return the best mesh that a pass has left, with StopReason::cancelled, instead of throwing
    /// Cancelled.
    bool keeps_best_on_cancel = false;

    /// The thesis's method to the letter. It leaves the scale of its first step open; 0.01 is within what its examples
    /// want.
    static UnsignedAngleOptions literal();
};

/// Untangles curved triangles of order 2 and up by unsigned angles (thesis, chapter 3, Alg. 4 and 5): for every
/// interior edge with a triangle that is not valid, in mesh order, the sum of the four unsigned angles at its ends is
/// minimised by BFGS over the edge's high-order nodes; passes until every element is valid, nothing moves any more, or
/// max_passes. Corners, face nodes and boundary nodes stay bit for bit where they are. The sum is constant as long as
/// the edge's tangents lie between those of its neighbours, so valid patches stay as they are; where the tangling is
/// deep, it can be flat as well, and the method then ends with tangled elements. Throws Unsupported for other elements,
/// InvalidInput for options out of range, Cancelled.
UntangleResult untangle_unsigned_angles(const CurvedMesh& mesh, const UnsignedAngleOptions& options = {},
                                        UntangleObserver* observer = nullptr, const TaskContext& context = {});

}  // namespace curvewright
