#pragma once

#include <string>
#include <vector>

#include "core/base/task.h"
#include "core/mesh/curved_mesh.h"
#include "core/untangle/observer.h"

namespace curvewright {

struct GuaranteedOptions {
    /// Layers of elements around the damage whose nodes may move; doubled, up to max_layers, where they do not suffice.
    int layers = 2, max_layers = 16;
    /// Reductions of eps per patch before it is given up.
    int max_rounds = 60;
    /// After validity, raise the least scaled Jacobian.
    bool improves = true;
    /// Elements below this scaled Jacobian are worth improving.
    double target = 0.9;
    /// Weight of the shape energy against the least scaled Jacobian: small values raise the scaled Jacobian further, at
    /// the price of evenly stretched slivers.
    double shape_weight = 0.036;
    /// Weight of the elements' scaled Jacobians added up, so that the average rises with the least.
    double mean_weight = 0.007;
};

/// An element that is not valid at the end.
struct UnmendedElement {
    Index element = 0;
    std::string reason;
};

struct GuaranteedResult {
    Coordinates coordinates;
    std::vector<UnmendedElement> unmended;  ///< empty: every element is proved valid
    int rounds = 0;                         ///< minimisations, over all patches
    double valid_seconds = 0.0, improve_seconds = 0.0;
    StopReason reason = StopReason::converged;
};

/// Untangles triangles and tetrahedra of any order with their boundary fixed bit for bit: minimises the foldover energy
/// (see DistortionOptions) over all interior nodes near the damage, with eps falling as the least determinant rises,
/// until the Bézier certificate of every element says valid; where it finds an element invalid between the samples, its
/// worst point becomes a sample. Then raises the least scaled Jacobian by maximising a soft minimum of the elements'
/// evenness together with the energy. The ideal elements are the straight-sided ones on the corners of the mesh. Never
/// returns a mesh that is worse than the one given: more invalid elements or, with as many, a lower least scaled
/// Jacobian. Throws Unsupported for other elements, InvalidInput for options out of range, Cancelled.
GuaranteedResult untangle_guaranteed(const CurvedMesh& mesh, const GuaranteedOptions& options = {},
                                     UntangleObserver* observer = nullptr, const TaskContext& context = {});

}  // namespace curvewright
