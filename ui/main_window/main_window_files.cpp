#include <QCloseEvent>
#include <QDir>
#include <QDragEnterEvent>
#include <QFileInfo>
#include <QMimeData>
#include <QSettings>
#include <QStandardPaths>
#include <QStatusBar>

#include "core/base/error.h"
#include "core/session/session_file.h"
#include "ui/main_window/main_window.h"
#include "ui/main_window/mesh_view.h"
#include "ui/main_window/picture_dialog.h"
#include "ui/panels/operation_panels.h"
#include "ui/panels/quality_panel.h"
#include "ui/panels/sample_note.h"
#include "ui/panels/start_page.h"
#include "ui/panels/untangle_panel.h"

namespace curvewright {
namespace {

struct WriteFilter {
    QString text;
    QString suffix;
    MeshFormat format;
};

QList<WriteFilter> write_filters() {
    return {{MainWindow::tr("Gmsh MSH 4.1 (*.msh)"), QStringLiteral("msh"), MeshFormat::msh4},
            {MainWindow::tr("Gmsh MSH 2.2 (*.msh)"), QStringLiteral("msh"), MeshFormat::msh2},
            {MainWindow::tr("VTU for ParaView, with quality (*.vtu)"), QStringLiteral("vtu"), MeshFormat::vtu},
            {MainWindow::tr("VTK legacy, with quality (*.vtk)"), QStringLiteral("vtk"), MeshFormat::vtk}};
}

QString filter_list(const QList<WriteFilter>& filters) {
    QStringList texts;
    for (const WriteFilter& filter : filters) texts << filter.text;
    return texts.join(QStringLiteral(";;"));
}

/// The format that path and chosen filter mean together; a path without a known suffix gets the filter's.
MeshFormat settle_format(QString& path, const QString& selected_filter) {
    const auto by_suffix = format_of_suffix(path.toStdString());
    for (const WriteFilter& filter : write_filters()) {
        if (filter.text != selected_filter) continue;
        if (!by_suffix) path += QLatin1Char('.') + filter.suffix;
        if (!by_suffix || filter.suffix == QFileInfo(path).suffix().toLower()) return filter.format;
    }
    return by_suffix.value_or(MeshFormat::msh4);
}

bool is_deformation_file(const QString& path) {
    const QString suffix = QFileInfo(path).suffix().toLower();
    return suffix == QLatin1String("json") || suffix == QLatin1String("csv");
}

QString first_file(const QMimeData* data) {
    for (const QUrl& url : data->urls())
        if (url.isLocalFile()) return url.toLocalFile();
    return {};
}

}  // namespace

QString MainWindow::last_folder() {
    return QSettings().value(QStringLiteral("last_folder"), QDir::homePath()).toString();
}

void MainWindow::remember_folder(const QString& path) {
    QSettings().setValue(QStringLiteral("last_folder"), QFileInfo(path).absolutePath());
}

bool MainWindow::is_busy() {
    // A hand that is still on the mesh lets go of it.
    drag_.cancel();
    if (!jobs_.runner().is_running()) return false;
    statusBar()->showMessage(tr("%1 is still running: stop it first (Esc).").arg(jobs_.runner().title()), 6000);
    return true;
}

void MainWindow::when_settled(std::function<void()> next) {
    if (!document_.is_dirty()) {
        next();
        return;
    }
    const UnsavedAnswer answer = dialogs_.ask_unsaved(this, document_.file_name());
    // Only a window that is being closed gets here with a job running; saving is a job itself.
    if (answer != UnsavedAnswer::cancel) jobs_.runner().cancel_and_wait();
    switch (answer) {
        case UnsavedAnswer::cancel:
            break;
        case UnsavedAnswer::discard:
            next();
            break;
        case UnsavedAnswer::save:
            after_save_ = std::move(next);
            save(false);
            break;
    }
}

void MainWindow::open_file(const QString& path, const QString& deformation_path, bool apply) {
    if (is_busy()) return;
    if (is_session_file(path.toStdU16String())) {
        open_session(path);
        return;
    }
    if (is_deformation_file(path)) {
        load_deformation(path);
        return;
    }
    when_settled([this, path, deformation_path, apply] {
        OpenRequest request;
        request.mesh_path = path;
        request.deformation_path = deformation_path;
        request.apply_deformation = apply;
        request.then = [this, path] {
            recent_.add(path);
            remember_folder(path);
        };
        jobs_.open(request);
    });
}

void MainWindow::open_sample(const Sample& sample) {
    if (is_busy()) return;
    if (!sample.is_there()) {
        dialogs_.show_error(this, tr("%1 has to be made first").arg(sample.title), sample.how_to_make());
        return;
    }
    when_settled([this, sample] {
        const bool is_untangle = sample.task == Sample::Task::untangle;
        OpenRequest request;
        request.mesh_path = sample.mesh_path;
        request.deformation_path = sample.deformation_path;
        request.apply_deformation = is_untangle && !sample.is_deformed;
        request.is_starting_point = true;
        request.then = [this, sample, is_untangle] {
            prepare_method(sample);
            show_tab(is_untangle ? QStringLiteral("untangle") : QStringLiteral("warp"));
            sample_note_->show_sample(sample);
        };
        jobs_.open(request);
    });
}

void MainWindow::prepare_method(const Sample& sample) {
    const bool is_warp = sample.task == Sample::Task::warp;
    warp_panel_->choose(sample.weighting, is_warp && sample.is_as_published);
    if (sample.method == UntangleMethod::unsigned_angles)
        untangle_panel_->choose_unsigned_angles(sample.is_as_published);
    else if (sample.beta)
        untangle_panel_->set_beta(*sample.beta);
    else
        untangle_panel_->choose_guaranteed();
}

void MainWindow::load_deformation(const QString& path) {
    if (is_busy()) return;
    if (is_session_file(path.toStdU16String())) {
        open_session(path);
        return;
    }
    if (!document_.has_mesh()) {
        dialogs_.show_error(
            this, tr("No mesh is open"),
            tr("%1 is a deformation: open the mesh that it deforms first.").arg(QFileInfo(path).fileName()));
        return;
    }
    if (jobs_.load_deformation(path)) remember_folder(path);
}

void MainWindow::ask_open() {
    if (is_busy()) return;
    const QString path = dialogs_.open_file(this, tr("Open a mesh"), last_folder(),
                                            tr("Meshes (*.msh *.msh.gz *.vtu *.vtk);;All files (*)"));
    if (!path.isEmpty()) open_file(path);
}

void MainWindow::ask_load_deformation() {
    if (is_busy()) return;
    const QString path =
        dialogs_.open_file(this, tr("Load a deformation"), last_folder(),
                           tr("Deformations (*.json *.csv *.msh *.msh.gz *.vtu *.vtk);;All files (*)"));
    if (!path.isEmpty()) load_deformation(path);
}

QString MainWindow::suggested_path(const QString& suffix) const {
    QString stem = document_.file_name();
    if (stem.endsWith(QLatin1String(".gz"))) stem.chop(3);
    stem = QFileInfo(stem).completeBaseName();
    return QDir(last_folder()).filePath(stem + QStringLiteral("-curved.") + suffix);
}

void MainWindow::save(bool ask_for_name) {
    if (!document_.has_mesh() || is_busy()) return;
    QString path = document_.file_path();
    pending_format_ = saved_format_;
    // The file that was opened is never overwritten without asking.
    if (ask_for_name || !saved_format_) {
        QString selected;
        path = dialogs_.save_file(this, tr("Save the mesh"), suggested_path(QStringLiteral("msh")),
                                  filter_list(write_filters()), selected);
        if (path.isEmpty()) {
            after_save_ = nullptr;
            return;
        }
        pending_format_ = settle_format(path, selected);
        remember_folder(path);
    }
    jobs_.write(path, pending_format_, true);
}

void MainWindow::ask_export() {
    if (!document_.has_mesh() || is_busy()) return;
    QList<WriteFilter> filters = write_filters();
    filters.move(2, 0);
    QString selected;
    QString path = dialogs_.save_file(this, tr("Export a copy"), suggested_path(QStringLiteral("vtu")),
                                      filter_list(filters), selected);
    if (path.isEmpty()) return;
    const MeshFormat format = settle_format(path, selected);
    remember_folder(path);
    jobs_.write(path, format, false);
}

void MainWindow::ask_save_picture() {
    if (!document_.has_mesh()) return;
    if (auto* open = findChild<PictureDialog*>()) {
        open->activateWindow();
        return;
    }
    auto* dialog = new PictureDialog(
        *view_,
        [this] {
            QString selected;
            const QString path = dialogs_.save_file(this, tr("Save a picture"), suggested_path(QStringLiteral("png")),
                                                    tr("PNG (*.png)"), selected);
            if (!path.isEmpty()) remember_folder(path);
            return path;
        },
        this);
    connect(&document_, &MeshDocument::opened, dialog, &QDialog::reject);
    connect(dialog, &PictureDialog::failed, this,
            [this](const QString& message) { dialogs_.show_error(this, tr("The picture was not saved"), message); });
    connect(dialog, &PictureDialog::saved, this, [this](const QString& path, QSize size) {
        const QString pixels = tr("%1 × %2 pixels").arg(size.width()).arg(size.height());
        tell(path.isEmpty() ? tr("The picture is on the clipboard (%1).").arg(pixels)
                            : tr("Wrote %1 (%2).").arg(path, pixels),
             8000);
    });
    dialog->show();
}

void MainWindow::ask_export_quality() {
    if (!document_.state().quality) return;
    const QStringList filters{tr("Table of bars and figures (*.csv)"), tr("Drawing (*.svg)"), tr("Picture (*.png)")};
    const QStringList suffixes{QStringLiteral("csv"), QStringLiteral("svg"), QStringLiteral("png")};
    QString suggestion = suggested_path(suffixes[0]);
    suggestion.replace(suggestion.lastIndexOf(QStringLiteral("-curved.")), 8, QStringLiteral("-quality."));
    QString selected = filters[0];
    QString path =
        dialogs_.save_file(this, tr("Export the histogram"), suggestion, filters.join(QStringLiteral(";;")), selected);
    if (path.isEmpty()) return;
    // The end of the name says what is written, unless only another kind was chosen, or none was typed.
    const auto kind = std::max<qsizetype>(0, filters.indexOf(selected));
    if (path == suggestion && kind > 0) path.chop(4);
    const QString stem = path;
    if (path == suggestion.chopped(4) || QFileInfo(path).suffix().isEmpty())
        for (int number = 2; path == stem || QFileInfo::exists(path); ++number)
            path =
                (number == 2 ? stem : stem + QStringLiteral("-%1").arg(number - 1)) + QLatin1Char('.') + suffixes[kind];
    try {
        write_comparison(quality_panel_->comparison(), path);
    } catch (const Error& error) {
        dialogs_.show_error(this, tr("The histogram was not exported"), QString::fromUtf8(error.what()));
        return;
    }
    remember_folder(path);
    tell(tr("Wrote %1.").arg(path), 8000);
}

void MainWindow::closeEvent(QCloseEvent* event) {
    if (document_.is_dirty() && !is_closing_) {
        event->ignore();
        // Saving is a job: the window closes again when it has ended.
        when_settled([this] {
            is_closing_ = true;
            QMetaObject::invokeMethod(this, &QWidget::close, Qt::QueuedConnection);
        });
        return;
    }
    jobs_.runner().cancel_and_wait();
    save_layout();
    event->accept();
}

void MainWindow::dragEnterEvent(QDragEnterEvent* event) {
    if (first_file(event->mimeData()).isEmpty()) return;
    event->acceptProposedAction();
    start_page_->set_drop_active(true);
}

void MainWindow::dragLeaveEvent(QDragLeaveEvent*) {
    start_page_->set_drop_active(false);
}

void MainWindow::dropEvent(QDropEvent* event) {
    start_page_->set_drop_active(false);
    const QString path = first_file(event->mimeData());
    if (path.isEmpty()) return;
    event->acceptProposedAction();
    // After the drop has ended: a question asked now would hold up the program that the file comes from.
    QMetaObject::invokeMethod(
        this, [this, path] { open_file(path); }, Qt::QueuedConnection);
}

}  // namespace curvewright
