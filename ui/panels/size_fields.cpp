#include "ui/panels/size_fields.h"

#include <algorithm>
#include <cmath>

#include <QCheckBox>
#include <QComboBox>
#include <QHBoxLayout>
#include <QLabel>
#include <QSettings>
#include <QSpinBox>
#include <QVBoxLayout>

#include "ui/panels/widgets.h"

namespace curvewright {
namespace {

constexpr int least_side = 16, largest_side = 99999;

QSpinBox* make_side(const char* object_name, const QString& tip, int step) {
    auto* box = new QSpinBox;
    box->setObjectName(QLatin1String(object_name));
    box->setToolTip(tip);
    box->setLocale(QLocale::c());
    box->setRange(least_side, largest_side);
    box->setSingleStep(step);
    return box;
}

}  // namespace

SizeFields::SizeFields(const QString& settings, bool is_even, QWidget* parent)
    : QWidget(parent), settings_(settings), is_even_(is_even) {
    preset_ = new QComboBox;
    preset_->setObjectName(QStringLiteral("size_preset"));
    preset_->addItems(
        {tr("As the view"), tr("Twice the view"), tr("1920 × 1080"), tr("3840 × 2160"), tr("Another size")});
    width_ = make_side("size_width", tr("Width, pixels"), is_even ? 2 : 1);
    height_ = make_side("size_height", tr("Height, pixels"), is_even ? 2 : 1);
    keeps_ = new QCheckBox(tr("Keep the proportions"));
    keeps_->setObjectName(QStringLiteral("size_keeps"));
    auto* sides = new QHBoxLayout;
    sides->setSpacing(4);
    sides->addWidget(width_, 1);
    sides->addWidget(make_label(QStringLiteral("×"), "muted"));
    sides->addWidget(height_, 1);
    auto* layout = new QVBoxLayout(this);
    layout->setContentsMargins(0, 0, 0, 0);
    layout->setSpacing(4);
    layout->addWidget(preset_);
    layout->addLayout(sides);
    layout->addWidget(keeps_);

    const QSettings saved;
    keeps_->setChecked(saved.value(settings_ + QStringLiteral("/keeps_proportions"), true).toBool());
    const QSize size = saved.value(settings_ + QStringLiteral("/size"), QSize(1920, 1080)).toSize();
    show_size(size.expandedTo({least_side, least_side}));
    preset_->setCurrentIndex(
        std::clamp(saved.value(settings_ + QStringLiteral("/preset"), int(as_view)).toInt(), int(as_view), int(own)));
    choose(preset_->currentIndex());

    connect(preset_, &QComboBox::currentIndexChanged, this, &SizeFields::choose);
    connect(width_, &QSpinBox::valueChanged, this, [this] { follow(width_, height_); });
    connect(height_, &QSpinBox::valueChanged, this, [this] { follow(height_, width_); });
    connect(keeps_, &QCheckBox::toggled, this, [this](bool is_on) {
        if (is_on) proportion_ = double(width_->value()) / height_->value();
    });
    // Odd numbers are typed all the same: they are put right when the field is left.
    for (QSpinBox* box : {width_, height_})
        connect(box, &QSpinBox::editingFinished, this, [this, box] { box->setValue(fitting(box->value())); });
}

int SizeFields::fitting(double pixels) const {
    const int whole = static_cast<int>(std::clamp(std::round(pixels), double(least_side), double(largest_side)));
    return is_even_ ? 2 * (whole / 2) : whole;
}

QSize SizeFields::size_of(int preset) const {
    const QSize size = preset == as_view    ? view_size_
                       : preset == twice    ? 2 * view_size_
                       : preset == full_hd  ? QSize(1920, 1080)
                       : preset == ultra_hd ? QSize(3840, 2160)
                                            : picture_size();
    return {fitting(size.width()), fitting(size.height())};
}

void SizeFields::show_size(QSize size) {
    is_showing_ = true;
    width_->setValue(size.width());
    height_->setValue(size.height());
    is_showing_ = false;
    proportion_ = double(size.width()) / size.height();
}

void SizeFields::choose(int preset) {
    show_size(size_of(preset));
    emit changed();
}

void SizeFields::follow(QSpinBox* edited, QSpinBox* other) {
    if (is_showing_) return;
    is_showing_ = true;
    if (keeps_->isChecked())
        other->setValue(fitting(edited == width_ ? edited->value() / proportion_ : edited->value() * proportion_));
    const QSignalBlocker blocker(preset_);
    preset_->setCurrentIndex(own);
    is_showing_ = false;
    emit changed();
}

void SizeFields::set_view_size(QSize size) {
    view_size_ = size;
    const int preset = preset_->currentIndex();
    if (preset == as_view || preset == twice) choose(preset);
}

QSize SizeFields::picture_size() const {
    return {fitting(width_->value()), fitting(height_->value())};
}

void SizeFields::remember() const {
    QSettings settings;
    settings.setValue(settings_ + QStringLiteral("/keeps_proportions"), keeps_->isChecked());
    settings.setValue(settings_ + QStringLiteral("/preset"), preset_->currentIndex());
    settings.setValue(settings_ + QStringLiteral("/size"), picture_size());
}

}  // namespace curvewright
