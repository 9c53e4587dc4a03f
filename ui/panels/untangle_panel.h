#pragma once

#include "ui/panels/operation_panels.h"

namespace curvewright {

class BoundaryField;
class LogSpinBox;

/// The methods of untangling and their parameters.
class UntanglePanel : public OperationPanel {
    Q_OBJECT

  public:
    explicit UntanglePanel(MeshJobs& jobs, QWidget* parent = nullptr);
    void run() override;
    QString why_not() const override;
    /// Of the method chosen.
    UntangleOptions options() const;
    /// Chooses signed angles with this weight.
    void set_beta(double beta);
    /// Chooses unsigned angles, to the letter or with several starts.
    void choose_unsigned_angles(bool is_literal);
    void choose_guaranteed();
    /// Shows the guaranteed method with these options, as far as there are fields for them.
    void show_options(const GuaranteedOptions& options);

  private:
    void refresh() override;
    void make_fields();
    /// Only what belongs to the method chosen.
    void show_fields();

    QPushButton* recorded_ = nullptr;
    QComboBox* method_ = nullptr;
    BoundaryField* boundary_ = nullptr;
    QCheckBox *chooses_beta_ = nullptr, *improves_ = nullptr, *reject_ = nullptr, *literal_ = nullptr;
    QDoubleSpinBox* target_ = nullptr;
    LogSpinBox* beta_ = nullptr;
    QSpinBox* passes_ = nullptr;
    QFormLayout* form_ = nullptr;
};

}  // namespace curvewright
