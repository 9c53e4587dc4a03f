#include "ui/panels/pointer_tag.h"

#include <algorithm>

#include <QLabel>
#include <QVBoxLayout>

#include "ui/panels/widgets.h"

namespace curvewright {

PointerTag::PointerTag(QWidget* view) : QFrame(view) {
    setObjectName(QStringLiteral("pointer_tag"));
    setAttribute(Qt::WA_TransparentForMouseEvents);
    setAttribute(Qt::WA_StyledBackground);
    auto* layout = new QVBoxLayout(this);
    layout->setContentsMargins(8, 4, 8, 4);
    layout->setSpacing(0);
    minimum_ = make_label(QString(), "");
    minimum_->setObjectName(QStringLiteral("pointer_minimum"));
    validity_ = make_label(QString(), "");
    validity_->setObjectName(QStringLiteral("pointer_validity"));
    layout->addWidget(minimum_);
    layout->addWidget(validity_);
    hide();
}

void PointerTag::show_quality(const QString& minimum, const QString& validity, const char* tone) {
    minimum_->setText(minimum);
    validity_->setText(validity);
    set_tone(validity_, tone);
    // Wider only, as long as it is seen: a tag that trembles with its digits is hard to read.
    const QSize wanted = sizeHint();
    resize(isVisible() ? qMax(width(), wanted.width()) : wanted.width(), wanted.height());
    follow(position_);
    show();
    raise();
}

void PointerTag::set_room(const QRect& room) {
    room_ = room;
}

void PointerTag::follow(QPointF position) {
    position_ = position;
    constexpr int distance = 18;
    QPoint corner = position.toPoint() + QPoint(distance, distance);
    if (corner.x() + width() > room_.right()) corner.setX(position.toPoint().x() - distance - width());
    if (corner.y() + height() > room_.bottom()) corner.setY(position.toPoint().y() - distance - height());
    // Wherever the pointer is: the legend stays legible. Above or below the pointer there is room.
    corner.setX(std::max(room_.left(), std::min(corner.x(), room_.right() - width())));
    corner.setY(std::max(room_.top(), std::min(corner.y(), room_.bottom() - height())));
    move(corner);
}

}  // namespace curvewright
