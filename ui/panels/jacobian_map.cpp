#include "ui/panels/jacobian_map.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <QPainter>

#include "core/quality/jacobian_samples.h"
#include "ui/document/number_format.h"
#include "ui/palette/quality_colors.h"

namespace curvewright {
namespace {

constexpr int pieces_per_side = 24;

QColor to_qcolor(const Color& color) {
    return QColor::fromRgbF(static_cast<float>(color[0]), static_cast<float>(color[1]), static_cast<float>(color[2]));
}

}  // namespace

JacobianMap::JacobianMap(const Theme& theme, QWidget* parent) : QWidget(parent), theme_(theme) {
    setObjectName(QStringLiteral("jacobian_map"));
    connect(&theme, &Theme::changed, this, qOverload<>(&QWidget::update));
}

void JacobianMap::clear() {
    pieces_.clear();
    setVisible(false);
}

void JacobianMap::set_scale(const ColorScale& scale) {
    if (scale == scale_) return;
    scale_ = scale;
    update();
}

void JacobianMap::show_element(const CurvedMesh& mesh, Index element, const QualityReport& report) {
    const ElementType type = mesh.topology().element_type(element);
    const ElementQuality& quality = report.elements[static_cast<std::size_t>(element)];
    const bool is_flat = dimension(type.shape) == 2;
    // A plane of the reference element: whole if flat; of a solid at the height of the worst point. A tetrahedron gets
    // narrower with the height.
    const bool is_triangle =
        type.shape == Shape::triangle || type.shape == Shape::tetrahedron || type.shape == Shape::prism;
    const double height = is_flat ? 0.0 : std::clamp(quality.worst_point[2], 0.0, 1.0);
    const double width = type.shape == Shape::tetrahedron ? std::max(1.0 - height, 1e-3) : 1.0;
    constexpr int n = pieces_per_side;
    const auto index = [](int i, int j) { return j * (n + 1) + i; };
    Eigen::MatrixX3d points = Eigen::MatrixX3d::Zero((n + 1) * (n + 1), 3);
    for (int j = 0; j <= n; ++j)
        for (int i = 0; i <= n; ++i) {
            // The half of the square that a triangle has not is folded onto it, to no effect.
            const bool is_beyond = is_triangle && i + j > n;
            const double u = static_cast<double>(is_beyond ? n - j : i) / n;
            const double v = static_cast<double>(is_beyond ? n - i : j) / n;
            points.row(index(i, j)) << width * u, width * v, height;
        }
    const Eigen::MatrixX3d x = mesh.element_coordinates(element);
    const JacobianSamples samples = sample_jacobian(type, x, points);
    const double scale = std::max(std::abs(quality.max_upper), std::abs(quality.min_lower));
    const Eigen::VectorXd values = report.orientation_sign.of_element(mesh.topology(), element) * samples.determinants /
                                   (scale > 0.0 ? scale : 1.0);
    const auto place = [&](int at) {
        return is_flat ? QPointF(samples.positions(at, 0), samples.positions(at, 1))
                       : QPointF(points(at, 0), points(at, 1));
    };
    pieces_.clear();
    outline_.clear();
    least_ = values.minCoeff();
    largest_ = values.maxCoeff();
    const auto add = [&](std::array<int, 3> corners) {
        Piece piece;
        for (const int corner : corners) {
            piece.corners << place(corner);
            piece.value += values[corner] / 3.0;
        }
        pieces_.push_back(std::move(piece));
    };
    for (int j = 0; j < n; ++j)
        for (int i = 0; i < (is_triangle ? n - j : n); ++i) {
            add({index(i, j), index(i + 1, j), index(i, j + 1)});
            if (!is_triangle || i + j + 1 < n) add({index(i + 1, j), index(i + 1, j + 1), index(i, j + 1)});
        }
    for (int i = 0; i < n; ++i) outline_ << place(index(i, 0));
    if (is_triangle) {
        for (int i = 0; i < n; ++i) outline_ << place(index(n - i, i));
    } else {
        for (int i = 0; i < n; ++i) outline_ << place(index(n, i));
        for (int i = 0; i < n; ++i) outline_ << place(index(n - i, n));
    }
    for (int i = 0; i < n; ++i) outline_ << place(index(0, n - i));
    Eigen::MatrixX3d worst(1, 3);
    worst << quality.worst_point[0], quality.worst_point[1], quality.worst_point[2];
    const JacobianSamples at_worst = sample_jacobian(type, x, worst);
    worst_ = is_flat ? QPointF(at_worst.positions(0, 0), at_worst.positions(0, 1))
                     : QPointF(quality.worst_point[0], quality.worst_point[1]);
    caption_ = is_flat ? tr("J inside the element") : tr("J on a cut at height %1").arg(format_number(height));
    setToolTip(
        tr("The Jacobian over its largest value, in the colours of the legend: from %1 to %2 here. The ring marks "
           "the worst point of the element.")
            .arg(format_number(least_), format_number(largest_)));
    setVisible(true);
    update();
}

void JacobianMap::paintEvent(QPaintEvent*) {
    if (pieces_.empty()) return;
    QPainter painter(this);
    const QFont small = Theme::small_font();
    painter.setFont(small);
    const int line = painter.fontMetrics().height();
    painter.setPen(theme_.color(QStringLiteral("text_muted")));
    painter.drawText(QRectF(0, height() - line, width(), line), Qt::AlignHCenter | Qt::AlignBottom, caption_);
    const QRectF room(6, 6, width() - 12, height() - 14 - line), box = outline_.boundingRect();
    const double scale =
        std::min(room.width() / std::max(box.width(), 1e-300), room.height() / std::max(box.height(), 1e-300));
    painter.setRenderHint(QPainter::Antialiasing);
    QTransform to_widget;
    to_widget.translate(room.center().x(), room.center().y());
    to_widget.scale(scale, -scale);
    to_widget.translate(-box.center().x(), -box.center().y());
    for (const Piece& piece : pieces_) {
        const Color color = piece.value > 0.0 ? scale_.color_of(piece.value) : tangled_color();
        painter.setBrush(to_qcolor(color));
        // In its own colour: no seams between the pieces.
        painter.setPen(QPen(to_qcolor(color), 0.7));
        painter.drawPolygon(to_widget.map(piece.corners));
    }
    painter.setBrush(Qt::NoBrush);
    painter.setPen(QPen(theme_.color(QStringLiteral("text")), 1.2));
    painter.drawPolygon(to_widget.map(outline_));
    const QPointF worst = to_widget.map(worst_);
    painter.setPen(QPen(Qt::white, 3.4));
    painter.drawEllipse(worst, 5.0, 5.0);
    painter.setPen(QPen(QColor(20, 20, 20), 1.5));
    painter.drawEllipse(worst, 5.0, 5.0);
}

}  // namespace curvewright
