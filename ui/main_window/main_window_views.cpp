// Views that are gone back to, and films of the way to the present state.

#include <QAction>
#include <QLabel>
#include <QMenu>
#include <QStatusBar>

#include "ui/document/number_format.h"
#include "ui/main_window/bookmark_dialog.h"
#include "ui/main_window/film_dialog.h"
#include "ui/main_window/main_window.h"
#include "ui/main_window/mesh_view.h"
#include "ui/panels/clip_bar.h"
#include "ui/panels/worst_table.h"

namespace curvewright {
namespace {

/// What a bookmark remembers of what is shown, besides the cut.
constexpr CommandId shown_commands[] = {CommandId::edges,      CommandId::nodes, CommandId::shrink,
                                        CommandId::worst_only, CommandId::clip,  CommandId::orthographic};

}  // namespace

void MainWindow::connect_views() {
    connect(actions_[CommandId::bookmark_add], &QAction::triggered, this, &MainWindow::add_bookmark);
    connect(actions_[CommandId::bookmark_edit], &QAction::triggered, this, [this] {
        if (auto* open = findChild<BookmarkDialog*>()) {
            open->activateWindow();
            return;
        }
        auto* dialog = new BookmarkDialog(bookmarks_, this);
        connect(dialog, &BookmarkDialog::chosen, this, &MainWindow::go_to_bookmark);
        dialog->show();
    });
    connect(actions_[CommandId::export_film], &QAction::triggered, this, &MainWindow::ask_export_film);
    connect(&document_, &MeshDocument::opened, this, [this] { bookmarks_.set_mesh(document_.file_path()); });
    connect(&document_, &MeshDocument::file_path_changed, this, [this] {
        // Saved under another name: the bookmarks come along, unless that file has its own.
        if (bookmarks_.mesh() == document_.file_path() || !document_.has_mesh()) return;
        const QList<ViewBookmark> list = bookmarks_.list();
        bookmarks_.set_mesh(document_.file_path());
        if (bookmarks_.list().isEmpty()) bookmarks_.set_list(list);
    });
    connect(&bookmarks_, &ViewBookmarks::changed, this, &MainWindow::fill_bookmarks_menu);
    fill_bookmarks_menu();
}

void MainWindow::fill_bookmarks_menu() {
    qDeleteAll(bookmark_actions_);
    bookmark_actions_.clear();
    const QList<ViewBookmark>& list = bookmarks_.list();
    for (int i = 0; i < list.size(); ++i) {
        QString name = list[i].name;
        auto* action = new QAction(name.replace(QLatin1Char('&'), QStringLiteral("&&")), this);
        action->setObjectName(QStringLiteral("bookmark_%1").arg(i + 1));
        action->setStatusTip(tr("Go to this view"));
        if (i < 9) action->setShortcut(QKeySequence(Qt::CTRL | static_cast<Qt::Key>(Qt::Key_1 + i)));
        connect(action, &QAction::triggered, this, [this, i] { go_to_bookmark(i); });
        bookmarks_menu_->addAction(action);
        bookmark_actions_ << action;
    }
    actions_[CommandId::bookmark_edit]->setEnabled(!list.isEmpty());
}

void MainWindow::add_bookmark() {
    if (!document_.has_mesh()) return;
    if (bookmarks_.is_full()) {
        statusBar()->showMessage(
            tr("There are %1 bookmarks of this mesh: remove one first.").arg(ViewBookmarks::most_of_a_mesh), 8000);
        return;
    }
    QString name = bookmarks_.new_name();
    if (edit_.elements().size() == 1)
        name = tr("Element %1").arg(document_.state().mesh->topology().element_tag(edit_.elements().front()).value);
    name = dialogs_.ask_text(this, tr("Bookmark this view"), tr("Name"), name).trimmed();
    if (name.isEmpty()) return;
    QJsonObject shown;
    for (const CommandId id : shown_commands) shown[actions_[id]->objectName()] = actions_[id]->isChecked();
    shown[QStringLiteral("worst_count")] = preferences_.worst_count;
    const ClipSetting cut = clip_bar_->setting();
    shown[QStringLiteral("cut")] = QJsonObject{{QStringLiteral("axis"), cut.axis},
                                               {QStringLiteral("flipped"), cut.is_flipped},
                                               {QStringLiteral("position"), cut.position},
                                               {QStringLiteral("through"), cut.is_through}};
    bookmarks_.add({name, view_->pose(), shown});
    const qsizetype number = bookmarks_.list().size();
    statusBar()->showMessage(number <= 9 ? tr("Ctrl+%1 goes to “%2”.").arg(number).arg(name)
                                         : tr("View > Bookmarks goes to “%1”.").arg(name),
                             6000);
}

void MainWindow::go_to_bookmark(int number) {
    if (number < 0 || number >= bookmarks_.list().size() || !document_.has_mesh()) return;
    const ViewBookmark bookmark = bookmarks_.list()[number];
    const QJsonObject cut = bookmark.shown[QStringLiteral("cut")].toObject();
    if (!cut.isEmpty())
        clip_bar_->set_setting({cut[QStringLiteral("axis")].toInt(), cut[QStringLiteral("flipped")].toBool(),
                                cut[QStringLiteral("position")].toDouble(0.5),
                                cut[QStringLiteral("through")].toBool()});
    if (const int count = bookmark.shown[QStringLiteral("worst_count")].toInt();
        count > 0 && bookmark.shown[actions_[CommandId::worst_only]->objectName()].toBool())
        worst_table_->set_count(count);
    for (const CommandId id : shown_commands) {
        const QJsonValue is_shown = bookmark.shown[actions_[id]->objectName()];
        if (is_shown.isBool() && actions_[id]->isEnabled()) actions_[id]->setChecked(is_shown.toBool());
    }
    view_->fly_to(bookmark.pose);
    statusBar()->showMessage(bookmark.name, 3000);
}

void MainWindow::ask_export_film() {
    if (!actions_[CommandId::export_film]->isEnabled() || is_busy()) return;
    if (auto* open = findChild<FilmDialog*>()) {
        open->activateWindow();
        return;
    }
    auto* dialog = new FilmDialog(
        jobs_, player_, *view_,
        [this](const QString& folder) { return dialogs_.choose_folder(this, tr("Folder for the pictures"), folder); },
        this);
    dialog->show();
}

}  // namespace curvewright
