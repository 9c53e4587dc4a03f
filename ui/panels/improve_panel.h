#pragma once

#include "ui/panels/operation_panels.h"

namespace curvewright {

class BoundaryField;

/// Raising the quality of a valid mesh, and its parameters.
class ImprovePanel : public OperationPanel {
    Q_OBJECT

  public:
    explicit ImprovePanel(MeshJobs& jobs, QWidget* parent = nullptr);
    void run() override;
    QString why_not() const override { return jobs_.why_not_improve(); }
    ImproveOptions options() const;
    /// Shows these options, as far as there are fields for them.
    void show_options(const ImproveOptions& options);

  private:
    QComboBox* goal_ = nullptr;
    QDoubleSpinBox *target_ = nullptr, *farthest_ = nullptr;
    BoundaryField* boundary_ = nullptr;
};

}  // namespace curvewright
