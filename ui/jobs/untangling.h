#pragma once

#include "core/base/task.h"
#include "core/session/action.h"
#include "ui/jobs/step.h"

namespace curvewright {

/// Why the method does not do this mesh, as a sentence; empty if it does.
QString why_not_untangle(const MeshTopology& topology, UntangleMethod method);

/// Untangles by the method that the options belong to. Throws like the core's functions; but the guaranteed method
/// returns the best it has when it is asked to stop.
Step untangle(const CurvedMesh& mesh, const UntangleOptions& options, UntangleObserver* observer,
              const TaskContext& context);

}  // namespace curvewright
