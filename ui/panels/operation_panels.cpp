#include "ui/panels/operation_panels.h"

#include <algorithm>
#include <cmath>
#include <vector>

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
#include "ui/panels/form_fields.h"
#include "ui/panels/widgets.h"

namespace curvewright {
namespace {

enum class StepChoice { at_once, automatic, number };

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
    set_usable(*button_, reason.isEmpty() && !jobs_.runner().is_running());
    reason_->setText(reason);
    reason_->setVisible(!reason.isEmpty());
    emit refreshed();
}

void OperationPanel::set_usable(QPushButton& button, bool is_usable) {
    if (!is_usable && button.hasFocus()) {
        had_focus_ = &button;
        setFocus();
    }
    button.setEnabled(is_usable);
    if (is_usable && had_focus_ == &button && hasFocus()) button.setFocus();
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
    QVBoxLayout* layout = make_panel_layout(this);
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
    make_fields();
    QVBoxLayout* layout = make_panel_layout(this);
    layout->addLayout(form_);
    explanation_ = make_paragraph(
        tr("Moves the boundary as the deformation says, from where it is now; the interior follows."), "muted");
    layout->addWidget(explanation_);
    applied_ = make_paragraph(
        tr("The deformation is applied already in this state. Undo that first, or it counts twice."), "");
    set_tone(applied_, "warning");
    layout->addWidget(applied_);
    finish_layout();
}

void WarpPanel::make_fields() {
    const WarpOptions defaults;
    weights_ =
        make_choice("weights", tr("How the interior follows the boundary."),
                    {{tr("Convex weights"), int(Weighting::convex),
                      tr("all positive: an interior node stays between its neighbours. A good first choice.")},
                     {tr("Affine weights"), int(Weighting::affine),
                      tr("of least norm, some may be negative. The quickest, and they exist for every node.")},
                     {tr("Elastic body"), int(Weighting::elastic),
                      tr("the mesh is deformed like rubber. Best for large motions and bent shells; takes longer.")}});
    distance_power_ = make_number("distance_power", 0.0, 8.0, 0.5, 1, defaults.distance_power);
    distance_power_->setToolTip(tr("How much more near neighbours count than far ones.\n"
                                   "0: the distance does not count.\n"
                                   "%1: the default; keeps small elements near the moving boundary in shape.")
                                    .arg(defaults.distance_power));
    as_published_ = new QCheckBox(tr("As published"));
    as_published_->setObjectName(QStringLiteral("weights_as_published"));
    as_published_->setToolTip(
        tr("All nodes of its elements count alike for an interior node.\n"
           "Otherwise near ones count more, and those that it meets in several elements; that keeps small elements in "
           "shape."));
    steps_ = make_choice("steps", tr("Whether the boundary moves at once or in steps."),
                         {{tr("At once"), int(StepChoice::at_once), tr("the quickest.")},
                          {tr("Automatic"), int(StepChoice::automatic),
                           tr("as far as goes at once, less where elements tangle. Stops at the last state without "
                              "tangled elements.")},
                          {tr("Number"), int(StepChoice::number),
                           tr("so many equal steps. Stops before the step that tangles elements.")}});
    step_count_ = new QSpinBox;
    step_count_->setObjectName(QStringLiteral("step_count"));
    step_count_->setRange(1, 1000);
    step_count_->setValue(4);
    step_count_->setToolTip(tr("More steps go farther before elements tangle, and take longer"));
    new_weights_ = new QCheckBox(tr("New weights at every step"));
    new_weights_->setObjectName(QStringLiteral("new_weights"));
    new_weights_->setChecked(true);
    new_weights_->setToolTip(
        tr("Every step starts from the mesh that the last one left: goes further, takes longer.\n"
           "Otherwise the steps only find out how far one can go."));
    more_ = make_fold_button(tr("More options"), QStringLiteral("more_warp_options"));
    neighbours_ = make_choice("neighbours", tr("Which nodes an interior node is tied to."),
                              {{tr("All"), int(NeighbourKind::all), tr("all other nodes of its elements.")},
                               {tr("High-order"), int(NeighbourKind::high_order),
                                tr("those that are no vertices, for small motions. Needs order 2.")},
                               {tr("One edge away"), int(NeighbourKind::edge_connected),
                                tr("the fewest, so the quickest; more nodes lie outside their hull.")}});
    poisson_ratio_ = make_number("poisson_ratio", -0.99, 0.49, 0.05, 2, defaults.poisson_ratio);
    poisson_ratio_->setToolTip(
        tr("How much the body gives way sideways when it is pulled.\n"
           "Near 0.5 it keeps its volume, at 0 it keeps its width."));
    stiffening_ = make_number("stiffening", 0.0, 4.0, 0.5, 1, defaults.stiffening);
    stiffening_->setToolTip(
        tr("How much stiffer small elements are than large ones.\n"
           "0: all alike. 1: in inverse proportion to their volume; they keep their shape."));
    solver_ = make_choice("solver", tr("How the linear system is solved."),
                          {{tr("Automatic"), int(SolverChoice::automatic), tr("the program chooses by the size.")},
                           {tr("Direct"), int(SolverChoice::direct), tr("a factorisation; needs more memory.")},
                           {tr("Iterative"), int(SolverChoice::iterative), tr("for large meshes.")}});

    form_ = make_form();
    form_->addRow(tr("Weights"), weights_);
    form_->addRow(as_published_);
    form_->addRow(tr("Distance power"), distance_power_);
    form_->addRow(tr("Steps"), steps_);
    form_->addRow(tr("How many"), step_count_);
    form_->addRow(new_weights_);
    form_->addRow(more_);
    form_->addRow(tr("Neighbours"), neighbours_);
    form_->addRow(tr("Poisson’s ratio"), poisson_ratio_);
    form_->addRow(tr("Stiffening"), stiffening_);
    form_->addRow(tr("Solver"), solver_);
    align_labels(form_);
    const auto follow = [this] {
        show_fields();
        refresh();
    };
    connect(weights_, &QComboBox::currentIndexChanged, this, follow);
    connect(steps_, &QComboBox::currentIndexChanged, this, follow);
    connect(as_published_, &QCheckBox::toggled, this, follow);
    connect(more_, &QPushButton::toggled, this, follow);
    show_fields();
}

void WarpPanel::show_fields() {
    const bool is_elastic = chosen<Weighting>(weights_) == Weighting::elastic, is_unfolded = more_->isChecked();
    const auto steps = chosen<StepChoice>(steps_);
    form_->setRowVisible(as_published_, !is_elastic);
    form_->setRowVisible(distance_power_, !is_elastic && !as_published_->isChecked());
    form_->setRowVisible(step_count_, steps == StepChoice::number);
    form_->setRowVisible(new_weights_, steps != StepChoice::at_once);
    form_->setRowVisible(neighbours_, is_unfolded && !is_elastic);
    form_->setRowVisible(poisson_ratio_, is_unfolded && is_elastic);
    form_->setRowVisible(stiffening_, is_unfolded && is_elastic);
    form_->setRowVisible(solver_, is_unfolded);
}

void WarpPanel::run() {
    jobs_.warp(options(), increments());
}

QString WarpPanel::why_not() const {
    const QString reason = jobs_.why_not_warp();
    if (!reason.isEmpty() || !increments()) return reason;
    const MeshState& state = jobs_.document().state();
    if (!state.quality) return tr("Steps stop where elements tangle. %1 Warp at once.").arg(state.quality_note);
    if (state.quality->summary.invalid + state.quality->summary.undecided > 0)
        return tr("Steps start from a mesh without tangled elements: untangle it first, or warp at once.");
    return {};
}

void WarpPanel::refresh() {
    OperationPanel::refresh();
    const bool is_applied = jobs_.document().is_deformation_applied();
    applied_->setVisible(is_applied);
    explanation_->setVisible(!is_applied && !more_->isChecked());
}

WarpOptions WarpPanel::options() const {
    WarpOptions options;
    options.weighting = chosen<Weighting>(weights_);
    options.distance_power = distance_power_->value();
    if (as_published_->isChecked()) options.distance_power = options.sharing_power = 0.0;
    options.neighbours = chosen<NeighbourKind>(neighbours_);
    options.poisson_ratio = poisson_ratio_->value();
    options.stiffening = stiffening_->value();
    options.solver = chosen<SolverChoice>(solver_);
    return options;
}

void WarpPanel::choose(Weighting weighting, bool is_as_published) {
    weights_->setCurrentIndex(weights_->findData(int(weighting)));
    as_published_->setChecked(is_as_published);
    steps_->setCurrentIndex(steps_->findData(int(StepChoice::at_once)));
}

std::optional<IncrementOptions> WarpPanel::increments() const {
    const auto choice = chosen<StepChoice>(steps_);
    if (choice == StepChoice::at_once) return std::nullopt;
    IncrementOptions increments;
    increments.steps = choice == StepChoice::automatic ? 0 : step_count_->value();
    increments.recomputes_weights = new_weights_->isChecked();
    return increments;
}

}  // namespace curvewright
