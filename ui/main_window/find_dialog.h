#pragma once

#include <QDialog>

#include "ui/document/edit_state.h"

class QLabel;
class QLineEdit;

namespace curvewright {

/// Edit > Find node or element: type tags, Enter selects what they name. Tells as one types how much that is, and which
/// tags do not exist.
class FindDialog : public QDialog {
    Q_OBJECT

  public:
    /// pre: edit's document has a mesh, as long as the dialog is open.
    FindDialog(EditState& edit, QWidget* parent);

  signals:
    /// Nodes and elements have been selected.
    void found();

  private:
    void tell();
    void take();

    EditState& edit_;
    QLineEdit* tags_ = nullptr;
    QLabel* answer_ = nullptr;
};

}  // namespace curvewright
