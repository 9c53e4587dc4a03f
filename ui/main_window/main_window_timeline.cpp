// The timeline: a recording in place of the document's mesh, until it is closed.

#include <QAction>
#include <QDockWidget>
#include <QFileInfo>
#include <QStatusBar>
#include <QTabBar>

#include "ui/main_window/main_window.h"
#include "ui/main_window/mesh_view.h"
#include "ui/panels/mesh_panel.h"
#include "ui/panels/pointer_tag.h"
#include "ui/panels/quality_panel.h"
#include "ui/panels/timeline_panel.h"
#include "ui/panels/untangle_panel.h"

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
    for (QTabBar* bar : findChildren<QTabBar*>(QString(), Qt::FindDirectChildrenOnly)) bar->setDrawBase(false);
    player_.open(run.recording);
    statusBar()->clearMessage();
    update_tool();
    update_commands();
}

void MainWindow::close_timeline() {
    if (!player_.is_open()) return;
    player_.close();
    timeline_dock_->hide();
    timeline_dock_->toggleViewAction()->setEnabled(false);
    bottom_dock_->raise();
    drag_.set_allowed(!jobs_.runner().is_running());
    quality_panel_->show_state();
    mesh_panel_->show_state();
    show_state();
    update_tool();
    if (document_.has_mesh()) view_->setFocus();
}

void MainWindow::show_settled() {
    if (!player_.is_open() || player_.is_seeking()) return;
    const auto& shown = player_.shown();
    MeshState state;
    state.mesh = std::make_shared<const CurvedMesh>(player_.recording()->mesh().with_coordinates(shown.coordinates));
    state.quality = std::make_shared<const QualityReport>(shown.quality);
    view_->show_state(state);
    quality_panel_->show_live(shown.quality);
    show_patch();
}

void MainWindow::show_patch() {
    const auto& patch = player_.shown().patch;
    view_->set_highlighted_elements(patch ? patch->elements : edit_.elements());
}

}  // namespace curvewright
