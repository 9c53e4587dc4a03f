#pragma once

#include "core/mesh/curved_mesh.h"
#include "core/untangle/observer.h"

namespace curvewright {

/// What a method that works in passes has reached.
struct UntangleResult {
    Coordinates coordinates;
    int passes = 0;
    StopReason reason = StopReason::converged;
};

}  // namespace curvewright
