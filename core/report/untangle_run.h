#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/base/task.h"
#include "core/mesh/curved_mesh.h"
#include "core/session/action.h"
#include "core/untangle/guaranteed.h"
#include "core/untangle/observer.h"

namespace curvewright {

/// What any of the untangling methods leaves behind.
struct UntangleRun {
    Coordinates coordinates;
    StopReason reason = StopReason::converged;
    int passes = 0;  ///< not of the guaranteed method
    // Of the guaranteed method only.
    int rounds = 0;
    std::vector<UnmendedElement> unmended;
    Index sliding_nodes = 0, free_nodes = 0;
    double largest_boundary_distance = 0.0;
    /// Seconds: "untangle" and, of the guaranteed method, "improve".
    std::vector<std::pair<std::string, double>> timings;
};

/// Untangles by the method that the options belong to. Throws what that method throws.
UntangleRun run_untangling(const CurvedMesh& mesh, const UntangleOptions& options, UntangleObserver* observer = nullptr,
                           const TaskContext& context = {});

}  // namespace curvewright
