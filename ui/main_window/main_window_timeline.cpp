// The timeline: a recording in place of the document's mesh, until it is closed.

#include <QAction>
#include <QDockWidget>
#include <QFileInfo>
#include <QSplitter>
#include <QStatusBar>
#include <QTabBar>

#include "ui/main_window/main_window.h"
#include "ui/main_window/mesh_view.h"
#include "ui/panels/mesh_panel.h"
#include "ui/panels/pointer_tag.h"
#include "ui/panels/quality_panel.h"
#include "ui/panels/step_panel.h"
#include "ui/panels/timeline_panel.h"
#include "ui/panels/untangle_panel.h"
#include "ui/panels/worst_table.h"
#include "ui/tools/step_tool.h"

namespace curvewright {

void MainWindow::connect_timeline() {
    const auto on = [this](CommandId id, auto function) { connect(actions_[id], &QAction::triggered, this, function); };
    on(CommandId::timeline_show, &MainWindow::record_again);
    on(CommandId::timeline_open, &MainWindow::ask_open_trace);
    on(CommandId::timeline_save, &MainWindow::ask_save_trace);
    on(CommandId::timeline_close, &MainWindow::close_timeline);
    connect(&jobs_, &MeshJobs::recorded, this, &MainWindow::open_timeline);
    connect(&player_, &StepPlayer::frame, this, &MainWindow::show_frame);
    connect(&player_, &StepPlayer::step_changed, this, &MainWindow::show_patch);
    // Frames are drawn with the chords that there are; a step that is looked at gets its own.
    settled_.setSingleShot(true);
    settled_.setInterval(150);
    connect(&settled_, &QTimer::timeout, this, &MainWindow::show_settled);
    connect(&player_, &StepPlayer::step_changed, &settled_, qOverload<>(&QTimer::start));
    connect(&player_, &StepPlayer::failed, this,
            [this](const QString& message) { dialogs_.show_error(this, tr("The recording cannot be read"), message); });
    connect(view_, &MeshView::frame_begun, &player_, [this] { player_.hold_frames(true); });
    connect(view_, &MeshView::frame_drawn, &player_, [this] { player_.hold_frames(false); });
    connect(&player_, &StepPlayer::step_changed, this, &MainWindow::explain_step);
    connect(step_panel_, &StepPanel::step_chosen, &player_, &StepPlayer::go_to);
    connect(step_panel_, &StepPanel::follow_wanted, this, &MainWindow::look_at_patch);
    connect(step_panel_, &StepPanel::trial_changed, this, [this] {
        step_tool_->show_trial(step_panel_->trial(), step_panel_->shows_contours());
        if (player_.is_open()) step_tool_->refresh();
    });
    // Another scale of the bars is no reason to leave the recording, another mesh is.
    connect(quality_panel_, &QualityPanel::refreshed, this, [this] {
        if (!player_.is_open() || !player_.shown().has_quality || !document_.has_mesh()) return;
        const auto& elements = player_.shown().quality.elements;
        if (static_cast<Index>(elements.size()) == document_.state().mesh->topology().element_count())
            quality_panel_->show_live(elements, player_.recording()->start_quality().elements);
    });
    connect(timeline_panel_, &TimelinePanel::close_requested, this, &MainWindow::close_timeline);
    connect(timeline_panel_, &TimelinePanel::told, this,
            [this](const QString& text) { statusBar()->showMessage(text, 8000); });
    timeline_panel_->set_question([this](const QString& title, const QString& label) {
        return dialogs_.ask_text(this, title, label, QString());
    });
    // Another state of the document is what the user wants to see then.
    connect(&document_, &MeshDocument::state_changed, this, &MainWindow::close_timeline);
    connect(&edit_, &EditState::selection_changed, this, [this] {
        if (player_.is_open()) show_patch();
    });
}

/// The last step done that has steps of its own; -1 = none has.
int MainWindow::step_to_record() const {
    for (int step = document_.history()->index() - 1; step >= 0; --step)
        if (jobs_.can_record(step)) return step;
    return -1;
}

void MainWindow::record_again() {
    if (!document_.has_mesh() || is_busy()) return;
    const int step = step_to_record();
    if (step >= 0) jobs_.record_step(step);
}

void MainWindow::ask_open_trace() {
    if (!document_.has_mesh() || is_busy()) return;
    const QString path = dialogs_.open_file(this, tr("Open a trace of an untangling of this mesh"), last_folder(),
                                            tr("Traces (*.jsonl);;All files (*)"));
    if (path.isEmpty()) return;
    if (jobs_.open_trace(path)) remember_folder(path);
}

void MainWindow::ask_save_trace() {
    if (!player_.is_open() || is_busy()) return;
    QString selected;
    QString path = dialogs_.save_file(this, tr("Save the trace"), suggested_path(QStringLiteral("jsonl")),
                                      tr("Traces (*.jsonl)"), selected);
    if (path.isEmpty()) return;
    if (QFileInfo(path).suffix().isEmpty()) path += QStringLiteral(".jsonl");
    if (jobs_.save_trace(player_.recording(), path)) remember_folder(path);
}

void MainWindow::open_timeline(const RecordedRun& run) {
    drag_.cancel();
    close_timeline();
    // The recording holds both as long as somebody shows them.
    MeshState start;
    start.mesh = {run.recording, &run.recording->mesh()};
    start.quality = {run.recording, &run.recording->start_quality()};
    view_->show_state(start);
    if (actions_[CommandId::compare]->isChecked()) before_view_->show_state(start);
    drag_.set_allowed(false);
    timeline_dock_->setWindowTitle(tr("Timeline: %1").arg(run.name));
    timeline_dock_->toggleViewAction()->setEnabled(true);
    timeline_dock_->show();
    timeline_dock_->raise();
    options_of_run_ = run.options.value_or(UntangleOptions{});
    tab_before_timeline_ = tabs_->currentIndex();
    tabs_->setTabVisible(tabs_->count() - 1, true);
    tabs_->setCurrentIndex(tabs_->count() - 1);
    // There is more to be said of a step than of the worst elements.
    sizes_before_timeline_ = right_splitter_->sizes();
    right_splitter_->setSizes({1000, 150});
    for (QTabBar* bar : findChildren<QTabBar*>(QString(), Qt::FindDirectChildrenOnly)) bar->setDrawBase(false);
    player_.open(run.recording);
    statusBar()->clearMessage();
    update_tool();
    update_commands();
}

void MainWindow::close_timeline() {
    if (!player_.is_open()) return;
    player_.close();
    step_tool_->show_step(nullptr, {});
    step_panel_->clear();
    if (tabs_->currentIndex() == tabs_->count() - 1) tabs_->setCurrentIndex(tab_before_timeline_);
    tabs_->setTabVisible(tabs_->count() - 1, false);
    right_splitter_->setSizes(sizes_before_timeline_);
    timeline_dock_->hide();
    timeline_dock_->toggleViewAction()->setEnabled(false);
    bottom_dock_->raise();
    drag_.set_allowed(!jobs_.runner().is_running());
    quality_panel_->show_state();
    mesh_panel_->show_state();
    worst_table_->show_state();
    show_state();
    update_tool();
    if (document_.has_mesh()) view_->setFocus();
}

void MainWindow::show_settled() {
    if (!player_.is_open() || player_.is_seeking()) return;
    // A new state would end the flight to a patch on its way.
    if (view_->is_flying()) {
        settled_.start();
        return;
    }
    const auto& shown = player_.shown();
    MeshState state;
    state.mesh = std::make_shared<const CurvedMesh>(player_.recording()->mesh().with_coordinates(shown.coordinates));
    state.quality = std::make_shared<const QualityReport>(shown.quality);
    view_->show_state(state);
    show_patch();
}

void MainWindow::explain_step() {
    const StepPlayer::Shown& shown = player_.shown();
    if (!shown.explanation) return;  // a later one is on its way
    const std::shared_ptr<const Recording>& recording = player_.recording();
    const Eigen::Matrix3d axes = view_->view_axes();
    step_panel_->show_step(*recording, shown.explanation,
                           std::make_shared<const CurvedMesh>(recording->mesh().with_coordinates(shown.coordinates)),
                           {recording, &recording->mesh()}, shown.quality.summary,
                           recording->start_quality().orientation_sign, options_of_run_, axes.col(0).transpose(),
                           axes.col(1).transpose());
    step_tool_->show_step(shown.explanation, shown.coordinates);
    step_tool_->refresh();
    const auto patch = recording->patch_of(shown.step);
    if (patch && patch != followed_patch_ && step_panel_->follows_patches() && !player_.is_playing()) look_at_patch();
    followed_patch_ = patch;
}

void MainWindow::look_at_patch() {
    if (!player_.is_open() || !player_.shown().patch) return;
    const StepPlayer::Shown& shown = player_.shown();
    const MeshTopology& topology = player_.recording()->mesh().topology();
    Eigen::RowVector3d lower, upper;
    bool is_first = true;
    for (const Index element : shown.patch->elements)
        for (const Index node : topology.element_nodes(element)) {
            const Eigen::RowVector3d at = shown.coordinates.row(node);
            lower = is_first ? at : lower.cwiseMin(at).eval();
            upper = is_first ? at : upper.cwiseMax(at).eval();
            is_first = false;
        }
    if (!is_first) view_->fit_to(0.5 * (lower + upper), 0.55 * (upper - lower).norm());
}

void MainWindow::show_patch() {
    const auto& patch = player_.shown().patch;
    view_->set_highlighted_elements(patch ? patch->elements : edit_.elements());
}

}  // namespace curvewright
