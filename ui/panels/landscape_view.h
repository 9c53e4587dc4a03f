#pragma once

#include <memory>

#include <QImage>
#include <QWidget>

#include "ui/jobs/patch_trials.h"
#include "ui/panels/theme.h"

namespace curvewright {

/// The objective of a patch around its node in focus, as a map with contour lines: low is dark. A ring is where the
/// node began, a dot where it is, a diamond where the parameters tried would lead.
class LandscapeView : public QWidget {
    Q_OBJECT

  public:
    explicit LandscapeView(const Theme& theme, QWidget* parent = nullptr);

    void clear();
    void show_result(std::shared_ptr<const TrialResult> result, std::shared_ptr<const StepExplanation> step);

    QSize sizeHint() const override { return {240, 180}; }
    QSize minimumSizeHint() const override { return {160, 130}; }

  protected:
    void paintEvent(QPaintEvent* event) override;

  private:
    const Theme& theme_;
    std::shared_ptr<const TrialResult> result_;
    std::shared_ptr<const StepExplanation> step_;
    QImage map_;
};

}  // namespace curvewright
