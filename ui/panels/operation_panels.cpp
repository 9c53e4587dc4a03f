#include "ui/panels/operation_panels.h"

#include <cmath>

#include <QCheckBox>
#include <QComboBox>
#include <QDir>
#include <QFileInfo>
#include <QFormLayout>
#include <QHBoxLayout>
#include <QHeaderView>
#include <QLabel>
#include <QPushButton>
#include <QSpinBox>
#include <QTreeWidget>
#include <QVBoxLayout>

#include "ui/document/deformation_text.h"
#include "ui/panels/widgets.h"

namespace curvewright {
namespace {

QVBoxLayout* make_layout(QWidget* panel) {
    auto* layout = new QVBoxLayout(panel);
    layout->setContentsMargins(12, 12, 12, 8);
    layout->setSpacing(8);
    return layout;
}

QFormLayout* make_form() {
    auto* form = new QFormLayout;
    form->setHorizontalSpacing(12);
    form->setVerticalSpacing(8);
    form->setFieldGrowthPolicy(QFormLayout::AllNonFixedFieldsGrow);
    form->setLabelAlignment(Qt::AlignLeft | Qt::AlignVCenter);
    return form;
}

QVBoxLayout* layout_of(QWidget* panel) {
    return static_cast<QVBoxLayout*>(panel->layout());
}

}  // namespace

OperationPanel::OperationPanel(MeshJobs& jobs, const QString& action, const QString& button_name, QWidget* parent)
    : QWidget(parent), jobs_(jobs) {
    reason_ = make_paragraph(QString(), "muted");
    reason_->setObjectName(button_name + QStringLiteral("_reason"));
    button_ = make_primary_button(action, button_name);
    connect(button_, &QPushButton::clicked, this, [this] { run(); });
}

void OperationPanel::finish_layout() {
    layout_of(this)->addWidget(button_);
    layout_of(this)->addWidget(reason_);
    layout_of(this)->addStretch();
    connect(&jobs_.document(), &MeshDocument::state_changed, this, [this] { refresh(); });
    connect(&jobs_.document(), &MeshDocument::deformation_changed, this, [this] { refresh(); });
    connect(&jobs_.runner(), &JobRunner::running_changed, this, [this] { refresh(); });
    refresh();
}

void OperationPanel::refresh() {
    const QString reason = why_not();
    button_->setEnabled(reason.isEmpty() && !jobs_.runner().is_running());
    reason_->setText(reason);
    reason_->setVisible(!reason.isEmpty());
}

DeformPanel::DeformPanel(MeshJobs& jobs, QWidget* parent)
    : OperationPanel(jobs, tr("Apply to boundary"), QStringLiteral("deform_button"), parent) {
    file_ = make_label(QString(), "title");
    file_->setObjectName(QStringLiteral("deformation_name"));
    file_->setSizePolicy(QSizePolicy::Ignored, QSizePolicy::Preferred);
    load_ = new QPushButton(tr("Load…"));
    load_->setObjectName(QStringLiteral("load_deformation_button"));
    load_->setToolTip(tr("A deformation (.json), a table of node positions (.csv) or a mesh with the final positions"));
    operations_ = new QTreeWidget;
    operations_->setObjectName(QStringLiteral("operations"));
    operations_->setHeaderLabels({tr("Group"), tr("What happens to it")});
    operations_->setRootIsDecorated(false);
    operations_->setSelectionMode(QAbstractItemView::NoSelection);
    operations_->setFocusPolicy(Qt::NoFocus);
    operations_->setHorizontalScrollMode(QAbstractItemView::ScrollPerPixel);
    operations_->header()->setSectionResizeMode(QHeaderView::ResizeToContents);
    operations_->setMinimumHeight(76);
    operations_->setMaximumHeight(112);
    applied_ = make_paragraph(tr("Applied already in this state: once more would move the boundary again."), "");
    set_tone(applied_, "warning");

    auto* head = new QHBoxLayout;
    head->setSpacing(8);
    head->addWidget(file_, 1);
    head->addWidget(load_);
    QVBoxLayout* layout = make_layout(this);
    layout->addLayout(head);
    layout->addWidget(operations_);
    layout->addWidget(
        make_paragraph(tr("Moves the boundary nodes only; the interior stays, so elements may tangle."), "muted"));
    layout->addWidget(applied_);
    finish_layout();

    connect(load_, &QPushButton::clicked, this, &DeformPanel::load_requested);
    connect(&jobs.document(), &MeshDocument::deformation_changed, this, &DeformPanel::show_deformation);
    show_deformation();
}

void DeformPanel::run() {
    jobs_.deform();
}

void DeformPanel::refresh() {
    OperationPanel::refresh();
    load_->setEnabled(jobs_.document().has_mesh() && !jobs_.runner().is_running());
    applied_->setVisible(jobs_.document().is_deformation_applied());
}

void DeformPanel::show_deformation() {
    const auto& loaded = jobs_.document().deformation();
    file_->setText(loaded ? QFileInfo(loaded->file_path).fileName() : tr("No deformation"));
    file_->setToolTip(loaded ? QDir::toNativeSeparators(loaded->file_path) : QString());
    operations_->clear();
    operations_->setVisible(loaded.has_value());
    if (!loaded) return;
    for (const DeformationLine& line : describe(*loaded->deformation)) {
        auto* item = new QTreeWidgetItem(operations_, {line.group.isEmpty() ? tr("by tag") : line.group, line.action});
        item->setToolTip(0, line.group);
        item->setToolTip(1, line.action);
    }
}

WarpPanel::WarpPanel(MeshJobs& jobs, QWidget* parent)
    : OperationPanel(jobs, tr("Warp"), QStringLiteral("warp_button"), parent) {
    weights_ = new QComboBox;
    weights_->setObjectName(QStringLiteral("weights"));
    weights_->addItem(tr("Convex (all positive)"), int(Weighting::convex));
    weights_->addItem(tr("Affine (least norm)"), int(Weighting::affine));
    weights_->setToolTip(tr("How an interior node is written as a combination of its neighbours"));
    distance_power_ = new QDoubleSpinBox;
    distance_power_->setObjectName(QStringLiteral("distance_power"));
    distance_power_->setRange(0.0, 8.0);
    distance_power_->setSingleStep(0.5);
    distance_power_->setDecimals(1);
    distance_power_->setLocale(QLocale::c());
    distance_power_->setValue(WarpOptions().distance_power);
    distance_power_->setToolTip(
        tr("How much more near neighbours count than far ones.\n"
           "0: all neighbours alike, as in the thesis.\n"
           "2: the default; keeps small elements near the moving boundary in shape."));
    solver_ = new QComboBox;
    solver_->setObjectName(QStringLiteral("solver"));
    solver_->addItem(tr("Automatic"), int(SolverChoice::automatic));
    solver_->addItem(tr("Direct"), int(SolverChoice::direct));
    solver_->addItem(tr("Iterative"), int(SolverChoice::iterative));
    solver_->setToolTip(tr("How the linear system is solved; automatic falls back from iterative to direct"));

    auto* form = make_form();
    form->addRow(tr("Weights"), weights_);
    form->addRow(tr("Distance power"), distance_power_);
    form->addRow(tr("Solver"), solver_);
    QVBoxLayout* layout = make_layout(this);
    layout->addLayout(form);
    layout->addWidget(make_paragraph(
        tr("Moves the boundary as the deformation says, from where it is now; the interior follows."), "muted"));
    applied_ = make_paragraph(
        tr("The deformation is applied already in this state. Undo that first, or it counts twice."), "");
    set_tone(applied_, "warning");
    layout->addWidget(applied_);
    finish_layout();
}

void WarpPanel::run() {
    jobs_.warp(options());
}

void WarpPanel::refresh() {
    OperationPanel::refresh();
    applied_->setVisible(jobs_.document().is_deformation_applied());
}

WarpOptions WarpPanel::options() const {
    WarpOptions options;
    options.weighting = static_cast<Weighting>(weights_->currentData().toInt());
    options.distance_power = distance_power_->value();
    options.solver = static_cast<SolverChoice>(solver_->currentData().toInt());
    return options;
}

void LogSpinBox::stepBy(int steps) {
    double next = value();
    for (; steps != 0; steps += steps > 0 ? -1 : 1) {
        // Down from a power of ten, the leading digit is that of the decade below.
        const double decade = std::pow(10.0, std::floor(std::log10(next) + 1e-9));
        const bool is_power = std::abs(next / decade - 1.0) < 1e-9;
        const double step = steps < 0 && is_power ? decade / 10.0 : decade;
        next = std::round(next / step + (steps > 0 ? 1 : -1)) * step;
    }
    setValue(next);
}

QString LogSpinBox::textFromValue(double value) const {
    return QString::number(value, 'g', 4);
}

UntanglePanel::UntanglePanel(MeshJobs& jobs, QWidget* parent)
    : OperationPanel(jobs, tr("Untangle"), QStringLiteral("untangle_button"), parent) {
    const SignedAngleOptions defaults;
    method_ = new QComboBox;
    method_->setObjectName(QStringLiteral("method"));
    method_->addItem(tr("Signed angles"));
    method_->setToolTip(tr("For 2D meshes of triangles of order 2 and 3"));
    beta_ = new LogSpinBox;
    beta_->setObjectName(QStringLiteral("beta"));
    beta_->setDecimals(7);
    beta_->setRange(1e-5, 1.0);
    beta_->setLocale(QLocale::c());
    beta_->setValue(defaults.beta);
    beta_->setToolTip(
        tr("Weight of the angles against the displacement. It depends on the unit of length: thin, "
           "stretched layers want small values."));
    passes_ = new QSpinBox;
    passes_->setObjectName(QStringLiteral("max_passes"));
    passes_->setRange(1, 1000);
    passes_->setValue(defaults.max_passes);
    passes_->setToolTip(tr("Every pass visits all interior edges once"));
    reject_ = new QCheckBox(tr("Stop when a pass makes things worse"));
    reject_->setObjectName(QStringLiteral("reject_worse_pass"));
    reject_->setChecked(true);
    reject_->setToolTip(tr("Takes back a pass that leaves more tangled elements or a lower minimum"));

    auto* form = make_form();
    form->addRow(tr("Method"), method_);
    form->addRow(tr("Weight β"), beta_);
    form->addRow(tr("Passes at most"), passes_);
    QVBoxLayout* layout = make_layout(this);
    layout->addLayout(form);
    layout->addWidget(reject_);
    finish_layout();
}

void UntanglePanel::run() {
    jobs_.untangle(options());
}

SignedAngleOptions UntanglePanel::options() const {
    SignedAngleOptions options;
    options.beta = beta_->value();
    options.max_passes = passes_->value();
    options.reject_worse_pass = reject_->isChecked();
    return options;
}

void UntanglePanel::set_beta(double beta) {
    beta_->setValue(beta);
}

}  // namespace curvewright
