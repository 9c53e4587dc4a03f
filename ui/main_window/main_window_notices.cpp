// What is told: the notices over the view, the log of messages, and what the buttons of notices do.

#include <QAction>
#include <QDesktopServices>
#include <QLabel>
#include <QStatusBar>
#include <QUrl>

#include "ui/main_window/main_window.h"
#include "ui/main_window/mesh_view.h"
#include "ui/panels/banner.h"
#include "ui/panels/improve_panel.h"
#include "ui/panels/log_panel.h"
#include "ui/panels/mesh_panel.h"
#include "ui/panels/untangle_panel.h"
#include "ui/panels/widgets.h"

namespace curvewright {

void MainWindow::connect_notices() {
    // What a dialog tells is gone when it is closed.
    dialogs_.show_error = [this, show = dialogs_.show_error](QWidget* parent, const QString& title,
                                                             const QString& message) {
        log_.add({{}, present_step(), NoticeSeverity::error, tr("%1: %2").arg(title, message)});
        show(parent, title, message);
    };
    connect(&jobs_, &MeshJobs::note, this, [this](const QString& text) { tell(text); });
    connect(&jobs_, &MeshJobs::noticed, this, &MainWindow::receive);
    connect(&document_, &MeshDocument::opened, this, [this] {
        for (const QString& text : document_.notes())
            receive({NoticeSeverity::warning, text, {}, NoticeLife::document});
        const auto& mesh = document_.state().mesh;
        for (const Notice& notice : standing_notices(document_))
            log_.add(log_entry(notice, present_step(), mesh->shared_topology()));
    });
    const auto hold = [this] { global_check_.hold(jobs_.runner().is_running() || drag_.is_active()); };
    connect(&jobs_.runner(), &JobRunner::running_changed, &global_check_, hold);
    connect(&drag_, &LiveDrag::active_changed, &global_check_, hold);
    connect(&global_check_, &GlobalCheck::changed, this, &MainWindow::show_global);
    connect(&global_check_, &GlobalCheck::found, this, [this] {
        if (const auto notice = global_notice(*global_check_.report())) receive(*notice);
    });
    connect(&notices_, &NoticeBoard::changed, this, &MainWindow::show_notices);
    // What is under a hand stays in its place.
    connect(&drag_, &LiveDrag::active_changed, this, &MainWindow::show_notices);
    connect(banner_, &Banner::action_triggered, this, &MainWindow::act_on);
    connect(banner_, &Banner::dismissed, &notices_, &NoticeBoard::dismiss);
    connect(log_panel_, &LogPanel::entry_chosen, this, &MainWindow::show_logged);
}

QString MainWindow::present_step() const {
    if (!document_.has_mesh()) return {};
    const QString step = document_.history()->undoText();
    return step.isEmpty() ? tr("%1 as opened").arg(document_.file_name()) : step;
}

void MainWindow::tell(const QString& text, int milliseconds) {
    statusBar()->showMessage(text, milliseconds);
    log_.add({{}, present_step(), NoticeSeverity::information, text});
}

void MainWindow::receive(const Notice& notice) {
    const auto& mesh = document_.state().mesh;
    log_.add(log_entry(notice, present_step(), mesh ? mesh->shared_topology() : nullptr));
    notices_.post(notice);
}

void MainWindow::show_notices() {
    if (drag_.is_active()) return;
    const bool had_focus = banner_->isVisible() && banner_->isAncestorOf(focusWidget());
    banner_->show_lines(notices_.lines());
    if (had_focus && !banner_->isVisible()) view_->setFocus();
}

void MainWindow::show_global() {
    const auto report = global_check_.report();
    mesh_panel_->show_global(report.get(), global_check_.is_pending(), global_check_.progress());
    const auto& quality = document_.state().quality;
    if (!quality || drag_.is_active() || player_.is_open()) return;
    show_verdict(quality->summary);
    // Valid elements that overlap are not all there is to say.
    const bool is_told = quality->summary.invalid + quality->summary.undecided > 0;
    if (!report || is_told || report->answer != GlobalValidity::no) return;
    verdict_->setText(global_text(*report));
    set_tone(verdict_, "alarm");
}

void MainWindow::act_on(int notice, int place) {
    const Notice* told = notices_.find(notice);
    if (!told || place < 0 || place >= static_cast<int>(told->actions.size())) return;
    const NoticeAction action = told->actions[static_cast<std::size_t>(place)];
    if (action.command == NoticeCommand::select_elements) {
        if (action.items.size() == 1) return select_elements(action.items, true);
        edit_.select_elements(action.items);
        return fit_selection();
    }
    if (action.command == NoticeCommand::select_nodes) {
        edit_.select_nodes(action.items);
        return fit_selection();
    }
    if (action.command == NoticeCommand::open_file) {
        QDesktopServices::openUrl(QUrl::fromLocalFile(action.file));
        return;
    }
    // The others change the mesh.
    if (is_busy()) return;
    if (action.undoes) document_.history()->undo();
    switch (action.command) {
        case NoticeCommand::slide_boundary:
        case NoticeCommand::slide_interface:
            untangle_panel_->show_options(*action.options);
            show_tab(QStringLiteral("untangle"));
            jobs_.untangle(*action.options);
            break;
        case NoticeCommand::improve:
            improve_panel_->show_options(*action.improve);
            show_tab(QStringLiteral("untangle"));
            jobs_.improve(*action.improve);
            break;
        case NoticeCommand::flip:
            jobs_.flip();
            break;
        case NoticeCommand::renumber:
            jobs_.renumber();
            break;
        default:
            break;
    }
}

void MainWindow::show_logged(const LogEntry& entry) {
    const auto& mesh = document_.state().mesh;
    if (entry.elements.empty() && entry.nodes.empty()) {
        statusBar()->showMessage(tr("This message is about no elements or nodes in particular."), 6000);
    } else if (!mesh || entry.topology.lock() != mesh->shared_topology()) {
        statusBar()->showMessage(tr("This message is about another mesh than the one that is open."), 6000);
    } else {
        edit_.select(entry.nodes, entry.elements);
        fit_selection();
    }
}

}  // namespace curvewright
