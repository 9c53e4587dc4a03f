#include "ui/panels/timeline_track.h"

#include <algorithm>
#include <cmath>

#include <QHelpEvent>
#include <QKeyEvent>
#include <QMouseEvent>
#include <QPainter>
#include <QToolTip>

#include "ui/document/number_format.h"

namespace curvewright {
namespace {

constexpr double left_margin = 50.0, right_margin = 54.0;
constexpr double ruler_height = 16.0, row_height = 14.0, top_of_plot = ruler_height + 2 * row_height + 5.0;
constexpr double bottom_margin = 4.0;
constexpr double shortest_stretch = 8.0;  // steps

QString step_count_text(StepNumber step) {
    return format_count(static_cast<long long>(step));
}

}  // namespace

TimelineTrack::TimelineTrack(StepPlayer& player, const Theme& theme, QWidget* parent)
    : QWidget(parent), player_(player), theme_(theme) {
    setObjectName(QStringLiteral("timeline_track"));
    setAccessibleName(tr("Timeline"));
    setFocusPolicy(Qt::StrongFocus);
    setMouseTracking(true);
    setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Expanding);
    connect(&theme, &Theme::changed, this, qOverload<>(&QWidget::update));
    connect(&player, &StepPlayer::opened_changed, this, [this](bool is_open) {
        curve_ = is_open ? TimelineCurve(player_.recording()) : TimelineCurve();
        show_all();
    });
    connect(&player, &StepPlayer::step_changed, this, [this] {
        follow();
        update();
    });
    connect(&player, &StepPlayer::breakpoints_changed, this, qOverload<>(&QWidget::update));
}

StepNumber TimelineTrack::last_step() const {
    return player_.recording()->step_count() - 1;
}

QRectF TimelineTrack::plot() const {
    return QRectF(rect()).adjusted(left_margin, top_of_plot, -right_margin, -bottom_margin);
}

double TimelineTrack::pixels_per_step() const {
    return std::max(1.0, plot().width()) / length_;
}

double TimelineTrack::x_of(StepNumber step) const {
    return plot().left() + (step + 0.5 - first_) * pixels_per_step();
}

StepNumber TimelineTrack::step_at(double x) const {
    const double step = std::floor(first_ + (x - plot().left()) / pixels_per_step());
    return static_cast<StepNumber>(std::clamp(step, 0.0, static_cast<double>(last_step())));
}

void TimelineTrack::set_stretch(double first, double length) {
    if (!player_.is_open()) return;
    const double all = player_.recording()->step_count();
    length_ = std::clamp(length, std::min(all, shortest_stretch), all);
    first_ = std::clamp(first, 0.0, all - length_);
    update();
}

void TimelineTrack::show_all() {
    if (player_.is_open()) set_stretch(0.0, player_.recording()->step_count());
    update();
}

void TimelineTrack::zoom(double factor, double x) {
    const double at = (std::clamp(x, plot().left(), plot().right()) - plot().left()) / std::max(1.0, plot().width());
    const double step = first_ + at * length_;
    const double length =
        std::clamp(length_ / factor, shortest_stretch, std::max(shortest_stretch, double(last_step()) + 1.0));
    set_stretch(step - at * length, length);
}

void TimelineTrack::follow() {
    const double step = player_.shown().step;
    if (is_scrubbing_ || (step >= first_ && step < first_ + length_)) return;
    // A page on, with a little of what was seen.
    set_stretch(step > first_ ? step - 0.1 * length_ : step - 0.9 * length_, length_);
}

double TimelineTrack::y_of_jacobian(double value) const {
    const auto& all = curve_.whole();
    const double low = std::min(0.0, static_cast<double>(all.least)), high = std::max(0.1, double(all.most));
    const QRectF area = plot();
    return area.bottom() - 2.0 - (value - low) / (high - low) * (area.height() - 5.0);
}

double TimelineTrack::y_of_count(Index count) const {
    const QRectF area = plot();
    return area.bottom() - 2.0 - count / std::max(1.0, double(curve_.whole().many)) * (area.height() - 5.0);
}

void TimelineTrack::paintEvent(QPaintEvent*) {
    QPainter painter(this);
    painter.setFont(Theme::small_font());
    if (player_.is_open()) {
        painter.fillRect(plot().adjusted(0, 0, 0, 1), theme_.color(QStringLiteral("surface")));
        painter.save();
        painter.setClipRect(QRectF(plot().left(), 0, plot().width(), height()));
        paint_ruler(painter);
        paint_passes(painter);
        paint_patches(painter);
        painter.restore();
        paint_scales(painter);
        painter.save();
        painter.setClipRect(QRectF(plot().left() - 6, 0, plot().width() + 12, height()));
        paint_curves(painter);
        paint_marks(painter);
        painter.restore();
    }
    if (!hasFocus()) return;
    painter.setPen(theme_.color(QStringLiteral("accent")));
    painter.setBrush(Qt::NoBrush);
    painter.drawRoundedRect(QRectF(rect()).adjusted(0.5, 0.5, -0.5, -0.5), 4, 4);
}

void TimelineTrack::paint_ruler(QPainter& painter) const {
    const double rough = 80.0 / pixels_per_step();
    const double decade = std::pow(10.0, std::floor(std::log10(std::max(1.0, rough))));
    const double apart = std::max(1.0, rough <= decade       ? decade
                                       : rough <= 2 * decade ? 2 * decade
                                       : rough <= 5 * decade ? 5 * decade
                                                             : 10 * decade);
    for (double step = std::ceil(first_ / apart) * apart; step <= std::min(first_ + length_, double(last_step()));
         step += apart) {
        const double x = std::round(x_of(static_cast<StepNumber>(step))) + 0.5;
        painter.setPen(theme_.color(QStringLiteral("border_strong")));
        painter.drawLine(QPointF(x, ruler_height - 4), QPointF(x, ruler_height));
        painter.setPen(theme_.color(QStringLiteral("text_muted")));
        const QRectF box(std::clamp(x - 40, plot().left(), plot().right() - 80), 1, 80, ruler_height - 4);
        const int side = box.left() > x - 40 ? Qt::AlignLeft : box.left() < x - 40 ? Qt::AlignRight : Qt::AlignHCenter;
        painter.drawText(box, side | Qt::AlignVCenter, step_count_text(static_cast<StepNumber>(step)));
    }
}

void TimelineTrack::paint_span(QPainter& painter, QRectF box, std::size_t number, const QString& text) const {
    painter.fillRect(box, theme_.color(number % 2 ? QStringLiteral("accent_soft") : QStringLiteral("pressed")));
    const QRectF seen = box.intersected(QRectF(plot().left(), 0, plot().width(), height()));
    if (painter.fontMetrics().horizontalAdvance(text) + 6 > seen.width()) return;
    painter.setPen(theme_.color(QStringLiteral("text")));
    painter.drawText(seen, Qt::AlignCenter, text);
}

void TimelineTrack::paint_passes(QPainter& painter) const {
    const auto passes = player_.recording()->passes();
    const double unit = pixels_per_step();
    for (std::size_t i = 0; i < passes.size(); ++i) {
        const double left = x_of(passes[i].first) - 0.5 * unit, right = x_of(passes[i].last) + 0.5 * unit;
        if (right < plot().left() || left > plot().right()) continue;
        const QRectF box(left, ruler_height, std::max(1.0, right - left), row_height - 1);
        const QString number = QString::number(passes[i].number), full = tr("pass %1").arg(number);
        const bool has_room = painter.fontMetrics().horizontalAdvance(full) + 6 <= box.width();
        paint_span(painter, box, i, has_room ? full : number);
    }
}

void TimelineTrack::paint_patches(QPainter& painter) const {
    const auto patches = player_.recording()->patches();
    const double unit = pixels_per_step(), top = ruler_height + row_height;
    const double end = first_ + length_;
    auto patch = std::partition_point(patches.begin(), patches.end(),
                                      [&](const RecordedPatch& p) { return p.last + 1.0 < first_; });
    while (patch != patches.end() && patch->first < end) {
        const double left = x_of(patch->first) - 0.5 * unit, right = x_of(patch->last) + 0.5 * unit;
        if (right - left >= 2.0) {
            paint_span(painter, {left, top, right - left, row_height - 1}, patch->number,
                       QString::number(patch->number));
            ++patch;
            continue;
        }
        // Too many to be told apart: a column for those in it.
        painter.fillRect(QRectF(left, top, 2.0, row_height - 1), theme_.color(QStringLiteral("border_strong")));
        const double beyond = first_ + (left + 2.0 - plot().left()) / unit;
        patch = std::partition_point(patch + 1, patches.end(),
                                     [&](const RecordedPatch& p) { return p.last + 1.0 < beyond; });
    }
}

void TimelineTrack::paint_scales(QPainter& painter) const {
    const QRectF area = plot();
    const auto& all = curve_.whole();
    const QColor jacobian = theme_.color(QStringLiteral("accent")), count = theme_.color(QStringLiteral("alarm"));
    painter.setPen(theme_.color(QStringLiteral("border_strong")));
    const double zero = std::round(y_of_jacobian(0.0)) + 0.5;
    painter.drawLine(QPointF(area.left(), zero), QPointF(area.right(), zero));
    painter.setPen(jacobian);
    const auto left = [&](double value, double y) {
        painter.drawText(QRectF(0, std::clamp(y - 7, area.top() - 2, area.bottom() - 12), left_margin - 5, 14),
                         Qt::AlignRight | Qt::AlignVCenter, value == 0.0 ? QStringLiteral("0") : short_number(value));
    };
    const double high = std::max(0.1, double(all.most)), low = std::min(0.0, double(all.least));
    left(high, y_of_jacobian(high));
    if (y_of_jacobian(0.0) - y_of_jacobian(high) > 13) left(0.0, y_of_jacobian(0.0));
    if (low < 0.0 && y_of_jacobian(low) - y_of_jacobian(0.0) > 13) left(low, y_of_jacobian(low));
    painter.drawText(QRectF(0, ruler_height + row_height, left_margin - 5, row_height),
                     Qt::AlignRight | Qt::AlignVCenter, tr("min J"));
    painter.setPen(count);
    const auto right = [&](Index value) {
        painter.drawText(QRectF(area.right() + 5, std::clamp(y_of_count(value) - 7, area.top() - 2, area.bottom() - 12),
                                right_margin - 6, 14),
                         Qt::AlignLeft | Qt::AlignVCenter,
                         value >= 10000 ? QStringLiteral("%1k").arg(value / 1000) : format_count(value));
    };
    if (all.many > 0) right(all.many);
    right(0);
    painter.drawText(QRectF(area.right() + 5, ruler_height + row_height, right_margin - 5, row_height),
                     Qt::AlignLeft | Qt::AlignVCenter, tr("tangled", "short, above the scale of a curve"));
}

void TimelineTrack::paint_curves(QPainter& painter) const {
    const QRectF area = plot();
    const double unit = pixels_per_step();
    QPolygonF jacobian, count;
    const auto add = [](QPolygonF& line, double x, double from, double to) {
        line << QPointF(x, from);
        if (to != from) line << QPointF(x, to);
    };
    for (double x = std::floor(area.left()); x <= area.right(); x += 1.0) {
        const double from = first_ + (x - area.left()) / unit, to = first_ + (x + 1.0 - area.left()) / unit;
        if (from > last_step()) break;
        const StepNumber a = step_at(x),
                         b = std::max(a, to >= last_step() ? last_step() : StepNumber(std::max(0.0, to)));
        const TimelineCurve::Range range = curve_.over(a, b);
        // Up and down within the column: the end that is nearer to the column before comes first.
        const auto order = [](const QPolygonF& line, double& one, double& other) {
            if (!line.isEmpty() && std::abs(line.last().y() - other) < std::abs(line.last().y() - one))
                std::swap(one, other);
        };
        double low = y_of_jacobian(range.least), high = y_of_jacobian(range.most);
        order(jacobian, low, high);
        add(jacobian, x + 0.5, low, high);
        double few = y_of_count(range.fewest), many = y_of_count(range.many);
        order(count, few, many);
        add(count, x + 0.5, few, many);
    }
    painter.setBrush(Qt::NoBrush);
    QPen pen(theme_.color(QStringLiteral("alarm")), 1.0);
    pen.setDashPattern({4.0, 3.0});
    pen.setCapStyle(Qt::FlatCap);
    painter.setPen(pen);
    painter.drawPolyline(count);
    painter.setPen(QPen(theme_.color(QStringLiteral("accent")), 1.5));
    painter.setRenderHint(QPainter::Antialiasing);
    painter.drawPolyline(jacobian);
    painter.setRenderHint(QPainter::Antialiasing, false);
}

void TimelineTrack::paint_marks(QPainter& painter) const {
    const QRectF area = plot();
    painter.setRenderHint(QPainter::Antialiasing);
    const auto& breaks = player_.break_steps();
    double last = -10.0;
    painter.setPen(Qt::NoPen);
    painter.setBrush(theme_.color(QStringLiteral("warning")));
    for (auto step = std::lower_bound(breaks.begin(), breaks.end(), static_cast<StepNumber>(first_));
         step != breaks.end() && *step <= first_ + length_; ++step) {
        const double x = x_of(*step);
        if (x < last + 2.0) continue;
        last = x;
        const double y = ruler_height - 3.0;
        painter.drawPolygon(QPolygonF({{x, y - 4}, {x + 4, y}, {x, y + 4}, {x - 4, y}}));
        painter.fillRect(QRectF(x - 0.5, y, 1.0, area.bottom() - y), QColor(theme_.color(QStringLiteral("warning"))));
    }
    const double x = x_of(player_.shown().step);
    painter.setBrush(theme_.color(QStringLiteral("text")));
    painter.drawPolygon(QPolygonF({{x - 5, 1}, {x + 5, 1}, {x + 5, 7}, {x, 13}, {x - 5, 7}}));
    painter.setRenderHint(QPainter::Antialiasing, false);
    painter.fillRect(QRectF(std::round(x) - 0.5, 10, 1.0, area.bottom() - 9), theme_.color(QStringLiteral("text")));
}

QString TimelineTrack::describe(QPointF position) const {
    if (!player_.is_open() || position.x() < plot().left() || position.x() > plot().right()) return {};
    const Recording& recording = *player_.recording();
    const StepNumber step = step_at(position.x());
    QStringList text;
    if (const auto pass = recording.pass_of(step)) text << tr("Pass %1").arg(recording.passes()[*pass].number);
    if (const auto patch = recording.patch_of(step)) {
        const RecordedPatch& its = recording.patches()[*patch];
        text << tr("patch %1: min J %2 → %3")
                    .arg(format_count(its.number), format_number(its.min_before), format_number(its.min_after));
    }
    const QualityPoint& point = recording.quality_at(step);
    text << tr("step %1").arg(step_count_text(step));
    return text.join(QStringLiteral(", ")) + QLatin1Char('\n') +
           tr("min J of the mesh %1, %2 elements not valid")
               .arg(format_number(point.min_scaled_jacobian), format_count(point.not_valid));
}

void TimelineTrack::mousePressEvent(QMouseEvent* event) {
    if (!player_.is_open()) return;
    if (event->button() == Qt::LeftButton) {
        is_scrubbing_ = true;
        player_.go_to(step_at(event->position().x()));
    } else if (event->button() == Qt::MiddleButton) {
        panned_at_ = event->position().x();
        setCursor(Qt::ClosedHandCursor);
    }
}

void TimelineTrack::mouseMoveEvent(QMouseEvent* event) {
    if (!player_.is_open()) return;
    const double x = event->position().x();
    if (is_scrubbing_) {
        if (step_at(x) != player_.step()) player_.go_to(step_at(x));
    } else if (panned_at_) {
        set_stretch(first_ - (x - *panned_at_) / pixels_per_step(), length_);
        panned_at_ = x;
    }
}

void TimelineTrack::mouseReleaseEvent(QMouseEvent*) {
    is_scrubbing_ = false;
    panned_at_.reset();
    unsetCursor();
}

void TimelineTrack::mouseDoubleClickEvent(QMouseEvent* event) {
    if (!player_.is_open() || event->button() != Qt::LeftButton) return;
    const Recording& recording = *player_.recording();
    const StepNumber step = step_at(event->position().x());
    const auto show = [this](double first, double last) {
        // What is seen as a whole already: back to everything.
        const double margin = 0.04 * (last - first + 1.0), length = last - first + 1.0 + 2.0 * margin;
        if (std::abs(first_ - std::max(0.0, first - margin)) < 1.0 && std::abs(length_ - length) < 1.0 + margin)
            show_all();
        else
            set_stretch(first - margin, length);
    };
    const auto pass = recording.pass_of(step);
    const auto patch = recording.patch_of(step);
    const bool is_pass_row = event->position().y() < ruler_height + row_height;
    if (patch && !is_pass_row)
        show(recording.patches()[*patch].first, recording.patches()[*patch].last);
    else if (pass)
        show(recording.passes()[*pass].first, recording.passes()[*pass].last);
    else
        show_all();
}

void TimelineTrack::wheelEvent(QWheelEvent* event) {
    event->accept();
    if (!player_.is_open()) return;
    const double notches = (event->angleDelta().y() + event->angleDelta().x()) / 120.0;
    if (event->modifiers() & Qt::ShiftModifier)
        set_stretch(first_ - 0.1 * notches * length_, length_);
    else
        zoom(std::pow(1.25, notches), event->position().x());
}

void TimelineTrack::keyPressEvent(QKeyEvent* event) {
    switch (player_.is_open() ? event->key() : 0) {
        case Qt::Key_Left:
            return player_.step_by(-1);
        case Qt::Key_Right:
            return player_.step_by(1);
        case Qt::Key_Down:
            return player_.step_into();
        case Qt::Key_Up:
            return player_.step_out();
        case Qt::Key_Home:
            return player_.go_to(0);
        case Qt::Key_End:
            return player_.go_to(last_step());
        case Qt::Key_PageUp:
            return zoom(1.25, x_of(player_.shown().step));
        case Qt::Key_PageDown:
            return zoom(0.8, x_of(player_.shown().step));
        default:
            QWidget::keyPressEvent(event);
    }
}

bool TimelineTrack::event(QEvent* event) {
    if (event->type() == QEvent::ShortcutOverride) {
        // Home fits the view elsewhere.
        const int key = static_cast<QKeyEvent*>(event)->key();
        const bool is_own = key == Qt::Key_Home || key == Qt::Key_End || key == Qt::Key_Space;
        if (is_own && static_cast<QKeyEvent*>(event)->modifiers() == Qt::NoModifier) event->accept();
    }
    if (event->type() == QEvent::ToolTip) {
        auto* help = static_cast<QHelpEvent*>(event);
        QToolTip::showText(help->globalPos(), describe(help->pos()), this);
        return true;
    }
    return QWidget::event(event);
}

}  // namespace curvewright
