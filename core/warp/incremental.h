#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/base/task.h"
#include "core/mesh/curved_mesh.h"
#include "core/quality/quality.h"
#include "core/warp/warp.h"

namespace curvewright {

/// Positions of the boundary on its way, nodes × 3: 0 = where the mesh is, 1 = the end. Only rows of given nodes are
/// read.
using BoundaryPath = std::function<Coordinates(double fraction)>;

/// How a motion is cut into increments.
struct IncrementOptions {
    /// Equal steps; 0 = automatic: as far as goes at once, half of it where elements tangle, and longer again
    /// afterwards.
    int steps = 0;
    /// Compute the weights anew from the mesh of every step. Otherwise those of the first mesh are kept, and the steps
    /// only find out how far one can go.
    bool recomputes_weights = true;
    /// Automatic: the shortest step tried, as a fraction of the whole.
    double smallest_step = 1.0 / 64.0;
    /// When cancelled, return the last valid state instead of throwing Cancelled.
    bool keeps_best_on_cancel = false;
};

/// A state on the way.
struct IncrementStep {
    double fraction = 0.0;  ///< of the motion
    QualitySummary summary;
    bool is_accepted = false;
};

/// Is told of every state tried, accepted or not, with its positions, on the thread that warps.
using IncrementObserver = std::function<void(const IncrementStep& step, const Coordinates& coordinates)>;

/// How a warp in increments went.
struct IncrementReport {
    std::vector<IncrementStep> steps;  ///< in the order tried
    double fraction = 0.0;             ///< reached with every element valid
    int accepted = 0;                  ///< steps that led there
    /// Where it ended if not at 1: the fraction that failed, and the element of least quality there.
    double failed_fraction = 0.0;
    std::optional<Index> failed_element;
    double failed_scaled_jacobian = 0.0;
    bool is_cancelled = false;  ///< ended because the caller asked for it
    bool is_complete() const { return fraction == 1.0; }
};

/// What warp_in_increments() returns.
struct IncrementalResult {
    Coordinates coordinates;  ///< the last valid state
    WarpReport report;        ///< of the last warp; times are sums
    IncrementReport increments;
    QualityReport quality;  ///< of the result
};

/// Moves the boundary along its path step by step, and stops at the last state in which all elements are proved valid.
/// 1, the end, counts as reached only if it is valid too. Throws InvalidInput if the mesh has elements that are not
/// valid to begin with (the worst is named) or for wrong options, Unsupported for elements whose validity cannot be
/// assessed, what warp throws, Cancelled (but see keeps_best_on_cancel).
IncrementalResult warp_in_increments(const CurvedMesh& mesh, const BoundaryPath& path, const WarpOptions& options,
                                     const IncrementOptions& increments, const TaskContext& context = {},
                                     const IncrementObserver& observer = {});

/// "Step 3 of 4 (75 % of the motion) tangled element 17 (scaled Jacobian -0.12); stopped at 50 %."; for a complete
/// motion how many steps it took.
std::string describe(const IncrementReport& report, const MeshTopology& topology);

}  // namespace curvewright
