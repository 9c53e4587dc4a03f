#include "ui/panels/clip_bar.h"

#include <cmath>

#include <QButtonGroup>
#include <QHBoxLayout>
#include <QLabel>
#include <QSlider>
#include <QToolButton>

#include "ui/panels/widgets.h"

namespace curvewright {

ClipBar::ClipBar(const Theme& theme, QWidget* parent) : QWidget(parent) {
    setObjectName(QStringLiteral("clip_bar"));
    setAttribute(Qt::WA_StyledBackground);
    auto* layout = new QHBoxLayout(this);
    layout->setContentsMargins(8, 4, 8, 4);
    layout->setSpacing(4);
    layout->addWidget(make_label(tr("Cut at"), "muted"));
    axes_ = new QButtonGroup(this);
    const QString names[] = {tr("x"), tr("y"), tr("z")};
    for (int axis = 0; axis < 3; ++axis) {
        auto* button = new QToolButton;
        button->setText(names[axis]);
        button->setCheckable(true);
        button->setChecked(axis == 0);
        button->setFixedSize(24, 24);
        button->setObjectName(QStringLiteral("clip_%1").arg(names[axis]));
        axes_->addButton(button, axis);
        layout->addWidget(button);
    }
    slider_ = new QSlider(Qt::Horizontal);
    slider_->setObjectName(QStringLiteral("clip_position"));
    slider_->setRange(0, 200);
    slider_->setValue(100);
    slider_->setMinimumWidth(160);
    layout->addWidget(slider_, 1);
    flip_ = new QToolButton;
    flip_->setCheckable(true);
    flip_->setObjectName(QStringLiteral("clip_flip"));
    flip_->setToolTip(tr("Show the other side"));
    layout->addWidget(flip_);

    const auto paint_icon = [this, &theme] { flip_->setIcon(theme.icon(QStringLiteral("flip"))); };
    paint_icon();
    connect(&theme, &Theme::changed, this, paint_icon);
    connect(axes_, &QButtonGroup::idToggled, this, [this](int, bool is_on) {
        if (is_on) emit changed();
    });
    connect(slider_, &QSlider::valueChanged, this, &ClipBar::changed);
    connect(flip_, &QToolButton::toggled, this, &ClipBar::changed);
}

void ClipBar::show_layer(double position) {
    const double step = position * slider_->maximum();
    constexpr double rounding = 1e-9;
    slider_->setValue(flip_->isChecked() ? static_cast<int>(std::floor(step - rounding))
                                         : static_cast<int>(std::ceil(step + rounding)));
}

void ClipBar::set_setting(const ClipSetting& setting) {
    if (QAbstractButton* button = axes_->button(setting.axis)) button->setChecked(true);
    flip_->setChecked(setting.is_flipped);
    slider_->setValue(static_cast<int>(std::lround(setting.position * slider_->maximum())));
}

ClipSetting ClipBar::setting() const {
    return {axes_->checkedId(), flip_->isChecked(), slider_->value() / double(slider_->maximum())};
}

}  // namespace curvewright
