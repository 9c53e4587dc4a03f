#include "ui/panels/widgets.h"

#include <QLabel>
#include <QPushButton>
#include <QStyle>
#include <QVariant>

namespace curvewright {

QLabel* make_label(const QString& text, const char* role) {
    auto* label = new QLabel(text);
    label->setTextFormat(Qt::PlainText);
    if (*role) label->setProperty("role", QLatin1String(role));
    return label;
}

QLabel* make_paragraph(const QString& text, const char* role) {
    QLabel* label = make_label(text, role);
    label->setWordWrap(true);
    return label;
}

QPushButton* make_primary_button(const QString& text, const QString& object_name) {
    auto* button = new QPushButton(text);
    button->setObjectName(object_name);
    button->setProperty("primary", true);
    return button;
}

QPushButton* make_fold_button(const QString& text, const QString& object_name) {
    auto* button = new QPushButton;
    button->setObjectName(object_name);
    button->setProperty("link", true);
    button->setCheckable(true);
    button->setSizePolicy(QSizePolicy::Fixed, QSizePolicy::Fixed);
    const auto show = [button, text](bool is_unfolded) {
        button->setText((is_unfolded ? QStringLiteral("▾ ") : QStringLiteral("▸ ")) + text);
    };
    QObject::connect(button, &QPushButton::toggled, button, show);
    show(false);
    return button;
}

void set_tone(QLabel* label, const char* tone) {
    if (label->property("tone").toString() == QLatin1String(tone)) return;
    label->setProperty("tone", QLatin1String(tone));
    restyle(label);
}

void restyle(QWidget* widget) {
    widget->style()->unpolish(widget);
    widget->style()->polish(widget);
}

}  // namespace curvewright
