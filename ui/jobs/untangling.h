#pragma once

#include <variant>

#include "core/base/task.h"
#include "core/untangle/guaranteed.h"
#include "core/untangle/signed_angles.h"
#include "core/untangle/unsigned_angles.h"
#include "ui/jobs/step.h"

namespace curvewright {

/// In the order of UntangleOptions' alternatives.
enum class UntangleMethod { guaranteed, signed_angles, unsigned_angles };
using UntangleOptions = std::variant<GuaranteedOptions, SignedAngleOptions, UnsignedAngleOptions>;

inline UntangleMethod method_of(const UntangleOptions& options) {
    return static_cast<UntangleMethod>(options.index());
}

/// Why the method does not do this mesh, as a sentence; empty if it does.
QString why_not_untangle(const MeshTopology& topology, UntangleMethod method);

/// Untangles by the method that the options belong to. Throws like the core's functions; but the guaranteed method
/// returns the best it has when it is asked to stop.
Step untangle(const CurvedMesh& mesh, const UntangleOptions& options, const TaskContext& context);

}  // namespace curvewright
