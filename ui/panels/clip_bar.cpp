#include "ui/panels/clip_bar.h"

#include <array>
#include <cmath>

#include <QButtonGroup>
#include <QHBoxLayout>
#include <QLabel>
#include <QSettings>
#include <QSignalBlocker>
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
    slider_->setMinimumWidth(80);  // the bar gives it more where the view is wide enough
    layout->addWidget(slider_, 1);
    flip_ = new QToolButton;
    flip_->setCheckable(true);
    flip_->setObjectName(QStringLiteral("clip_flip"));
    flip_->setToolTip(tr("Show the other side"));
    layout->addWidget(flip_);

    styles_ = new QButtonGroup(this);
    const struct {
        const char *name, *icon;
        QString tip;
    } styles[] = {{"clip_whole", "clip_whole", tr("Hide whole elements beyond the plane")},
                  {"clip_through", "clip_through", tr("Cut through the elements and show the section")}};
    layout->addSpacing(8);
    for (int style = 0; style < 2; ++style) {
        auto* button = new QToolButton;
        button->setCheckable(true);
        button->setObjectName(QLatin1String(styles[style].name));
        button->setToolTip(styles[style].tip);
        button->setAccessibleName(styles[style].tip);
        styles_->addButton(button, style);
        layout->addWidget(button);
    }
    const QString remembered = QStringLiteral("view/clip_through");
    styles_->button(QSettings().value(remembered, false).toBool() ? 1 : 0)->setChecked(true);

    const auto paint_icon = [this, &theme, icons = std::array{styles[0].icon, styles[1].icon}] {
        flip_->setIcon(theme.icon(QStringLiteral("flip")));
        for (int style = 0; style < 2; ++style)
            styles_->button(style)->setIcon(theme.icon(QLatin1String(icons[static_cast<std::size_t>(style)])));
    };
    paint_icon();
    connect(&theme, &Theme::changed, this, paint_icon);
    const auto change = [this] {
        exact_position_.reset();
        emit changed();
    };
    connect(axes_, &QButtonGroup::idToggled, this, [change](int, bool is_on) {
        if (is_on) change();
    });
    connect(slider_, &QSlider::valueChanged, this, change);
    connect(flip_, &QToolButton::toggled, this, &ClipBar::changed);
    connect(styles_, &QButtonGroup::idToggled, this, [change, remembered](int style, bool is_on) {
        if (!is_on) return;
        QSettings().setValue(remembered, style == 1);
        change();
    });
}

void ClipBar::show_layer(double position) {
    if (styles_->checkedId() == 1) {
        {
            const QSignalBlocker blocker(slider_);
            slider_->setValue(static_cast<int>(std::lround(position * slider_->maximum())));
        }
        exact_position_ = position;
        emit changed();
        return;
    }
    const double step = position * slider_->maximum();
    constexpr double rounding = 1e-9;
    slider_->setValue(flip_->isChecked() ? static_cast<int>(std::floor(step - rounding))
                                         : static_cast<int>(std::ceil(step + rounding)));
}

void ClipBar::set_setting(const ClipSetting& setting) {
    if (QAbstractButton* button = axes_->button(setting.axis)) button->setChecked(true);
    flip_->setChecked(setting.is_flipped);
    styles_->button(setting.is_through ? 1 : 0)->setChecked(true);
    slider_->setValue(static_cast<int>(std::lround(setting.position * slider_->maximum())));
    exact_position_ = setting.position;
    emit changed();
}

ClipSetting ClipBar::setting() const {
    return {axes_->checkedId(), flip_->isChecked(),
            exact_position_.value_or(slider_->value() / double(slider_->maximum())), styles_->checkedId() == 1};
}

}  // namespace curvewright
