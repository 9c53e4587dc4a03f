#include "ui/tools/step_tool.h"

namespace curvewright {

void StepTool::show_step(std::shared_ptr<const StepExplanation> step, const Coordinates& positions) {
    // What was tried of the node in focus stays until it is tried anew.
    if (trial_ && (!step || step->focus != trial_->focus)) trial_.reset();
    step_ = std::move(step);
    positions_ = positions;
}

void StepTool::show_trial(std::shared_ptr<const TrialResult> trial, bool with_contours) {
    trial_ = std::move(trial);
    with_contours_ = with_contours;
}

void StepTool::refresh() {
    context_.canvas.show_marks(
        step_ ? step_marks(*step_, positions_, context_.canvas, trial_.get(), with_contours_) : Marks{}, {});
}

QString StepTool::hint() const {
    return context_.canvas.is_flat() ? tr("drag: move · wheel: zoom to the pointer · timeline: space plays and pauses")
                                     : tr("drag: turn · wheel: zoom · timeline: space plays and pauses");
}

}  // namespace curvewright
