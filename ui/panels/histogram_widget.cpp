#include "ui/panels/histogram_widget.h"

#include <algorithm>
#include <cmath>

#include <QHelpEvent>
#include <QKeyEvent>
#include <QMouseEvent>
#include <QPainter>
#include <QToolTip>

#include "ui/document/number_format.h"
#include "ui/palette/quality_colors.h"

namespace curvewright {
namespace {

constexpr double left_margin = 36.0, right_margin = 8.0, top_margin = 6.0, bottom_margin = 22.0;
constexpr double alarm_gap = 8.0;

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

Index HistogramBars::highest() const {
    Index result = tangled.count();
    for (const Bar& bar : bars) result = std::max(result, bar.count());
    return result;
}

HistogramBars make_bars(const QualityReport& report) {
    HistogramBars result;
    result.bars.resize(HistogramBars::bins);
    for (std::size_t element = 0; element < report.elements.size(); ++element) {
        const ElementQuality& quality = report.elements[element];
        const auto id = static_cast<Index>(element);
        if (quality.validity == Validity::invalid) {
            result.tangled.decided.push_back(id);
            continue;
        }
        const int position = static_cast<int>(quality.scaled_jacobian * HistogramBars::bins);
        auto& bar = result.bars[static_cast<std::size_t>(std::clamp(position, 0, HistogramBars::bins - 1))];
        (quality.validity == Validity::undecided ? bar.undecided : bar.decided).push_back(id);
    }
    return result;
}

HistogramWidget::HistogramWidget(const Theme& theme, QWidget* parent) : QWidget(parent), theme_(theme) {
    bars_.bars.resize(HistogramBars::bins);
    setMouseTracking(true);
    setFocusPolicy(Qt::StrongFocus);
    setAccessibleName(tr("Histogram of the scaled Jacobian"));
    setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Expanding);
    connect(&theme, &Theme::changed, this, qOverload<>(&QWidget::update));
}

void HistogramWidget::set_report(std::shared_ptr<const QualityReport> report) {
    if (report == report_) return;
    report_ = std::move(report);
    if (report_) {
        bars_ = make_bars(*report_);
    } else {
        bars_ = {};
        bars_.bars.resize(HistogramBars::bins);
    }
    update();
}

void HistogramWidget::set_scale(Index limit, bool is_logarithmic) {
    if (limit == limit_ && is_logarithmic == is_logarithmic_) return;
    limit_ = std::max<Index>(1, limit);
    is_logarithmic_ = is_logarithmic;
    update();
}

void HistogramWidget::set_colors(const ColorScale& colors) {
    if (colors == colors_) return;
    colors_ = colors;
    update();
}

QRectF HistogramWidget::plot() const {
    return QRectF(rect()).adjusted(left_margin, top_margin, -right_margin, -bottom_margin);
}

QRectF HistogramWidget::bar_area(int index) const {
    const QRectF area = plot();
    const double width = (area.width() - alarm_gap) / (HistogramBars::bins + 2);  // the alarm bar is two bins wide
    if (index < 0) return {area.left(), area.top(), 2 * width, area.height()};
    return {area.left() + (2 + index) * width + alarm_gap, area.top(), width, area.height()};
}

int HistogramWidget::bar_at(QPointF position) const {
    for (int index = -1; index < HistogramBars::bins; ++index)
        if (bar_area(index).adjusted(0, 0, 0, bottom_margin).contains(position)) return index;
    return -2;
}

double HistogramWidget::height_of(Index count) const {
    if (count <= 0) return 0.0;
    const double fraction = is_logarithmic_ ? std::log1p(count) / std::log1p(limit_) : double(count) / limit_;
    return std::min(1.0, fraction);
}

void HistogramWidget::paintEvent(QPaintEvent*) {
    QPainter painter(this);
    const QRectF area = plot();
    const QColor muted = theme_.color(QStringLiteral("text_muted")), line = theme_.color(QStringLiteral("border"));
    painter.setFont(Theme::small_font());

    for (const Index value : report_ ? ticks(limit_, is_logarithmic_) : std::vector<Index>()) {
        const double y = std::round(area.bottom() - height_of(value) * area.height()) + 0.5;
        painter.setPen(line);
        painter.drawLine(QPointF(area.left(), y), QPointF(area.right(), y));
        painter.setPen(muted);
        const QString text = value >= 10000 ? QStringLiteral("%1k").arg(value / 1000) : format_count(value);
        painter.drawText(QRectF(0, y - 8, left_margin - 6, 16), Qt::AlignRight | Qt::AlignVCenter, text);
    }
    painter.setPen(theme_.color(QStringLiteral("border_strong")));
    const double base = std::round(area.bottom()) + 0.5;
    painter.drawLine(QPointF(bar_area(-1).left(), base), QPointF(bar_area(-1).right(), base));
    painter.drawLine(QPointF(bar_area(0).left(), base), QPointF(area.right(), base));

    for (int index = -1; index < HistogramBars::bins; ++index) {
        const HistogramBars::Bar& content = bar(index);
        if (content.count() == 0) continue;
        QRectF box = bar_area(index).adjusted(0.5, 0, -0.5, 0);
        const double height = std::max(2.0, height_of(content.count()) * area.height());
        box.setTop(area.bottom() - height);
        const Color color = index < 0 ? tangled_color() : colors_.color_of((index + 0.5) / HistogramBars::bins);
        painter.fillRect(box, to_qcolor(color));
        if (!content.undecided.empty()) {
            QRectF part = box;
            part.setHeight(height * static_cast<double>(content.undecided.size()) / content.count());
            painter.fillRect(part, to_qcolor(undecided_color()));
        }
        // A thin outline keeps the light end of the map visible on a light ground.
        const bool is_marked = index == hovered_ || (hasFocus() && index == current_);
        painter.setPen(is_marked ? theme_.color(QStringLiteral("text")) : QColor(128, 136, 146, 150));
        painter.setBrush(Qt::NoBrush);
        painter.drawRect(box.adjusted(0, 0, -0.5, 0));
    }

    painter.setPen(bars_.tangled.count() > 0 ? theme_.color(QStringLiteral("alarm")) : muted);
    const QRectF alarm = bar_area(-1);
    painter.drawText(QRectF(alarm.center().x() - 24, area.bottom() + 7, 48, 14), Qt::AlignCenter,
                     QStringLiteral("≤ 0"));
    painter.setPen(muted);
    const double first = bar_area(0).left(), width = area.right() - first;
    for (const double value : {0.25, 0.5, 0.75, 1.0}) {
        const double x = first + value * width;
        const QRectF box(std::min(x - 24, double(this->width()) - 48), area.bottom() + 7, 48, 14);
        painter.drawText(box, value == 1.0 ? Qt::AlignRight | Qt::AlignVCenter : Qt::AlignCenter,
                         QString::number(value, 'g', 3));
    }
    if (hasFocus()) {
        painter.setPen(theme_.color(QStringLiteral("accent")));
        painter.setBrush(Qt::NoBrush);
        painter.drawRoundedRect(QRectF(rect()).adjusted(0.5, 0.5, -0.5, -0.5), 4, 4);
    }
    if (!report_) {
        painter.setPen(theme_.color(QStringLiteral("text_disabled")));
        painter.drawText(area, Qt::AlignCenter, tr("no quality to show"));
    } else if (report_->summary.min > 0.0) {
        // The smallest value, as a tick under the axis.
        const double x = first + std::min(1.0, report_->summary.min) * width;
        painter.setRenderHint(QPainter::Antialiasing);
        painter.setPen(Qt::NoPen);
        painter.setBrush(theme_.color(QStringLiteral("text")));
        painter.drawPolygon(
            QPolygonF({{x, area.bottom() + 1.0}, {x - 3.5, area.bottom() + 7.0}, {x + 3.5, area.bottom() + 7.0}}));
    }
}

QString HistogramWidget::describe(int index) const {
    const QString count =
        bar(index).count() == 1 ? tr("1 element") : tr("%1 elements").arg(format_count(bar(index).count()));
    const QString range = index < 0 ? tr("tangled (scaled Jacobian ≤ 0)")
                                    : tr("scaled Jacobian %1 to %2")
                                          .arg(double(index) / HistogramBars::bins, 0, 'f', 2)
                                          .arg(double(index + 1) / HistogramBars::bins, 0, 'f', 2);
    return count + QStringLiteral(", ") + range;
}

int HistogramWidget::next_bar(int index, int step) const {
    for (int next = index + step; next >= -1 && next < HistogramBars::bins; next += step)
        if (bar(next).count() > 0) return next;
    return index;
}

void HistogramWidget::go_to(int index) {
    current_ = index;
    update();
    if (index == -2) return;
    const QRectF area = bar_area(index);
    QToolTip::showText(mapToGlobal(QPointF(area.center().x(), area.bottom()).toPoint()), describe(index), this);
}

void HistogramWidget::keyPressEvent(QKeyEvent* event) {
    switch (event->key()) {
        case Qt::Key_Left:
            go_to(next_bar(current_, -1));
            break;
        case Qt::Key_Right:
            go_to(next_bar(current_, 1));
            break;
        case Qt::Key_Home:
            go_to(next_bar(-2, 1));
            break;
        case Qt::Key_End:
            go_to(next_bar(HistogramBars::bins, -1));
            break;
        case Qt::Key_Return:
        case Qt::Key_Enter:
        case Qt::Key_Space:
            if (current_ != -2) choose(current_);
            break;
        default:
            QWidget::keyPressEvent(event);
    }
}

void HistogramWidget::focusInEvent(QFocusEvent* event) {
    // The worst first, unless the keyboard was here before; a click says itself where it is.
    if (current_ == -2 || bar(current_).count() == 0) current_ = next_bar(-2, 1);
    if (event->reason() == Qt::MouseFocusReason)
        update();
    else
        go_to(current_);
}

void HistogramWidget::focusOutEvent(QFocusEvent*) {
    QToolTip::hideText();
    update();
}

void HistogramWidget::mousePressEvent(QMouseEvent* event) {
    const int index = bar_at(event->position());
    if (event->button() != Qt::LeftButton || index == -2) return;
    current_ = index;
    choose(index);
}

void HistogramWidget::choose(int index) {
    std::vector<Index> elements = bar(index).decided;
    elements.insert(elements.end(), bar(index).undecided.begin(), bar(index).undecided.end());
    emit bar_clicked(elements);
}

void HistogramWidget::mouseMoveEvent(QMouseEvent* event) {
    const int index = report_ ? bar_at(event->position()) : -2;
    if (index == hovered_) return;
    hovered_ = index;
    update();
    if (index == -2) {
        QToolTip::hideText();
        return;
    }
    QToolTip::showText(event->globalPosition().toPoint(), describe(index), this);
}

void HistogramWidget::leaveEvent(QEvent*) {
    hovered_ = -2;
    update();
}

}  // namespace curvewright
