// The view as a Canvas for tools: between its own pixels (origin top left) and the scene's device pixels (bottom left).

#include "ui/main_window/mesh_view_parts.h"

#include <algorithm>

namespace curvewright {

std::array<double, 2> MeshView::to_device(QPointF position) const {
    const double ratio = devicePixelRatioF();
    return {position.x() * ratio, parts_->window->GetSize()[1] - 1 - position.y() * ratio};
}

QPointF MeshView::from_device(double x, double y) const {
    const double ratio = devicePixelRatioF();
    return {x / ratio, (parts_->window->GetSize()[1] - 1 - y) / ratio};
}

bool MeshView::is_flat() const {
    return parts_->scene.is_flat();
}

QRectF MeshView::free_area() const {
    const double covered = parts_->scene.legend_width() / devicePixelRatioF();
    return {0.0, 0.0, std::max(0.0, width() - covered), double(height())};
}

QPointF MeshView::to_display(const Eigen::RowVector3d& point) const {
    const Eigen::Vector4d at = parts_->scene.project(point);
    return from_device(at[0], at[1]);
}

Eigen::RowVector3d MeshView::to_mesh(QPointF position, const Eigen::RowVector3d& at_depth_of) const {
    const auto [x, y] = to_device(position);
    return parts_->scene.unproject(x, y, at_depth_of);
}

double MeshView::units_per_pixel(const Eigen::RowVector3d& at) const {
    return parts_->scene.units_per_pixel(at) * devicePixelRatioF();
}

Eigen::Matrix3d MeshView::view_axes() const {
    return parts_->scene.view_axes();
}

std::optional<Index> MeshView::node_at(QPointF position, double radius,
                                       const std::function<bool(Index)>& accepts) const {
    const auto [x, y] = to_device(position);
    return parts_->scene.pick_node(x, y, radius * devicePixelRatioF(), accepts);
}

std::optional<Index> MeshView::element_at(QPointF position) const {
    const auto [x, y] = to_device(position);
    return parts_->scene.pick_element(x, y);
}

std::vector<Index> MeshView::nodes_inside(const std::vector<QPointF>& polygon, bool see_through) const {
    std::vector<std::array<double, 2>> corners;
    for (const QPointF& corner : polygon) corners.push_back(to_device(corner));
    return parts_->scene.nodes_inside(corners, see_through);
}

std::vector<Index> MeshView::elements_inside(const std::vector<QPointF>& polygon, bool see_through) const {
    std::vector<std::array<double, 2>> corners;
    for (const QPointF& corner : polygon) corners.push_back(to_device(corner));
    return parts_->scene.elements_inside(corners, see_through);
}

void MeshView::show_marks(Marks marks, const std::vector<QPointF>& rubber) {
    if (rubber.size() > 1) {
        MarkLine line{{}, MarkRole::rubber, 1.0};
        for (const QPointF& corner : rubber) {
            const auto [x, y] = to_device(corner);
            line.points.push_back({x, y, 0.0});
        }
        line.points.push_back(line.points.front());
        marks.lines.push_back(std::move(line));
    }
    parts_->scene.set_marks(marks);
    request_other_view();
}

}  // namespace curvewright
