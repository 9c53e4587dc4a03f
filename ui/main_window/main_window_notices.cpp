// What is told: the notices over the view, the log of messages, and what the buttons of notices do.

#include <QAction>
#include <QDesktopServices>
#include <QStatusBar>
#include <QUrl>

#include "ui/main_window/main_window.h"
#include "ui/main_window/mesh_view.h"
#include "ui/panels/banner.h"
#include "ui/panels/log_panel.h"
#include "ui/panels/untangle_panel.h"

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

void MainWindow::act_on(int notice, int place) {
    const Notice* told = notices_.find(notice);
    if (!told || place < 0 || place >= static_cast<int>(told->actions.size())) return;
    const NoticeAction action = told->actions[static_cast<std::size_t>(place)];
    if (action.command == NoticeCommand::select_elements) {
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
        case NoticeCommand::flip:
            jobs_.flip();
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
