#include "ui/panels/form_fields.h"

#include <algorithm>
#include <cmath>

#include <QFormLayout>
#include <QLabel>
#include <QVBoxLayout>

namespace curvewright {

QVBoxLayout* make_panel_layout(QWidget* panel) {
    auto* layout = new QVBoxLayout(panel);
    layout->setContentsMargins(12, 12, 12, 8);
    layout->setSpacing(8);
    return layout;
}

QFormLayout* make_form() {
    auto* form = new QFormLayout;
    form->setHorizontalSpacing(12);
    form->setVerticalSpacing(8);
    form->setFieldGrowthPolicy(QFormLayout::AllNonFixedFieldsGrow);
    form->setLabelAlignment(Qt::AlignLeft | Qt::AlignVCenter);
    return form;
}

QDoubleSpinBox* make_number(const char* object_name, double lower, double upper, double step, int decimals,
                            double value) {
    // A few decimals stand in line below each other; many are rarely needed and leave no room.
    constexpr int most_shown = 3;
    auto* box = decimals > most_shown ? new PlainSpinBox : new QDoubleSpinBox;
    box->setObjectName(QLatin1String(object_name));
    box->setLocale(QLocale::c());
    box->setDecimals(decimals);
    box->setRange(lower, upper);
    box->setSingleStep(step);
    box->setValue(value);
    return box;
}

QComboBox* make_choice(const char* object_name, const QString& tip, const std::vector<Choice>& choices) {
    auto* box = new QComboBox;
    box->setObjectName(QLatin1String(object_name));
    for (const Choice& choice : choices) {
        box->addItem(choice.text, choice.value);
        box->setItemData(box->count() - 1, choice.tip, Qt::ToolTipRole);
    }
    const auto show_tip = [box, tip] {
        box->setToolTip(tip + QStringLiteral("\n\n") + box->currentText() + QStringLiteral(": ") +
                        box->currentData(Qt::ToolTipRole).toString());
    };
    QObject::connect(box, &QComboBox::currentIndexChanged, box, show_tip);
    show_tip();
    return box;
}

void align_labels(QFormLayout* form) {
    std::vector<QWidget*> labels;
    int width = 0;
    for (int row = 0; row < form->rowCount(); ++row)
        if (QLayoutItem* item = form->itemAt(row, QFormLayout::LabelRole)) {
            labels.push_back(item->widget());
            width = std::max(width, item->widget()->sizeHint().width());
        }
    for (QWidget* label : labels) label->setMinimumWidth(width);
}

void LogSpinBox::stepBy(int steps) {
    double next = value();
    for (; steps != 0; steps += steps > 0 ? -1 : 1) {
        // Down from a power of ten, the leading digit is that of the decade below.
        const double decade = std::pow(10.0, std::floor(std::log10(next) + 1e-9));
        const bool is_power = std::abs(next / decade - 1.0) < 1e-9;
        const double step = steps < 0 && is_power ? decade / 10.0 : decade;
        next = std::round(next / step + (steps > 0 ? 1 : -1)) * step;
    }
    setValue(next);
}

QString PlainSpinBox::textFromValue(double value) const {
    return QString::number(value, 'g', 10);
}

QString LogSpinBox::textFromValue(double value) const {
    return QString::number(value, 'g', 4);
}

}  // namespace curvewright
