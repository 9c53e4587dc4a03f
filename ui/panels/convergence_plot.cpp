#include "ui/panels/convergence_plot.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <QHelpEvent>
#include <QMouseEvent>
#include <QPainter>
#include <QPainterPath>
#include <QToolTip>

#include "ui/document/number_format.h"

namespace curvewright {

namespace {

constexpr double left_margin = 62.0, right_margin = 8.0, top_margin = 18.0, bottom_margin = 6.0;

}  // namespace

ConvergencePlot::ConvergencePlot(const Theme& theme, QWidget* parent) : QWidget(parent), theme_(theme) {
    setObjectName(QStringLiteral("convergence_plot"));
    setAccessibleName(tr("Course of the iteration"));
    setCursor(Qt::PointingHandCursor);
    connect(&theme, &Theme::changed, this, qOverload<>(&QWidget::update));
}

void ConvergencePlot::clear() {
    course_.clear();
    series_.clear();
    update();
}

void ConvergencePlot::show_course(const StepExplanation& step) {
    course_ = step.convergence;
    series_.clear();
    const auto values = [this](const auto& of_point) {
        std::vector<double> result;
        for (const ConvergencePoint& point : course_) result.push_back(of_point(point));
        return result;
    };
    if (step.method == UntangleMethod::signed_angles) {
        series_ = {{tr("objective"), false, values([](const auto& p) { return p.objective; })},
                   {tr("its angle term"), true, values([](const auto& p) { return p.second; })}};
    } else if (step.method == UntangleMethod::unsigned_angles) {
        series_ = {{tr("sum of the angles (°)"), false,
                    values([](const auto& p) { return p.objective * 180.0 / std::numbers::pi; })}};
    } else if (step.method == UntangleMethod::guaranteed) {
        series_ = {{tr("least determinant"), false, values([](const auto& p) { return p.first; })},
                   {tr("ε"), true, values([](const auto& p) { return p.second; })}};
    }
    lower_ = std::numeric_limits<double>::infinity();
    upper_ = -lower_;
    for (const Series& series : series_)
        for (const double value : series.values) {
            if (!std::isfinite(value)) continue;
            lower_ = std::min(lower_, value);
            upper_ = std::max(upper_, value);
        }
    if (!(lower_ <= upper_)) lower_ = 0.0, upper_ = 1.0;
    is_logarithmic_ = lower_ > 0.0 && upper_ > 30.0 * lower_;
    if (!is_logarithmic_) {
        if (step.method == UntangleMethod::guaranteed) {
            lower_ = std::min(lower_, 0.0);
            upper_ = std::max(upper_, 0.0);
        }
        // What changes by less than can be told from the scale looks level.
        const double least_range = 0.005 * std::max(std::abs(lower_), std::abs(upper_)) + 1e-300;
        const double room = std::max(0.06 * (upper_ - lower_), 0.5 * (least_range - (upper_ - lower_)));
        lower_ -= room;
        upper_ += room;
    }
    now_ = 0;
    for (std::size_t i = 0; i < course_.size(); ++i)
        if (course_[i].step <= step.step) now_ = i;
    update();
}

QRectF ConvergencePlot::plot() const {
    return QRectF(rect()).adjusted(left_margin, top_margin, -right_margin, -bottom_margin);
}

double ConvergencePlot::x_of(StepNumber step) const {
    for (std::size_t i = 0; i < course_.size(); ++i)
        if (course_[i].step == step)
            return plot().left() + plot().width() * static_cast<double>(i) /
                                       static_cast<double>(std::max<std::size_t>(2, course_.size()) - 1);
    return -1.0;
}

std::size_t ConvergencePlot::point_at(double x) const {
    const double position = (x - plot().left()) / plot().width() * static_cast<double>(course_.size() - 1);
    return static_cast<std::size_t>(std::clamp(std::lround(position), 0L, static_cast<long>(course_.size()) - 1));
}

void ConvergencePlot::choose(double x) {
    if (!course_.empty()) emit step_chosen(course_[point_at(x)].step);
}

void ConvergencePlot::mousePressEvent(QMouseEvent* event) {
    if (event->button() == Qt::LeftButton) choose(event->position().x());
}

void ConvergencePlot::mouseMoveEvent(QMouseEvent* event) {
    if (event->buttons() & Qt::LeftButton) choose(event->position().x());
}

bool ConvergencePlot::event(QEvent* event) {
    if (event->type() == QEvent::ToolTip && !course_.empty()) {
        const auto* help = static_cast<QHelpEvent*>(event);
        const std::size_t point = point_at(help->pos().x());
        QStringList lines;
        for (const Series& series : series_)
            lines << QStringLiteral("%1 %2").arg(series.name, format_number(series.values[point]));
        QToolTip::showText(help->globalPos(), lines.join(QLatin1Char('\n')), this);
        return true;
    }
    return QWidget::event(event);
}

void ConvergencePlot::paintEvent(QPaintEvent*) {
    QPainter painter(this);
    painter.setFont(Theme::small_font());
    const QRectF area = plot();
    const QColor muted = theme_.color(QStringLiteral("text_muted")), line = theme_.color(QStringLiteral("border"));
    if (course_.empty()) {
        painter.setPen(muted);
        painter.drawText(rect(), Qt::AlignCenter | Qt::TextWordWrap, tr("No iterations in this step"));
        return;
    }
    const auto height_of = [&](double value) {
        const double t = is_logarithmic_ ? std::log(value / lower_) / std::log(upper_ / lower_)
                                         : (value - lower_) / (upper_ - lower_);
        return area.bottom() - std::clamp(t, 0.0, 1.0) * area.height();
    };
    const auto x_at = [&](std::size_t i) {
        return area.left() + area.width() * static_cast<double>(i) /
                                 static_cast<double>(std::max<std::size_t>(2, course_.size()) - 1);
    };
    painter.setPen(line);
    painter.drawRect(area);
    if (!is_logarithmic_ && lower_ < 0.0 && upper_ > 0.0) {
        painter.setPen(QPen(theme_.color(QStringLiteral("border_strong")), 1.0, Qt::DashLine));
        painter.drawLine(QPointF(area.left(), height_of(0.0)), QPointF(area.right(), height_of(0.0)));
    }
    painter.setPen(muted);
    const auto scale = [&](double y, double value) {
        painter.drawText(QRectF(0, y - 7, left_margin - 5, 14), Qt::AlignRight | Qt::AlignVCenter, short_number(value));
    };
    if (short_number(lower_) == short_number(upper_)) {
        scale(area.center().y(), 0.5 * (lower_ + upper_));
    } else {
        scale(area.top(), upper_);
        scale(area.bottom() - 2, lower_);
    }
    painter.setRenderHint(QPainter::Antialiasing);
    double legend = area.left();
    for (const Series& series : series_) {
        const QColor color = theme_.color(series.is_second ? QStringLiteral("warning") : QStringLiteral("accent"));
        QPainterPath path;
        bool is_open = false;
        for (std::size_t i = 0; i < course_.size(); ++i) {
            if (!std::isfinite(series.values[i])) {
                is_open = false;
                continue;
            }
            const QPointF point(x_at(i), height_of(series.values[i]));
            if (is_open && !course_[i].begins_anew)
                path.lineTo(point);
            else
                path.moveTo(point);
            is_open = true;
        }
        QPen pen(color, series.is_second ? 1.2 : 1.7);
        if (series.is_second) pen.setStyle(Qt::DashLine);
        painter.setPen(pen);
        painter.drawPath(path);
        painter.drawEllipse(QPointF(x_at(now_), height_of(series.values[now_])), 2.5, 2.5);
        painter.drawLine(QPointF(legend, 8.5), QPointF(legend + 16, 8.5));
        painter.setPen(muted);
        painter.drawText(QPointF(legend + 20, 12.5), series.name);
        legend += 34 + painter.fontMetrics().horizontalAdvance(series.name);
    }
    painter.setPen(QPen(theme_.color(QStringLiteral("text")), 1.0));
    painter.drawLine(QPointF(x_at(now_), area.top()), QPointF(x_at(now_), area.bottom()));
}

}  // namespace curvewright
