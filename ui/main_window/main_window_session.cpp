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
        tell(tr("Wrote %1 (%2 actions).").arg(path, format_count(static_cast<long long>(document_.session().size()))),
             8000);
    });
    connect(actions_[CommandId::open_session], &QAction::triggered, this, &MainWindow::ask_open_session);
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
        jobs_.recover(lost.path, [this, lost](const RestoredWork& work) {
            journal_->take_over(lost, work.intact_bytes, work.records);
            const QString saved = tr("Recovered with its history; save it to keep it.");
            if (work.remark.isEmpty()) return tell(saved);
            tell(work.remark + QLatin1Char(' ') + saved);
            receive({NoticeSeverity::warning, work.remark, {}, NoticeLife::document});
        });
    });
}

void MainWindow::open_session(const QString& path) {
    if (is_busy()) return;
    when_settled([this, path] {
        jobs_.open_session(path, [this, path] {
            recent_.add(path);
            remember_folder(path);
        });
    });
}

void MainWindow::ask_open_session() {
    if (is_busy()) return;
    const QString path =
        dialogs_.open_file(this, tr("Open a session"), last_folder(), tr("Sessions (*.json);;All files (*)"));
    if (path.isEmpty()) return;
    open_session(path);
}

}  // namespace curvewright
