#pragma once

#include <functional>

#include <QDialog>

#include "ui/document/view_bookmarks.h"

class QListWidget;
class QPushButton;

namespace curvewright {

/// View > Bookmarks > Edit: renames, removes and sorts the bookmarks of the open mesh, at once.
class BookmarkDialog : public QDialog {
    Q_OBJECT

  public:
    BookmarkDialog(ViewBookmarks& bookmarks, QWidget* parent);

  signals:
    void chosen(int bookmark);

  private:
    void show_list();
    void take_list();

    ViewBookmarks& bookmarks_;
    QListWidget* list_ = nullptr;
    QPushButton *rename_ = nullptr, *remove_ = nullptr, *go_ = nullptr;
    bool is_taking_ = false;
};

}  // namespace curvewright
