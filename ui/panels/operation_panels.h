#pragma once

#include <QDoubleSpinBox>
#include <QWidget>

#include "ui/jobs/mesh_jobs.h"

class QCheckBox;
class QComboBox;
class QFormLayout;
class QLabel;
class QPushButton;
class QSpinBox;
class QTreeWidget;

namespace curvewright {

/// What the three operation panels share: a button that runs the operation, and a line that tells why it cannot.
class OperationPanel : public QWidget {
    Q_OBJECT

  public:
    OperationPanel(MeshJobs& jobs, const QString& action, const QString& button_name, QWidget* parent);

    /// Starts the operation with the parameters shown, as the button does.
    virtual void run() = 0;
    /// Why it cannot run now; empty if it can.
    virtual QString why_not() const = 0;

  signals:
    /// What it would run, or whether it can, may have changed.
    void refreshed();

  protected:
    /// Adds the button and the line at the end of the panel's layout; follows document and jobs from then on.
    void finish_layout();
    virtual void refresh();
    /// A button that is disabled hands its focus on to whatever comes next; here the panel keeps it and gives it back.
    void set_usable(QPushButton& button, bool is_usable);

    MeshJobs& jobs_;
    QLabel* reason_ = nullptr;
    QPushButton* button_ = nullptr;

  private:
    const QPushButton* had_focus_ = nullptr;
};

/// The loaded deformation and "Apply to boundary".
class DeformPanel : public OperationPanel {
    Q_OBJECT

  public:
    explicit DeformPanel(MeshJobs& jobs, QWidget* parent = nullptr);
    void run() override;
    QString why_not() const override { return jobs_.why_not_deform(); }

  signals:
    void load_requested();

  private:
    void refresh() override;
    void show_deformation();

    QLabel *file_ = nullptr, *applied_ = nullptr;
    QPushButton* load_ = nullptr;
    QTreeWidget* operations_ = nullptr;
};

/// Boundary as the deformation says, interior after it.
class WarpPanel : public OperationPanel {
    Q_OBJECT

  public:
    explicit WarpPanel(MeshJobs& jobs, QWidget* parent = nullptr);
    void run() override;
    QString why_not() const override;
    WarpOptions options() const;
    /// Chooses these weights, at once; as published: all nodes of a patch count alike.
    void choose(Weighting weighting, bool is_as_published);
    /// None: at once.
    std::optional<IncrementOptions> increments() const;

  private:
    void refresh() override;
    void make_fields();
    /// Only what belongs to the choices made.
    void show_fields();

    QComboBox *weights_ = nullptr, *steps_ = nullptr, *neighbours_ = nullptr, *solver_ = nullptr;
    QDoubleSpinBox *distance_power_ = nullptr, *poisson_ratio_ = nullptr, *stiffening_ = nullptr;
    QSpinBox* step_count_ = nullptr;
    QCheckBox *new_weights_ = nullptr, *as_published_ = nullptr;
    QPushButton* more_ = nullptr;
    QFormLayout* form_ = nullptr;
    QLabel *explanation_ = nullptr, *applied_ = nullptr;
};

}  // namespace curvewright
