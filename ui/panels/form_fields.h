#pragma once

#include <vector>

#include <QComboBox>
#include <QDoubleSpinBox>
#include <QString>

class QFormLayout;
class QVBoxLayout;

namespace curvewright {

/// The layout of an operation panel.
QVBoxLayout* make_panel_layout(QWidget* panel);
QFormLayout* make_form();
QDoubleSpinBox* make_number(const char* object_name, double lower, double upper, double step, int decimals,
                            double value);

/// One entry of a choice, with what it is good for.
struct Choice {
    QString text;
    int value;
    QString tip;
};

/// The box's own tip is `tip` and that of the entry chosen.
QComboBox* make_choice(const char* object_name, const QString& tip, const std::vector<Choice>& choices);

/// The value of the entry chosen.
template <class Enum>
Enum chosen(const QComboBox* box) {
    return static_cast<Enum>(box->currentData().toInt());
}

/// The labels of all rows in the width of the widest, so that the fields stay in place when rows are hidden.
void align_labels(QFormLayout* form);

/// A spin box without the zeros behind a number's last digit: 0, 0.25, 1e-07.
class PlainSpinBox : public QDoubleSpinBox {
    Q_OBJECT

  public:
    using QDoubleSpinBox::QDoubleSpinBox;
    QString textFromValue(double value) const override;
};

/// A spin box whose steps change the leading digit: 0.002, 0.003, ... 0.009, 0.01, 0.02.
class LogSpinBox : public QDoubleSpinBox {
    Q_OBJECT

  public:
    using QDoubleSpinBox::QDoubleSpinBox;
    void stepBy(int steps) override;
    QString textFromValue(double value) const override;
};

}  // namespace curvewright
