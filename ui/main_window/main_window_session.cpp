#include <QAction>
#include <QClipboard>
#include <QFileInfo>
#include <QGuiApplication>
#include <QStatusBar>
#include <QTimer>

#include "core/base/error.h"
#include "core/session/session_file.h"
#include "ui/document/number_format.h"
#include "ui/main_window/main_window.h"

namespace curvewright {

void MainWindow::connect_session() {
    journal_ = std::make_unique<Journal>(document_, Journal::standard_folder());
    connect(actions_[CommandId::copy_command], &QAction::triggered, this, [this] {
        const std::vector<Action> way = document_.way_here();
        QGuiApplication::clipboard()->setText(
            QString::fromStdString(command_line(way, suggested_path(QStringLiteral("msh")).toStdString())));
        statusBar()->showMessage(tr("The command line is on the clipboard."), 6000);
    });
    connect(actions_[CommandId::save_session], &QAction::triggered, this, [this] {
        QString selected;
        QString path = dialogs_.save_file(this, tr("Save the session"), suggested_path(QStringLiteral("json")),
                                          tr("Session, one action per line (*.json)"), selected);
        if (path.isEmpty()) return;
        if (QFileInfo(path).suffix().isEmpty()) path += QStringLiteral(".json");
        try {
            write_session(path.toStdU16String(), document_.session());
        } catch (const Error& problem) {
            dialogs_.show_error(this, tr("The session was not saved"), QString::fromUtf8(problem.what()));
            return;
        }
        statusBar()->showMessage(
            tr("Wrote %1 (%2 actions).").arg(path, format_count(static_cast<long long>(document_.session().size()))),
            8000);
    });
    // When the window is there, and not before whatever the command line asks to open.
    QTimer::singleShot(0, this, &MainWindow::offer_lost_work);
}

void MainWindow::open_last_mesh() {
    const QStringList recent = recent_.paths();
    const bool is_wanted = preferences_.start == StartAction::last_mesh && !recent.isEmpty();
    if (is_wanted && !document_.has_mesh() && !jobs_.runner().is_running()) open_file(recent.front());
}

void MainWindow::offer_lost_work() {
    for (const LostWork& lost : journal_->find_lost_work()) {
        const QString name = QFileInfo(lost.mesh_path).fileName();
        const auto steps = static_cast<long long>(lost.steps.size());
        const QString message =
            tr("Curvewright ended unexpectedly. Unsaved changes to %1 are kept: %2, the last one “%3”, %4.")
                .arg(name, steps == 1 ? tr("1 step") : tr("%1 steps").arg(format_count(steps)),
                     lost.steps.isEmpty() ? QString() : lost.steps.back(),
                     lost.time.toString(QStringLiteral("yyyy-MM-dd HH:mm")));
        const UnsavedAnswer answer = dialogs_.ask_recover(this, message);
        if (answer == UnsavedAnswer::discard) journal_->discard(lost);
        if (answer == UnsavedAnswer::save) {
            recover(lost);
            return;  // one mesh at a time; the others are offered at the next start
        }
    }
    open_last_mesh();
}

void MainWindow::recover(const LostWork& lost) {
    if (is_busy()) return;
    when_settled([this, lost] {
        OpenRequest request;
        request.mesh_path = lost.mesh_path;
        request.first_step = [lost](const CurvedMesh& mesh) {
            Step step;
            step.coordinates = Journal::read_positions(lost, mesh.topology().node_count());
            step.name = tr("Recovered work");
            step.details = lost.steps.join(QLatin1Char('\n'));
            return step;
        };
        request.then = [this, lost] {
            journal_->discard(lost);
            statusBar()->showMessage(tr("Recovered; save it to keep it."), 12000);
        };
        jobs_.open(request);
    });
}

}  // namespace curvewright
