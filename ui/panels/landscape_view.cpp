#include "ui/panels/landscape_view.h"

#include <algorithm>
#include <cmath>

#include <QPainter>
#include <QPainterPath>

#include "ui/palette/color_map.h"

namespace curvewright {

LandscapeView::LandscapeView(const Theme& theme, QWidget* parent) : QWidget(parent), theme_(theme) {
    setObjectName(QStringLiteral("landscape_view"));
    setAccessibleName(tr("Landscape of the objective"));
    setToolTip(
        tr("What the method minimises, for every place of the node around where it began: dark is low. The ring is "
           "where the node began, the dot where it is now, the diamond where the value of the slider would lead."));
    connect(&theme, &Theme::changed, this, qOverload<>(&QWidget::update));
}

void LandscapeView::clear() {
    result_.reset();
    step_.reset();
    update();
}

void LandscapeView::show_result(std::shared_ptr<const TrialResult> result,
                                std::shared_ptr<const StepExplanation> step) {
    result_ = std::move(result);
    step_ = std::move(step);
    // The colour is the rank among the levels, so that flat regions and steep walls can both be read.
    const Eigen::MatrixXd& values = result_->landscape.values;
    const std::vector<double>& levels = result_->levels;
    map_ = QImage(static_cast<int>(values.cols()), static_cast<int>(values.rows()), QImage::Format_RGB32);
    for (Eigen::Index r = 0; r < values.rows(); ++r)
        for (Eigen::Index c = 0; c < values.cols(); ++c) {
            const double value = values(r, c);
            double t = 1.0;
            if (std::isfinite(value) && !levels.empty()) {
                const auto above = std::upper_bound(levels.begin(), levels.end(), value);
                double rank = static_cast<double>(above - levels.begin());
                if (above != levels.begin() && above != levels.end())
                    rank += (value - *std::prev(above)) / (*above - *std::prev(above));
                t = rank / static_cast<double>(levels.size());
            }
            const Color color = map_color(ColorMap::deep, std::clamp(t, 0.0, 1.0));
            map_.setPixelColor(static_cast<int>(c), static_cast<int>(values.rows() - 1 - r),
                               QColor::fromRgbF(static_cast<float>(color[0]), static_cast<float>(color[1]),
                                                static_cast<float>(color[2])));
        }
    update();
}

void LandscapeView::paintEvent(QPaintEvent*) {
    QPainter painter(this);
    painter.setFont(Theme::small_font());
    if (!result_) {
        painter.setPen(theme_.color(QStringLiteral("text_muted")));
        painter.drawText(rect(), Qt::AlignCenter | Qt::TextWordWrap, tr("A step within a patch has a landscape"));
        return;
    }
    const double side = std::min(width(), height()) - 4.0;
    const QRectF area(0.5 * (width() - side), 0.5 * (height() - side), side, side);
    painter.setRenderHint(QPainter::SmoothPixmapTransform);
    painter.setRenderHint(QPainter::Antialiasing);
    painter.setClipRect(area);
    painter.drawImage(area, map_);
    const Landscape& landscape = result_->landscape;
    const double last_row = static_cast<double>(landscape.values.rows() - 1),
                 last_column = static_cast<double>(landscape.values.cols() - 1);
    const auto from_grid = [&](const Eigen::Vector2d& point) {
        return QPointF(area.left() + point[1] / last_column * side, area.bottom() - point[0] / last_row * side);
    };
    const auto place = [&](const Eigen::RowVector3d& position) {
        const Eigen::RowVector3d away = position - landscape.center;
        const double column = away.dot(landscape.across) / landscape.across.squaredNorm();
        const double row = away.dot(landscape.up) / landscape.up.squaredNorm();
        return QPointF(area.center().x() + 0.5 * side * column, area.center().y() - 0.5 * side * row);
    };
    painter.setPen(QPen(QColor(255, 255, 255, 120), 0.8));
    for (const auto& level : result_->contours)
        for (const auto& line : level) {
            QPolygonF polygon;
            for (const Eigen::Vector2d& point : line) polygon << from_grid(point);
            painter.drawPolyline(polygon);
        }
    const auto draw_path = [&](const QPolygonF& path, const QColor& color, Qt::PenStyle style) {
        painter.setBrush(Qt::NoBrush);
        painter.setPen(QPen(QColor(0, 0, 0, 150), 3.0));
        painter.drawPolyline(path);
        painter.setPen(QPen(color, 1.5, style));
        painter.drawPolyline(path);
    };
    const QColor gold(245, 168, 26);
    QPolygonF tried, gone;
    for (const Eigen::RowVector3d& point : result_->outcome.path) tried << place(point);
    for (const auto& point : step_->path) gone << place({point[0], point[1], point[2]});
    draw_path(tried, gold, Qt::DashLine);
    draw_path(gone, Qt::white, Qt::SolidLine);
    if (step_->simplex && !step_->end) {
        QPolygonF simplex;
        for (const auto& vertex : step_->simplex->simplex)
            simplex << place({vertex[0], vertex[1], landscape.center[2]});
        painter.setPen(QPen(Qt::white, 1.4));
        painter.drawPolygon(simplex);
    }
    painter.setPen(QPen(Qt::black, 3.5));
    painter.drawEllipse(place(landscape.center), 5.0, 5.0);
    painter.setPen(QPen(Qt::white, 1.6));
    painter.drawEllipse(place(landscape.center), 5.0, 5.0);
    painter.setPen(QPen(Qt::black, 1.2));
    painter.setBrush(Qt::white);
    painter.drawEllipse(gone.last(), 4.0, 4.0);
    const QPointF end = place(result_->outcome.position);
    QPolygonF diamond;
    diamond << end + QPointF(0, -6) << end + QPointF(6, 0) << end + QPointF(0, 6) << end + QPointF(-6, 0);
    painter.setBrush(gold);
    painter.drawPolygon(diamond);
}

}  // namespace curvewright
