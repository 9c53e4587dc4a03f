#pragma once

#include <memory>

#include "ui/tools/look_tool.h"
#include "ui/tools/step_marks.h"

namespace curvewright {

/// Leaves the mouse to the camera; draws what explains the step of a timeline.
class StepTool : public LookTool {
    Q_OBJECT

  public:
    using LookTool::LookTool;

    /// positions: of the step, nodes × 3. A null step: nothing is drawn.
    void show_step(std::shared_ptr<const StepExplanation> step, const Coordinates& positions);
    /// trial: of the step shown, or null.
    void show_trial(std::shared_ptr<const TrialResult> trial, bool with_contours);

    void refresh() override;
    QString hint() const override;

  private:
    std::shared_ptr<const StepExplanation> step_;
    Coordinates positions_;
    std::shared_ptr<const TrialResult> trial_;
    bool with_contours_ = false;
};

}  // namespace curvewright
