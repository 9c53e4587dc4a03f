#include "ui/panels/histogram_drawing.h"

#include <algorithm>
#include <cmath>

#include <QCoreApplication>
#include <QPainter>
#include <QPainterPath>

#include "ui/document/number_format.h"
#include "ui/palette/quality_colors.h"

namespace curvewright {
namespace {

constexpr double left_margin = 40.0, right_margin = 8.0, top_margin = 18.0, bottom_margin = 22.0;
constexpr double alarm_gap = 8.0;
constexpr int selected_shade = 190;  ///< of QColor::darker

QColor to_qcolor(const Color& color) {
    return QColor::fromRgbF(float(color[0]), float(color[1]), float(color[2]));
}

/// Tick counts for a scale up to limit.
std::vector<Index> ticks(Index limit, bool is_logarithmic) {
    std::vector<Index> values;
    if (is_logarithmic) {
        for (Index value = 1; value <= limit && values.size() < 7; value *= 10) values.push_back(value);
    } else {
        const double rough = std::max(1.0, limit / 3.0);
        const double decade = std::pow(10.0, std::floor(std::log10(rough)));
        const double step = rough / decade < 2 ? decade : rough / decade < 5 ? 2 * decade : 5 * decade;
        for (double value = step; value <= limit; value += step) values.push_back(static_cast<Index>(value));
    }
    return values;
}

}  // namespace

HistogramInk screen_ink(const Theme& theme) {
    const auto color = [&theme](const char* name) { return theme.color(QLatin1String(name)); };
    return {color("window"),        color("text"),  color("text_muted"), color("border"),
            color("border_strong"), color("alarm"), color("accent_soft")};
}

HistogramInk paper_ink() {
    return {QColor(0xffffff), QColor(0x1b2026), QColor(0x59636f), QColor(0xd5d9df),
            QColor(0xb4bbc5), QColor(0xb3123b), QColor(0xdfebf7)};
}

QRectF HistogramDrawing::plot() const {
    return frame.adjusted(left_margin, top_margin, -right_margin, -bottom_margin);
}

QRectF HistogramDrawing::bar_area(int bar) const {
    const QRectF area = plot();
    const double width = (area.width() - alarm_gap) / (HistogramBars::bins + 2);  // the alarm bar is two bins wide
    if (bar < 0) return {area.left(), area.top(), 2 * width, area.height()};
    return {area.left() + (2 + bar) * width + alarm_gap, area.top(), width, area.height()};
}

int HistogramDrawing::bar_at(QPointF position) const {
    for (int bar = HistogramBars::tangled_bar; bar < HistogramBars::bins; ++bar)
        if (bar_area(bar).adjusted(0, 0, 0, bottom_margin).contains(position)) return bar;
    return HistogramBars::no_bar;
}

int HistogramDrawing::nearest_bar(double x) const {
    int bar = HistogramBars::bins - 1;
    while (bar > HistogramBars::tangled_bar && x < bar_area(bar).left()) --bar;
    // In the gap: the nearer one.
    if (bar == HistogramBars::tangled_bar && x > bar_area(bar).right() + 0.5 * alarm_gap) ++bar;
    return bar;
}

double HistogramDrawing::height_of(Index count) const {
    if (count <= 0) return 0.0;
    const double fraction = is_logarithmic ? std::log1p(count) / std::log1p(limit) : double(count) / limit;
    return std::min(1.0, fraction);
}

void HistogramDrawing::draw(QPainter& painter, const HistogramInk& ink) const {
    painter.setFont(font);
    if (band_last >= band_first) {
        const QRectF first = bar_area(band_first), last = bar_area(band_last);
        painter.fillRect(QRectF(first.topLeft(), last.bottomRight()), ink.band);
    }
    draw_scale(painter, ink);
    for (int bar = HistogramBars::tangled_bar; bar < HistogramBars::bins; ++bar) draw_bar(painter, ink, bar);
    if (outline) draw_outline(painter, ink);
    draw_axis(painter, ink);
    const QRectF area = plot();
    painter.setPen(ink.text);
    painter.drawText(QRectF(area.left(), frame.top(), area.width(), top_margin - 2), Qt::AlignLeft | Qt::AlignVCenter,
                     title);
    if (has_data) return;
    painter.setPen(ink.muted);
    painter.drawText(area, Qt::AlignCenter,
                     QCoreApplication::translate("curvewright::HistogramWidget", "no quality to show"));
}

void HistogramDrawing::draw_scale(QPainter& painter, const HistogramInk& ink) const {
    const QRectF area = plot();
    for (const Index value : has_data ? ticks(limit, is_logarithmic) : std::vector<Index>()) {
        const double y = std::round(area.bottom() - height_of(value) * area.height()) + 0.5;
        painter.setPen(ink.line);
        painter.drawLine(QPointF(area.left(), y), QPointF(area.right(), y));
        painter.setPen(ink.muted);
        const QString text = value >= 10000 ? QStringLiteral("%1k").arg(value / 1000) : format_count(value);
        painter.drawText(QRectF(frame.left(), y - 8, left_margin - 6, 16), Qt::AlignRight | Qt::AlignVCenter, text);
    }
    painter.setPen(ink.base);
    const double base = std::round(area.bottom()) + 0.5;
    painter.drawLine(QPointF(bar_area(-1).left(), base), QPointF(bar_area(-1).right(), base));
    painter.drawLine(QPointF(bar_area(0).left(), base), QPointF(area.right(), base));
}

void HistogramDrawing::draw_bar(QPainter& painter, const HistogramInk& ink, int bar) const {
    const HistogramBars::Bar& content = bars.at(bar);
    if (content.count() == 0) return;
    const QRectF area = plot();
    QRectF box = bar_area(bar).adjusted(0.5, 0, -0.5, 0);
    const double height = std::max(2.0, height_of(content.count()) * area.height());
    box.setTop(area.bottom() - height);
    const QColor color = to_qcolor(bar < 0 ? tangled_color() : colors.color_of((bar + 0.5) / HistogramBars::bins));
    painter.fillRect(box, color);
    if (content.undecided > 0) {
        QRectF part = box;
        part.setHeight(height * content.undecided / content.count());
        painter.fillRect(part, to_qcolor(undecided_color()));
    }
    if (content.selected > 0) {
        // Read on the same scale as the bar; with an edge, so that it is not told by its shade alone.
        QRectF part = box;
        part.setTop(area.bottom() - std::clamp(height_of(content.selected) * area.height(), 2.0, height));
        painter.fillRect(part, color.darker(selected_shade));
        painter.fillRect(QRectF(part.left(), part.top(), part.width(), 1.5), ink.text);
    }
    // A thin outline keeps the light end of the map visible on a light ground.
    painter.setPen(bar == marked_bar ? ink.text : QColor(128, 136, 146, 150));
    painter.setBrush(Qt::NoBrush);
    painter.drawRect(box.adjusted(0, 0, -0.5, 0));
}

void HistogramDrawing::draw_outline(QPainter& painter, const HistogramInk& ink) const {
    const QRectF area = plot();
    const auto top_of = [&](int bar) {
        const Index count = outline->at(bar).count();
        return area.bottom() - (count == 0 ? 0.0 : std::max(2.0, height_of(count) * area.height()));
    };
    QPainterPath path;
    const QRectF alarm = bar_area(HistogramBars::tangled_bar);
    if (outline->tangled.count() > 0) {
        path.moveTo(alarm.left(), area.bottom());
        path.lineTo(alarm.left(), top_of(-1));
        path.lineTo(alarm.right(), top_of(-1));
        path.lineTo(alarm.right(), area.bottom());
    }
    bool is_down = true;
    for (int bar = 0; bar < HistogramBars::bins; ++bar) {
        const QRectF its = bar_area(bar);
        if (outline->at(bar).count() == 0) {
            if (!is_down) path.lineTo(its.left(), area.bottom());
            is_down = true;
            continue;
        }
        if (is_down) path.moveTo(its.left(), area.bottom());
        is_down = false;
        path.lineTo(its.left(), top_of(bar));
        path.lineTo(its.right(), top_of(bar));
    }
    if (!is_down) path.lineTo(area.right(), area.bottom());
    painter.setBrush(Qt::NoBrush);
    // Legible on bars of every colour.
    for (const QPen& pen : {QPen(ink.ground, 3.5), QPen(ink.text, 1.5)}) {
        painter.setPen(pen);
        painter.drawPath(path);
    }
}

void HistogramDrawing::draw_axis(QPainter& painter, const HistogramInk& ink) const {
    const QRectF area = plot();
    painter.setPen(bars.tangled.count() > 0 ? ink.alarm : ink.muted);
    painter.drawText(QRectF(bar_area(-1).center().x() - 24, area.bottom() + 7, 48, 14), Qt::AlignCenter,
                     QStringLiteral("≤ 0"));
    painter.setPen(ink.muted);
    const double first = bar_area(0).left(), width = area.right() - first;
    for (const double value : {0.25, 0.5, 0.75, 1.0}) {
        const double x = first + value * width;
        const QRectF box(std::min(x - 24, frame.right() - 48), area.bottom() + 7, 48, 14);
        painter.drawText(box, value == 1.0 ? Qt::AlignRight | Qt::AlignVCenter : Qt::AlignCenter,
                         QString::number(value, 'g', 3));
    }
    if (!has_data || !least || !(*least > 0.0)) return;
    // The smallest value, as a tick under the axis.
    const double x = first + std::min(1.0, *least) * width;
    painter.save();
    painter.setRenderHint(QPainter::Antialiasing);
    painter.setPen(Qt::NoPen);
    painter.setBrush(ink.text);
    painter.drawPolygon(
        QPolygonF({{x, area.bottom() + 1.0}, {x - 3.5, area.bottom() + 7.0}, {x + 3.5, area.bottom() + 7.0}}));
    painter.restore();
}

}  // namespace curvewright
