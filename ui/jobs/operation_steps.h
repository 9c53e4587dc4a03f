#pragma once

#include <functional>
#include <optional>

#include "core/base/task.h"
#include "core/quality/quality.h"
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
/// Likewise, of a mesh that reorient() has renumbered.
Step reorient_step(const Reorientation& reorientation);
/// The mesh as an action numbers it: renumbered by FlipAction and ReorientAction, else as it is.
CurvedMesh numbered_by(const Action& action, const CurvedMesh& mesh);
/// Whether an action renumbers, so that its result is judged by itself.
bool is_renumbering(const Action& action);

/// Does an action of a session again. opened: the mesh that the session began with; load: the content of a deformation
/// file. Throws InvalidInput for actions that open or walk through the history.
Step again(const Action& action, const CurvedMesh& mesh, const CurvedMesh& opened,
           const std::function<LoadedDeformation(const std::string& file)>& load, const TaskContext& context);

/// What the history tells about a step: its details and its note.
QString full_details(const Step& step);

}  // namespace curvewright
