#pragma once

#include "core/base/task.h"
#include "core/untangle/improve.h"
#include "ui/jobs/step.h"

namespace curvewright {

/// Raises the quality of a valid mesh. Throws like the core's function; but returns the best it has when it is asked to
/// stop.
Step improve_step(const CurvedMesh& mesh, const ImproveOptions& options, UntangleObserver* observer,
                  const TaskContext& context);

}  // namespace curvewright
