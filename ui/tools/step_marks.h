#pragma once

#include "ui/jobs/patch_trials.h"
#include "ui/palette/marks.h"
#include "ui/tools/canvas.h"

namespace curvewright {

/// What is drawn of a step of an untangling: the angles as arcs with their values and tangents, the simplex, the way of
/// the node in focus, the worst place of a patch; of a trial its contour lines and where it leads. positions: of the
/// step.
Marks step_marks(const StepExplanation& step, const Coordinates& positions, const Canvas& canvas,
                 const TrialResult* trial, bool with_contours);

}  // namespace curvewright
