#include "ui/panels/histogram_widget.h"

#include <algorithm>

#include <QKeyEvent>
#include <QMouseEvent>
#include <QPainter>
#include <QToolTip>

#include "ui/document/number_format.h"

namespace curvewright {
namespace {

constexpr int no_bar = HistogramBars::no_bar;

}  // namespace

HistogramWidget::HistogramWidget(const Theme& theme, QWidget* parent) : QWidget(parent), theme_(theme) {
    setMouseTracking(true);
    setFocusPolicy(Qt::StrongFocus);
    setAccessibleName(tr("Histogram of the scaled Jacobian"));
    setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Expanding);
    connect(&theme, &Theme::changed, this, qOverload<>(&QWidget::update));
}

void HistogramWidget::set_elements(std::optional<std::span<const ElementQuality>> elements, double least) {
    drawing_.bars = elements ? make_bars(*elements) : HistogramBars();
    drawing_.bars.mark(selected_);
    drawing_.has_data = elements.has_value();
    drawing_.least = least;
    update();
}

void HistogramWidget::set_outline(std::optional<HistogramBars> outline) {
    if (!outline && !drawing_.outline) return;
    drawing_.outline = std::move(outline);
    update();
}

void HistogramWidget::set_title(const QString& title) {
    drawing_.title = title;
    update();
}

void HistogramWidget::set_selected(const IndexSet& elements) {
    if (elements == selected_) return;
    selected_ = elements;
    drawing_.bars.mark(selected_);
    update();
}

void HistogramWidget::set_scale(Index limit, bool is_logarithmic) {
    limit = std::max<Index>(1, limit);
    if (limit == drawing_.limit && is_logarithmic == drawing_.is_logarithmic) return;
    drawing_.limit = limit;
    drawing_.is_logarithmic = is_logarithmic;
    update();
}

void HistogramWidget::set_colors(const ColorScale& colors) {
    if (colors == drawing_.colors) return;
    drawing_.colors = colors;
    update();
}

void HistogramWidget::resizeEvent(QResizeEvent*) {
    drawing_.frame = rect();
}

void HistogramWidget::paintEvent(QPaintEvent*) {
    QPainter painter(this);
    drawing_.font = Theme::small_font();
    drawing_.marked_bar = hovered_ != no_bar ? hovered_ : hasFocus() ? current_ : no_bar;
    const bool has_range = current_ != no_bar && (is_brushing_ || (hasFocus() && anchor_ != current_));
    drawing_.band_first = has_range ? std::min(anchor_, current_) : 0;
    drawing_.band_last = has_range ? std::max(anchor_, current_) : no_bar;
    drawing_.draw(painter, screen_ink(theme_));
    if (!hasFocus()) return;
    painter.setPen(theme_.color(QStringLiteral("accent")));
    painter.setBrush(Qt::NoBrush);
    painter.drawRoundedRect(QRectF(rect()).adjusted(0.5, 0.5, -0.5, -0.5), 4, 4);
}

QString HistogramWidget::describe(int first, int last) const {
    const auto counted = [first, last](const HistogramBars& bars) {
        HistogramBars::Bar sum;
        for (int bar = first; bar <= last; ++bar) {
            sum.decided += bars.at(bar).count();
            sum.selected += bars.at(bar).selected;
        }
        return sum;
    };
    const HistogramBars::Bar sum = counted(drawing_.bars);
    QString text = sum.count() == 1 ? tr("1 element") : tr("%1 elements").arg(format_count(sum.count()));
    text += QStringLiteral(", ");
    const QString upper = QString::number(HistogramBars::lower(last + 1), 'f', 2);
    if (last < 0)
        text += tr("tangled (scaled Jacobian ≤ 0)");
    else if (first < 0)
        text += tr("tangled, or scaled Jacobian up to %1").arg(upper);
    else
        text += tr("scaled Jacobian %1 to %2").arg(QString::number(HistogramBars::lower(first), 'f', 2), upper);
    if (drawing_.outline) text += tr("; before: %1").arg(format_count(counted(*drawing_.outline).count()));
    if (sum.selected > 0) text += tr("; %1 selected").arg(format_count(sum.selected));
    return text;
}

int HistogramWidget::next_bar(int bar, int step) const {
    for (int next = bar + step; next >= HistogramBars::tangled_bar && next < HistogramBars::bins; next += step)
        if (drawing_.bars.at(next).count() > 0) return next;
    return bar;
}

void HistogramWidget::tell_range(QPoint place) {
    QToolTip::showText(place, describe(std::min(anchor_, current_), std::max(anchor_, current_)), this);
}

void HistogramWidget::go_to(int bar, bool extends) {
    if (bar == no_bar) return;
    const bool is_other = bar != current_;
    if (anchor_ == no_bar || !extends) anchor_ = bar;
    current_ = bar;
    update();
    const QRectF area = drawing_.bar_area(bar);
    tell_range(mapToGlobal(QPointF(area.center().x(), area.bottom()).toPoint()));
    if (!extends || !is_other) return;
    kept_.clear();
    take();
}

bool HistogramWidget::event(QEvent* event) {
    // Keys that go from bar to bar are no commands here.
    if (event->type() == QEvent::ShortcutOverride) {
        const auto* key = static_cast<QKeyEvent*>(event);
        const bool is_plain = (key->modifiers() & ~(Qt::ShiftModifier | Qt::KeypadModifier)) == Qt::NoModifier;
        for (const int its : {Qt::Key_Left, Qt::Key_Right, Qt::Key_Home, Qt::Key_End})
            if (is_plain && key->key() == its) event->accept();
    }
    return QWidget::event(event);
}

void HistogramWidget::keyPressEvent(QKeyEvent* event) {
    const bool extends = event->modifiers().testFlag(Qt::ShiftModifier);
    switch (event->key()) {
        case Qt::Key_Left:
            go_to(next_bar(current_, -1), extends);
            break;
        case Qt::Key_Right:
            go_to(next_bar(current_, 1), extends);
            break;
        case Qt::Key_Home:
            go_to(next_bar(no_bar, 1), extends);
            break;
        case Qt::Key_End:
            go_to(next_bar(HistogramBars::bins, -1), extends);
            break;
        case Qt::Key_Return:
        case Qt::Key_Enter:
        case Qt::Key_Space:
            if (current_ == no_bar) break;
            kept_ = event->modifiers().testFlag(Qt::ControlModifier) ? selected_ : IndexSet();
            take();
            break;
        default:
            QWidget::keyPressEvent(event);
    }
}

void HistogramWidget::focusInEvent(QFocusEvent* event) {
    // A click says itself where it is.
    if (event->reason() == Qt::MouseFocusReason) {
        update();
        return;
    }
    // The worst first, unless the keyboard was here before.
    if (current_ == no_bar || drawing_.bars.at(current_).count() == 0) current_ = next_bar(no_bar, 1);
    go_to(current_, false);
}

void HistogramWidget::focusOutEvent(QFocusEvent*) {
    QToolTip::hideText();
    update();
}

void HistogramWidget::take() {
    const IndexSet range = drawing_.bars.elements_in(std::min(anchor_, current_), std::max(anchor_, current_));
    emit elements_taken(united(kept_, range));
}

void HistogramWidget::mousePressEvent(QMouseEvent* event) {
    const int bar = drawing_.bar_at(event->position());
    if (event->button() != Qt::LeftButton || bar == no_bar || !drawing_.has_data) return;
    // With Shift the range that is there is drawn on.
    if (anchor_ == no_bar || !event->modifiers().testFlag(Qt::ShiftModifier)) anchor_ = bar;
    current_ = bar;
    is_brushing_ = true;
    kept_ = event->modifiers().testFlag(Qt::ControlModifier) ? selected_ : IndexSet();
    update();
    take();
}

void HistogramWidget::mouseMoveEvent(QMouseEvent* event) {
    if (is_brushing_ && event->buttons().testFlag(Qt::LeftButton)) {
        const int bar = drawing_.nearest_bar(event->position().x());
        if (bar == current_) return;
        current_ = hovered_ = bar;
        update();
        take();
        tell_range(event->globalPosition().toPoint());
        return;
    }
    const int bar = drawing_.has_data ? drawing_.bar_at(event->position()) : no_bar;
    if (bar == hovered_) return;
    hovered_ = bar;
    update();
    if (bar == no_bar)
        QToolTip::hideText();
    else
        QToolTip::showText(event->globalPosition().toPoint(), describe(bar, bar), this);
}

void HistogramWidget::mouseReleaseEvent(QMouseEvent* event) {
    if (event->button() != Qt::LeftButton || !is_brushing_) return;
    is_brushing_ = false;
    update();
}

void HistogramWidget::leaveEvent(QEvent*) {
    hovered_ = no_bar;
    update();
}

}  // namespace curvewright
