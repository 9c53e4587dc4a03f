#include "ui/panels/focus_frame.h"

#include <QFocusEvent>
#include <QPainter>

namespace curvewright {
namespace {

constexpr int frame_width = 2;  ///< pixels

}  // namespace

FocusFrame::FocusFrame(QWidget* framed, const Theme& theme) : QWidget(framed), theme_(theme) {
    setObjectName(QStringLiteral("focus_frame"));
    setAttribute(Qt::WA_TransparentForMouseEvents);
    setFocusPolicy(Qt::NoFocus);
    hide();
    framed->installEventFilter(this);
    connect(&theme, &Theme::changed, this, qOverload<>(&QWidget::update));
}

bool FocusFrame::eventFilter(QObject* watched, QEvent* event) {
    if (watched != parent()) return QWidget::eventFilter(watched, event);
    if (event->type() == QEvent::Resize) fit();
    if (event->type() == QEvent::FocusOut) hide();
    if (event->type() == QEvent::MouseButtonPress) hide();
    if (event->type() == QEvent::FocusIn) {
        const Qt::FocusReason reason = static_cast<QFocusEvent*>(event)->reason();
        if (reason == Qt::TabFocusReason || reason == Qt::BacktabFocusReason || reason == Qt::ShortcutFocusReason) {
            fit();
            show();
            raise();
        }
    }
    return QWidget::eventFilter(watched, event);
}

void FocusFrame::fit() {
    const QRect all = parentWidget()->rect();
    setGeometry(all);
    setMask(QRegion(all) - QRegion(all.adjusted(frame_width, frame_width, -frame_width, -frame_width)));
}

void FocusFrame::paintEvent(QPaintEvent*) {
    QPainter(this).fillRect(rect(), theme_.color(QStringLiteral("accent")));
}

}  // namespace curvewright
