#pragma once

#include <memory>

#include <QWidget>

#include "core/timeline/explanation.h"
#include "ui/jobs/patch_trials.h"
#include "ui/panels/theme.h"

class QCheckBox;
class QLabel;
class QSlider;

namespace curvewright {

class ConvergencePlot;
class LandscapeView;
class LogSpinBox;

/// What a step of an untangling does, in words, numbers and pictures; and what another parameter would do in its place.
class StepPanel : public QWidget {
    Q_OBJECT

  public:
    explicit StepPanel(const Theme& theme, QWidget* parent = nullptr);
    ~StepPanel() override;

    /// What is shown. mesh, quality: in the step; start: of the untangling. across, up: of the view, for landscapes of
    /// solids.
    void show_step(const Recording& recording, std::shared_ptr<const StepExplanation> step,
                   std::shared_ptr<const CurvedMesh> mesh, std::shared_ptr<const CurvedMesh> start,
                   const QualitySummary& quality, const OrientationSigns& orientation_sign,
                   const UntangleOptions& options, const Eigen::RowVector3d& across, const Eigen::RowVector3d& up);
    void clear();

    /// Null if there is none (yet).
    const std::shared_ptr<const TrialResult>& trial() const { return trial_; }
    bool shows_contours() const;
    /// Whether the view is to go to every patch that comes into focus.
    bool follows_patches() const;

  signals:
    void step_chosen(StepNumber step);
    /// trial() or shows_contours() has changed.
    void trial_changed();
    /// follows_patches() has become true.
    void follow_wanted();

  private:
    struct Parameter;

    void ask();
    void show_parameter(const Recording& recording, const UntangleOptions& options);
    void describe(const Recording& recording);
    double parameter_value() const;

    QLabel *title_ = nullptr, *text_ = nullptr, *numbers_ = nullptr, *parameter_name_ = nullptr, *outcome_ = nullptr;
    QWidget* trial_box_ = nullptr;
    ConvergencePlot* plot_ = nullptr;
    LandscapeView* landscape_ = nullptr;
    QSlider* slider_ = nullptr;
    LogSpinBox* number_ = nullptr;
    QCheckBox *contours_ = nullptr, *follows_ = nullptr;
    PatchTrials trials_;
    TrialRequest request_;
    QualitySummary quality_;
    std::shared_ptr<const TrialResult> trial_;
    std::optional<UntangleMethod> shown_method_;
    std::optional<std::size_t> shown_patch_;
};

}  // namespace curvewright
