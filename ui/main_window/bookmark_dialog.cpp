#include "ui/main_window/bookmark_dialog.h"

#include <QDialogButtonBox>
#include <QHBoxLayout>
#include <QLabel>
#include <QListWidget>
#include <QPushButton>
#include <QVBoxLayout>

#include "ui/panels/widgets.h"

namespace curvewright {
namespace {

constexpr int number_role = Qt::UserRole;  ///< position in the list before it was changed

}  // namespace

BookmarkDialog::BookmarkDialog(ViewBookmarks& bookmarks, QWidget* parent) : QDialog(parent), bookmarks_(bookmarks) {
    setObjectName(QStringLiteral("bookmark_dialog"));
    setWindowTitle(tr("Bookmarks of the view"));
    setAttribute(Qt::WA_DeleteOnClose);
    list_ = new QListWidget;
    list_->setObjectName(QStringLiteral("bookmark_list"));
    list_->setDragDropMode(QAbstractItemView::InternalMove);
    list_->setEditTriggers(QAbstractItemView::EditKeyPressed | QAbstractItemView::SelectedClicked);
    go_ = new QPushButton(tr("Go to"));
    go_->setObjectName(QStringLiteral("bookmark_go"));
    rename_ = new QPushButton(tr("Rename"));
    rename_->setObjectName(QStringLiteral("bookmark_rename"));
    remove_ = new QPushButton(tr("Remove"));
    remove_->setObjectName(QStringLiteral("bookmark_remove"));
    auto* side = new QVBoxLayout;
    for (QPushButton* button : {go_, rename_, remove_}) {
        button->setAutoDefault(false);
        side->addWidget(button);
    }
    side->addStretch(1);
    auto* top = new QHBoxLayout;
    top->addWidget(list_, 1);
    top->addLayout(side);
    auto* buttons = new QDialogButtonBox(QDialogButtonBox::Close);
    auto* layout = new QVBoxLayout(this);
    layout->setContentsMargins(16, 16, 16, 12);
    layout->setSpacing(8);
    layout->addLayout(top, 1);
    layout->addWidget(make_paragraph(tr("Ctrl+1 to Ctrl+9 go to the first nine. Drag them to sort."), "muted"));
    layout->addWidget(buttons);
    resize(380, 320);

    connect(buttons, &QDialogButtonBox::rejected, this, &QDialog::reject);
    connect(list_, &QListWidget::itemActivated, this, [this] { emit chosen(list_->currentRow()); });
    connect(go_, &QPushButton::clicked, this, [this] { emit chosen(list_->currentRow()); });
    connect(rename_, &QPushButton::clicked, this, [this] { list_->editItem(list_->currentItem()); });
    connect(remove_, &QPushButton::clicked, this, [this] {
        delete list_->takeItem(list_->currentRow());
        take_list();
    });
    connect(list_, &QListWidget::itemChanged, this, &BookmarkDialog::take_list);
    connect(list_->model(), &QAbstractItemModel::rowsMoved, this, &BookmarkDialog::take_list);
    connect(list_, &QListWidget::currentRowChanged, this, [this](int row) {
        for (QPushButton* button : {go_, rename_, remove_}) button->setEnabled(row >= 0);
    });
    connect(&bookmarks, &ViewBookmarks::changed, this, [this] {
        if (!is_taking_) show_list();
    });
    show_list();
}

void BookmarkDialog::show_list() {
    const QSignalBlocker blocker(list_);
    list_->clear();
    for (int i = 0; i < bookmarks_.list().size(); ++i) {
        auto* item = new QListWidgetItem(bookmarks_.list()[i].name, list_);
        item->setData(number_role, i);
        item->setFlags((item->flags() | Qt::ItemIsEditable) & ~Qt::ItemIsDropEnabled);
    }
    list_->setCurrentRow(bookmarks_.list().isEmpty() ? -1 : 0);
    for (QPushButton* button : {go_, rename_, remove_}) button->setEnabled(list_->count() > 0);
}

void BookmarkDialog::take_list() {
    QList<ViewBookmark> list;
    const QSignalBlocker blocker(list_);
    for (int row = 0; row < list_->count(); ++row) {
        QListWidgetItem* item = list_->item(row);
        ViewBookmark bookmark = bookmarks_.list()[item->data(number_role).toInt()];
        // One without a name could not be chosen from a menu.
        if (item->text().trimmed().isEmpty())
            item->setText(bookmark.name);
        else
            bookmark.name = item->text().trimmed();
        item->setData(number_role, row);
        list << bookmark;
    }
    is_taking_ = true;
    bookmarks_.set_list(list);
    is_taking_ = false;
    for (QPushButton* button : {go_, rename_, remove_}) button->setEnabled(list_->currentRow() >= 0);
}

}  // namespace curvewright
