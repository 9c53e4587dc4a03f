#pragma once

#include <QWidget>

#include "ui/document/edit_state.h"
#include "ui/jobs/live_drag.h"

class QCheckBox;
class QComboBox;
class QDoubleSpinBox;
class QFormLayout;
class QLabel;
class QPushButton;

namespace curvewright {

class BoundaryField;

/// How the next drag goes: what is taken, how far it reaches, where it may go, what it snaps to; and motions of the
/// selection by numbers.
class EditPanel : public QWidget {
    Q_OBJECT

  public:
    EditPanel(EditState& edit, LiveDrag& drag, QWidget* parent = nullptr);

  private:
    void make_fields();
    void show_settings();
    void read_settings();
    void show_rows();

    void make_numbers();
    void show_numbers();
    void apply_numbers();

    EditState& edit_;
    LiveDrag& drag_;
    bool is_showing_ = false;
    QFormLayout* form_ = nullptr;
    QComboBox *unit_ = nullptr, *falloff_ = nullptr, *direction_ = nullptr, *snap_ = nullptr;
    QCheckBox *soft_ = nullptr, *along_ = nullptr;
    QDoubleSpinBox *radius_ = nullptr, *spacing_ = nullptr, *size_ = nullptr, *thickness_ = nullptr;
    QDoubleSpinBox* center_[3] = {};
    QWidget* center_row_ = nullptr;
    BoundaryField* others_ = nullptr;
    QCheckBox* anew_ = nullptr;
    QFormLayout* numbers_form_ = nullptr;
    QComboBox *motion_ = nullptr, *axis_ = nullptr;
    QDoubleSpinBox *numbers_[3] = {}, *angle_ = nullptr;
    QWidget* numbers_row_ = nullptr;
    QPushButton* apply_ = nullptr;
    QLabel *size_label_ = nullptr, *center_label_ = nullptr;
};

}  // namespace curvewright
