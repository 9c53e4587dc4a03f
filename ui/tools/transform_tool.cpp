#include "ui/tools/transform_tool.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <Eigen/Geometry>

#include "ui/document/number_format.h"

namespace curvewright {
namespace {

// Pixels.
constexpr double arrow_start = 16.0, arrow_length = 64.0, ring_radius = 48.0, box_distance = 92.0;
constexpr double point_reach = 10.0, line_reach = 6.0;
constexpr int ring_pieces = 96;

Eigen::RowVector3d axis_vector(int axis) {
    return Eigen::RowVector3d::Unit(3, axis);
}

double distance_to_segment(QPointF point, QPointF a, QPointF b) {
    const QPointF way = b - a;
    const double square = QPointF::dotProduct(way, way);
    const double t = square > 0.0 ? std::clamp(QPointF::dotProduct(point - a, way) / square, 0.0, 1.0) : 0.0;
    const QPointF rest = point - a - t * way;
    return std::hypot(rest.x(), rest.y());
}

}  // namespace

TransformTool::TransformTool(const ToolContext& context, QObject* parent) : Tool(context, parent) {
    connect(&context_.drag, &LiveDrag::frame, this, [this](const Coordinates& positions) {
        if (is_held_) show(positions);
    });
    connect(&context_.drag, &LiveDrag::ended, this, [this] {
        if (!is_held_) return;
        is_held_ = false;
        refresh();
        emit hint_changed();
    });
}

void TransformTool::leave() {
    hovered_.reset();
    hovered_node_.reset();
    context_.canvas.show_marks({}, {});
    context_.canvas.show_cursor({});
}

std::vector<TransformTool::Handle> TransformTool::handles() const {
    std::vector<Handle> result{{HandleKind::center, 0}};
    const bool is_flat = context_.canvas.is_flat();
    for (int axis = 0; axis < (is_flat ? 2 : 3); ++axis) {
        result.push_back({HandleKind::arrow, axis});
        result.push_back({HandleKind::box, axis});
        if (!is_flat) result.push_back({HandleKind::ring, axis});
    }
    if (is_flat) result.push_back({HandleKind::ring, 2});
    return result;
}

std::vector<Eigen::RowVector3d> TransformTool::shape_of(const Handle& handle, const Eigen::RowVector3d& pivot) const {
    const double pixel = context_.canvas.units_per_pixel(pivot);
    switch (handle.kind) {
        case HandleKind::center:
            return {pivot};
        case HandleKind::arrow:
            return {pivot + arrow_start * pixel * axis_vector(handle.axis),
                    pivot + arrow_length * pixel * axis_vector(handle.axis)};
        case HandleKind::box:
            return {pivot + box_distance * pixel * axis_vector(handle.axis)};
        case HandleKind::ring:
            break;
    }
    std::vector<Eigen::RowVector3d> ring;
    const Eigen::RowVector3d u = axis_vector((handle.axis + 1) % 3), v = axis_vector((handle.axis + 2) % 3);
    for (int i = 0; i <= ring_pieces; ++i) {
        const double angle = 2.0 * std::numbers::pi * (i % ring_pieces) / ring_pieces;
        ring.push_back(pivot + ring_radius * pixel * (std::cos(angle) * u + std::sin(angle) * v));
    }
    return ring;
}

Eigen::RowVector3d TransformTool::middle_of_selection(const Coordinates& positions) const {
    const IndexSet& nodes = is_held_ ? nodes_ : context_.edit.nodes();
    Eigen::RowVector3d low = positions.row(nodes.front()), high = low;
    for (const Index node : nodes) {
        low = low.cwiseMin(positions.row(node));
        high = high.cwiseMax(positions.row(node));
    }
    return 0.5 * (low + high);
}

Eigen::RowVector3d TransformTool::place_of_handles(const Coordinates& positions) const {
    const Eigen::RowVector3d middle = middle_of_selection(positions);
    const QPointF shown = context_.canvas.to_display(middle);
    const QRectF room = context_.canvas.free_area();
    // The ring whole; the arrows that point outwards reach beyond it. A smaller view shows what it can.
    const double margin = std::min({ring_radius + 8.0, 0.5 * room.width(), 0.5 * room.height()});
    const QPointF inside(std::clamp(shown.x(), margin, room.width() - margin),
                         std::clamp(shown.y(), margin, room.height() - margin));
    return inside == shown ? middle : context_.canvas.to_mesh(inside, middle);
}

std::optional<TransformTool::Handle> TransformTool::handle_at(QPointF position) const {
    if (context_.edit.nodes().empty()) return std::nullopt;
    const Eigen::RowVector3d pivot = place_of_handles(context_.document().state().mesh->coordinates());
    std::optional<Handle> best;
    double least = std::numeric_limits<double>::infinity();
    for (const Handle& handle : handles()) {
        const auto shape = shape_of(handle, pivot);
        double distance = std::numeric_limits<double>::infinity();
        if (shape.size() == 1) {
            const QPointF way = context_.canvas.to_display(shape.front()) - position;
            distance = std::hypot(way.x(), way.y()) / point_reach;
        }
        for (std::size_t i = 0; i + 1 < shape.size(); ++i)
            distance = std::min(distance, distance_to_segment(position, context_.canvas.to_display(shape[i]),
                                                              context_.canvas.to_display(shape[i + 1])) /
                                              line_reach);
        if (distance <= 1.0 && distance < least) {
            least = distance;
            best = handle;
        }
    }
    return best;
}

void TransformTool::hover(const std::optional<PointerEvent>& event) {
    if (is_held_ || !context_.document().has_mesh()) return;
    std::optional<Handle> handle;
    std::optional<Index> node;
    if (event) {
        handle = handle_at(event->position);
        const MeshTopology& topology = context_.document().state().mesh->topology();
        if (!handle)
            node = context_.canvas.node_at(event->position, point_reach + 2.0,
                                           [&](Index candidate) { return topology.is_boundary_node(candidate); });
    }
    if (handle == hovered_ && node == hovered_node_) return;
    hovered_ = handle;
    hovered_node_ = node;
    context_.canvas.show_cursor(handle ? QCursor(Qt::OpenHandCursor)
                                : node ? QCursor(Qt::PointingHandCursor)
                                       : QCursor());
    refresh();
    emit hint_changed();
}

bool TransformTool::press(const PointerEvent& event) {
    if (context_.drag.is_active()) return true;
    hover(event);
    if (hovered_node_) {
        const bool adds = event.modifiers.testFlag(Qt::ShiftModifier);
        const IndexSet unit = context_.edit.taken_by(*hovered_node_);
        context_.edit.select_nodes(adds ? united(context_.edit.nodes(), unit) : unit);
        return true;
    }
    if (!hovered_) return false;
    nodes_ = without(context_.edit.nodes(), context_.edit.pins());
    if (nodes_.empty()) return true;
    held_ = *hovered_;
    pivot_ = middle_of_selection(context_.document().state().mesh->coordinates());
    handles_at_ = place_of_handles(context_.document().state().mesh->coordinates());
    length_ = arrow_length * context_.canvas.units_per_pixel(handles_at_);
    press_ = event.position;
    is_held_ = true;
    value_ = held_.kind == HandleKind::box || held_.kind == HandleKind::center ? 1.0 : 0.0;
    start_ = last_angle_ = 0.0;
    if (held_.kind == HandleKind::ring)
        start_ = last_angle_ = angle_at(event.position);
    else if (held_.kind != HandleKind::center)
        start_ = place_on_axis(event.position, held_.axis);
    dragged_ = context_.edit.dragged(nodes_);
    context_.canvas.show_cursor(Qt::ClosedHandCursor);
    context_.drag.begin(make_request());
    refresh();
    emit hint_changed();
    return true;
}

double TransformTool::angle_at(QPointF position) const {
    // The ring's point that shows nearest to the mouse in direction from the pivot.
    const QPointF center = context_.canvas.to_display(handles_at_), mouse = position - center;
    const double reach = std::hypot(mouse.x(), mouse.y());
    const auto ring = shape_of(held_, handles_at_);
    double best = -2.0, angle = 0.0;
    for (int i = 0; i < ring_pieces; ++i) {
        const QPointF way = context_.canvas.to_display(ring[static_cast<std::size_t>(i)]) - center;
        const double length = std::hypot(way.x(), way.y());
        if (length < 1e-9 || reach < 1e-9) continue;
        const double cosine = QPointF::dotProduct(way, mouse) / (length * reach);
        if (cosine > best) {
            best = cosine;
            angle = 2.0 * std::numbers::pi * i / ring_pieces;
        }
    }
    if (!context_.canvas.is_flat()) return angle;
    // Face on, exactly: y points up in the mesh, down on the display.
    return std::atan2(-mouse.y(), mouse.x());
}

double TransformTool::place_on_axis(QPointF position, int axis) const {
    const QPointF origin = context_.canvas.to_display(handles_at_);
    const QPointF way = context_.canvas.to_display(handles_at_ + length_ * axis_vector(axis)) - origin;
    const double square = QPointF::dotProduct(way, way);
    return square > 25.0 ? length_ * QPointF::dotProduct(position - origin, way) / square : 0.0;
}

AffineMotion TransformTool::motion_of(const PointerEvent& event) {
    const bool is_stepped = event.modifiers.testFlag(Qt::ControlModifier);
    const auto stepped = [&](double value, double step) {
        return is_stepped ? std::round(value / step) * step : value;
    };
    switch (held_.kind) {
        case HandleKind::arrow: {
            value_ = place_on_axis(event.position, held_.axis) - start_;
            const SnapSettings& snap = context_.edit.settings().snap;
            if (is_stepped) value_ = stepped(value_, snap.grid_spacing);
            return AffineMotion::translation(value_ * axis_vector(held_.axis).transpose());
        }
        case HandleKind::ring: {
            // The way around: no jump from 359 degrees to 0.
            const double angle = angle_at(event.position);
            const double turn = std::remainder(angle - last_angle_, 2.0 * std::numbers::pi);
            last_angle_ += turn;
            value_ = stepped((last_angle_ - start_) * 180.0 / std::numbers::pi, 5.0);
            return AffineMotion::rotation(axis_vector(held_.axis).transpose(), value_ * std::numbers::pi / 180.0);
        }
        case HandleKind::box: {
            const double place = place_on_axis(event.position, held_.axis);
            value_ = std::abs(start_) > 0.0 ? stepped(place / start_, 0.05) : 1.0;
            Eigen::Vector3d factors = Eigen::Vector3d::Ones();
            factors[held_.axis] = value_;
            return AffineMotion::scaling(factors);
        }
        case HandleKind::center:
            break;
    }
    value_ = stepped(std::exp((event.position.x() - press_.x() - (event.position.y() - press_.y())) / 200.0), 0.05);
    Eigen::Vector3d factors = Eigen::Vector3d::Constant(value_);
    if (context_.canvas.is_flat()) factors[2] = 1.0;
    return AffineMotion::scaling(factors);
}

DragRequest TransformTool::make_request() const {
    const QString count = format_count(static_cast<long long>(nodes_.size()));
    const QString name = held_.kind == HandleKind::arrow  ? tr("Move %1 nodes").arg(count)
                         : held_.kind == HandleKind::ring ? tr("Rotate %1 nodes").arg(count)
                                                          : tr("Scale %1 nodes").arg(count);
    return {dragged_, held_.kind == HandleKind::arrow ? ResponseKind::translation : ResponseKind::affine,
            pivot_.transpose(), name};
}

void TransformTool::move(const PointerEvent& event) {
    if (!is_held_) return;
    context_.drag.move(motion_of(event));
    emit hint_changed();
}

void TransformTool::release(const PointerEvent&) {
    if (is_held_) context_.drag.finish();
    context_.canvas.show_cursor({});
}

bool TransformTool::wheel(const PointerEvent&, double steps) {
    if (!is_held_ || !context_.edit.settings().is_soft) return false;
    EditSettings settings = context_.edit.settings();
    settings.soft.radius *= std::pow(1.12, steps);
    context_.edit.set_settings(settings);
    dragged_ = context_.edit.dragged(nodes_);
    context_.drag.change(make_request());
    return true;
}

bool TransformTool::cancel() {
    if (is_held_) {
        context_.drag.cancel();
        return true;
    }
    if (context_.edit.nodes().empty()) return false;
    context_.edit.select({}, {});
    return true;
}

void TransformTool::refresh() {
    if (!context_.document().has_mesh()) {
        hovered_.reset();
        hovered_node_.reset();
        context_.canvas.show_marks({}, {});
        return;
    }
    const Coordinates& positions = context_.document().state().mesh->coordinates();
    if (hovered_node_ && *hovered_node_ >= positions.rows()) hovered_node_.reset();
    if (context_.edit.nodes().empty() && !is_held_) hovered_.reset();
    if (!is_held_ || !context_.drag.is_live()) show(positions);
}

void TransformTool::show(const Coordinates& positions) {
    Marks marks;
    add_state_marks(marks, context_.edit, positions);
    if (hovered_node_ && !is_held_)
        add_points(marks, context_.edit.taken_by(*hovered_node_), positions, MarkRole::hovered);
    if (!context_.edit.nodes().empty()) {
        const DraggedSet set = is_held_ ? dragged_ : context_.edit.dragged(context_.edit.nodes());
        for (std::size_t i = 0; i < set.weights.size(); ++i)
            if (set.weights[i] < 1.0)
                marks.points.push_back(
                    {{positions(set.nodes[i], 0), positions(set.nodes[i], 1), positions(set.nodes[i], 2)},
                     MarkRole::soft,
                     set.weights[i]});
        // A turned or scaled set keeps its middle, a moved one takes the handles along.
        const Eigen::RowVector3d pivot =
            is_held_ && held_.kind != HandleKind::arrow ? handles_at_ : place_of_handles(positions);
        constexpr MarkRole roles[] = {MarkRole::axis_x, MarkRole::axis_y, MarkRole::axis_z};
        for (const Handle& handle : handles()) {
            const bool is_active = is_held_ ? handle == held_ : hovered_ == handle;
            // Only the one in hand: the others would hide what happens.
            if (is_held_ && !is_active) continue;
            const bool is_neutral =
                handle.kind == HandleKind::center || (handle.kind == HandleKind::ring && context_.canvas.is_flat());
            const MarkRole role = is_active    ? MarkRole::active_handle
                                  : is_neutral ? MarkRole::handle
                                               : roles[handle.axis];
            const auto shape = shape_of(handle, pivot);
            if (shape.size() > 1) {
                MarkLine line{{}, role, 1.0};
                for (const auto& point : shape) line.points.push_back({point[0], point[1], point[2]});
                marks.lines.push_back(std::move(line));
            }
            if (handle.kind == HandleKind::arrow) {
                // The tip: two strokes in the plane of the view.
                const Eigen::Vector3d eye = context_.canvas.view_axes().col(2);
                const Eigen::RowVector3d along = axis_vector(handle.axis);
                Eigen::RowVector3d across = eye.cross(along.transpose()).transpose();
                if (across.norm() > 1e-6) {
                    across.normalize();
                    const double size = 9.0 * context_.canvas.units_per_pixel(pivot);
                    const Eigen::RowVector3d tip = shape.back();
                    MarkLine head{{}, role, 1.0};
                    for (const Eigen::RowVector3d& point :
                         {Eigen::RowVector3d(tip - size * along + 0.6 * size * across), tip,
                          Eigen::RowVector3d(tip - size * along - 0.6 * size * across)})
                        head.points.push_back({point[0], point[1], point[2]});
                    marks.lines.push_back(std::move(head));
                }
            } else if (shape.size() == 1) {
                marks.points.push_back({{shape[0][0], shape[0][1], shape[0][2]}, role, 1.0});
            }
        }
    }
    context_.canvas.show_marks(std::move(marks), {});
}

QString TransformTool::hint() const {
    const QString axis = QStringLiteral("xyz").mid(held_.axis, 1);
    if (is_held_) {
        const QString rest = tr(" · Ctrl: in steps · Esc: put back");
        switch (held_.kind) {
            case HandleKind::arrow:
                return tr("moved by %1 along %2").arg(format_number(value_), axis) + rest;
            case HandleKind::ring:
                return tr("rotated by %1° about %2").arg(format_number(value_), axis) + rest;
            case HandleKind::box:
                return tr("scaled by %1 along %2").arg(format_number(value_), axis) + rest;
            case HandleKind::center:
                return tr("scaled by %1").arg(format_number(value_)) + rest;
        }
    }
    if (context_.edit.nodes().empty())
        return tr("click the boundary: select what is to be moved, rotated or scaled (Shift: more)");
    if (!hovered_) return tr("arrows: move · ring: rotate · dots at the ends: scale along an axis · middle: scale");
    switch (hovered_->kind) {
        case HandleKind::arrow:
            return tr("drag: move the selection along %1").arg(QStringLiteral("xyz").mid(hovered_->axis, 1));
        case HandleKind::ring:
            return tr("drag: rotate the selection about %1").arg(QStringLiteral("xyz").mid(hovered_->axis, 1));
        case HandleKind::box:
            return tr("drag: scale the selection along %1").arg(QStringLiteral("xyz").mid(hovered_->axis, 1));
        case HandleKind::center:
            break;
    }
    return tr("drag to the right: scale the selection up");
}

}  // namespace curvewright
