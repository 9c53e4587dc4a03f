#pragma once

#include <functional>
#include <optional>

#include "core/base/task.h"
#include "core/warp/incremental.h"
#include "ui/document/mesh_document.h"
#include "ui/jobs/step.h"

namespace curvewright {

class Recorder;

// What the operations make of a mesh, with the words for it. All throw like the core's functions.

/// "By FILE".
QString by_file(const QString& deformation_path);

Step deform_step(const CurvedMesh& mesh, const LoadedDeformation& loaded);
/// At once or in increments; those are told to a recorder. Throws SolverFailure if no increment goes without tangled
/// elements.
Step warp_step(const CurvedMesh& mesh, const LoadedDeformation& loaded, const WarpOptions& options,
               const std::optional<IncrementOptions>& increments, const TaskContext& context,
               Recorder* recorder = nullptr);
/// Its coordinates are the mesh's: what changes is the numbering (flip_orientation).
Step flip_step(const CurvedMesh& mesh);

/// Does an action of a session again. opened: the mesh that the session began with; load: the content of a deformation
/// file. Throws InvalidInput for actions that open or walk through the history.
Step again(const Action& action, const CurvedMesh& mesh, const CurvedMesh& opened,
           const std::function<LoadedDeformation(const std::string& file)>& load, const TaskContext& context);

/// What the history tells about a step: its details and its note.
QString full_details(const Step& step);

}  // namespace curvewright
