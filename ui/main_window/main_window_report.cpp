// The report of the last untangling.

#include <QAction>
#include <QDir>

#include "ui/main_window/main_window.h"
#include "ui/scene/report_painter.h"

namespace curvewright {
namespace {

/// The painter of a report and what it paints: made with the first picture, on the window's thread.
struct Painting {
    ReportedStates states;
    std::unique_ptr<ReportPainter> painter;
};

}  // namespace

void MainWindow::connect_report() {
    connect(actions_[CommandId::report], &QAction::triggered, this, &MainWindow::ask_report);
}

void MainWindow::ask_report() {
    if (!last_untangling(document_) || is_busy()) return;
    const QString chosen = dialogs_.choose_folder(this, tr("Folder for the report"), last_folder());
    if (chosen.isEmpty()) return;
    remember_folder(QDir(chosen).filePath(QStringLiteral("report")));
    ReportRequest request;
    request.folder = free_report_folder(chosen, document_.file_name());
    request.colors = report_colors();
    auto painting = std::make_shared<Painting>();
    // The job's end releases it on this thread, whatever that end is.
    auto release = std::make_shared<QMetaObject::Connection>();
    *release = connect(&jobs_.runner(), &JobRunner::running_changed, this, [painting, release](bool is_running) {
        if (is_running) return;
        painting->painter.reset();
        painting->states = {};
        disconnect(*release);
    });
    request.draw = [painting](const ReportedStates& states, const PictureWish& wish) {
        if (!painting->painter) {
            painting->states = states;
            painting->painter = std::make_unique<ReportPainter>(*states.before, *states.quality_before, *states.after,
                                                                *states.quality_after);
        }
        return painting->painter->paint(wish);
    };
    request.then = [this](const QString& path, const QString& remark) {
        QString text = tr("The report is written: %1.").arg(QDir::toNativeSeparators(path));
        if (!remark.isEmpty()) text += QLatin1Char(' ') + remark;
        Notice notice{NoticeSeverity::information, text, {}, NoticeLife::state, QStringLiteral("report")};
        notice.actions.push_back({NoticeCommand::open_file, {}, path});
        receive(notice);
    };
    if (!jobs_.write_report(std::move(request))) disconnect(*release);
}

}  // namespace curvewright
