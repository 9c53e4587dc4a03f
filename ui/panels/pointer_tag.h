#pragma once

#include <QFrame>

class QLabel;

namespace curvewright {

/// What a drag does to the elements, beside the pointer. The mouse goes through it.
class PointerTag : public QFrame {
    Q_OBJECT

  public:
    explicit PointerTag(QWidget* view);

    /// minimum: what the certified minimum is; validity: what the elements are; tone: that of set_tone.
    void show_quality(const QString& minimum, const QString& validity, const char* tone);
    /// Where it may stand, in the view.
    void set_room(const QRect& room);
    /// position: of the pointer, in the view.
    void follow(QPointF position);

  private:
    QLabel *minimum_ = nullptr, *validity_ = nullptr;
    QPointF position_;
    QRect room_;
};

}  // namespace curvewright
