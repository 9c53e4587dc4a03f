#pragma once

#include <string>
#include <vector>

#include "core/base/task.h"
#include "core/boundary/boundary_rules.h"
#include "core/mesh/curved_mesh.h"
#include "core/untangle/node_rules.h"
#include "core/untangle/observer.h"

namespace curvewright {

/// Options of untangle_guaranteed().
struct GuaranteedOptions {
    /// Layers of elements around the damage whose nodes may move; doubled, up to max_layers, where they do not suffice.
    int layers = 2, max_layers = 16;
    /// Reductions of eps per patch before it is given up.
    int max_rounds = 60;
    /// After validity, raise the least scaled Jacobian.
    bool improves = true;
    /// Elements below this scaled Jacobian are worth improving.
    double target = 0.9;
    /// Work that improving may take, in multiplications per evaluation (samples × nodes × dimensions, over all
    /// elements): 4e6 are some 13,000 cubic triangles or 800 cubic tetrahedra. Of more damage than that, the worst
    /// elements are improved first, in a few passes, and the others stay as they are.
    double improve_work = 4e6;
    /// Weight of the shape energy against the least scaled Jacobian: small values raise the scaled Jacobian further, at
    /// the price of evenly stretched slivers.
    double shape_weight = 0.034;
    /// Weight of the elements' scaled Jacobians added up, so that the average rises with the least.
    double mean_weight = 0.006;
    /// Worst mean ratio (see assess_shape; the ideal is the straight-sided input) that improving may leave in a patch;
    /// 0 = no floor. The shape weight is raised where it does not suffice. Where no improvement reaches the floor, the
    /// shape is at least not lowered.
    double shape_floor = 0.0;
    /// What the boundary's nodes may do.
    BoundaryRules boundary;
    /// Nodes that stay in any case.
    NodeRules nodes;
    /// When cancelled, return the best mesh so far, with StopReason::cancelled, instead of throwing Cancelled.
    bool keeps_best_on_cancel = false;
};

/// An element that is not valid at the end.
struct UnmendedElement {
    Index element = 0;
    std::string reason;
    /// Whether it is proved that nothing can make it and its neighbours valid as long as the nodes that may not move
    /// stay (see find_impossibility).
    bool is_proved = false;
    /// min J / max |J|, max |J| that of the element as it was given: if proved, no position of the nodes that may move
    /// has more; else the best that was reached (with max |J| that of the element as it is).
    double bound = 0.0;
    /// Interfaces inside the domain that nodes of the element lie on and may not move along, by the names that boundary
    /// rules have for them: what may be in the way.
    std::vector<std::string> fixed_interfaces;
};

/// What untangle_guaranteed() returns.
struct GuaranteedResult {
    Coordinates coordinates;
    std::vector<UnmendedElement> unmended;    ///< empty: every element is proved valid
    int rounds = 0;                           ///< minimisations, over all patches
    Index sliding_nodes = 0, free_nodes = 0;  ///< of the boundary
    /// Of the boundary from the one that was given, mesh units (see BoundaryShape::largest_distance).
    double largest_boundary_distance = 0.0;
    double valid_seconds = 0.0, improve_seconds = 0.0;
    StopReason reason = StopReason::converged;
};

/// Untangles meshes of any shape but pyramids, of any order: minimises the foldover energy (see DistortionOptions) over
/// all nodes near the damage that may move, with eps falling as the least determinant rises, until the Bézier
/// certificate of every element says valid; where it finds an element invalid between the samples, its worst point
/// becomes a sample. Then raises the least scaled Jacobian by maximising a soft minimum of the elements' evenness
/// together with the energy. The ideal elements are the straight-sided ones on the corners of the mesh.
///
/// The boundary stays bit for bit unless the options say otherwise; sliding nodes stay on the boundary as it was read
/// (see BoundaryShape), so the new boundary interpolates it. Elements that are proved to be impossible are left out of
/// the energy, so that they do not hold up the others.
///
/// A mesh without elements that are tangled or undecided comes back bit for bit: improve() raises the quality of such.
///
/// Never returns a mesh that is worse than the one given: more invalid elements or, with as many, a lower least scaled
/// Jacobian. Same result for any number of threads, with and without observer. Throws Unsupported for other elements,
/// InvalidInput for options out of range and unknown groups, Cancelled (but see keeps_best_on_cancel; if cancelled
/// before the elements were judged, the coordinates are those given and the list of unmended elements is empty).
GuaranteedResult untangle_guaranteed(const CurvedMesh& mesh, const GuaranteedOptions& options = {},
                                     UntangleObserver* observer = nullptr, const TaskContext& context = {});

}  // namespace curvewright
