#pragma once

#include "core/base/task.h"
#include "core/timeline/recording.h"

namespace curvewright {

/// Tells an observer all events of a recorded untangling, Started with the mesh and PassEnded with its coordinates as
/// the method did. Throws Unsupported for a warp in increments, InvalidInput if the temporary file cannot be read,
/// Cancelled.
void replay(const std::shared_ptr<const Recording>& recording, UntangleObserver& observer,
            const TaskContext& context = {});

}  // namespace curvewright
