#pragma once

#include <QWidget>

#include "ui/document/edit_state.h"

class QCheckBox;
class QComboBox;
class QDoubleSpinBox;
class QFormLayout;
class QLabel;

namespace curvewright {

/// How the next drag goes: what is taken, how far it reaches, where it may go, what it snaps to.
class EditPanel : public QWidget {
    Q_OBJECT

  public:
    explicit EditPanel(EditState& edit, QWidget* parent = nullptr);

  private:
    void make_fields();
    void show_settings();
    void read_settings();
    void show_rows();

    EditState& edit_;
    bool is_showing_ = false;
    QFormLayout* form_ = nullptr;
    QComboBox *unit_ = nullptr, *falloff_ = nullptr, *direction_ = nullptr, *snap_ = nullptr;
    QCheckBox *soft_ = nullptr, *along_ = nullptr;
    QDoubleSpinBox *radius_ = nullptr, *spacing_ = nullptr, *size_ = nullptr, *thickness_ = nullptr;
    QDoubleSpinBox* center_[3] = {};
    QWidget* center_row_ = nullptr;
    QLabel *size_label_ = nullptr, *center_label_ = nullptr;
};

}  // namespace curvewright
