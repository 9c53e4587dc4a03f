#include "ui/tools/drag_tool.h"

#include <algorithm>
#include <cmath>

#include <QGuiApplication>

#include "ui/document/number_format.h"

namespace curvewright {
namespace {

constexpr double reach = 14.0;  ///< pixels around a node from which it can be taken

QString name_of(GrabUnit unit, std::size_t nodes, bool is_selection) {
    if (is_selection)
        return nodes == 1 ? DragTool::tr("Drag 1 selected node")
                          : DragTool::tr("Drag %1 selected nodes").arg(format_count(static_cast<long long>(nodes)));
    switch (unit) {
        case GrabUnit::side:
            return DragTool::tr("Drag a side");
        case GrabUnit::boundary:
            return DragTool::tr("Drag a boundary");
        case GrabUnit::node:
            break;
    }
    return {};
}

}  // namespace

DragTool::DragTool(const ToolContext& context, QObject* parent) : Tool(context, parent) {
    connect(&context_.drag, &LiveDrag::frame, this, [this](const Coordinates& positions) {
        if (is_held_) show(positions);
    });
    connect(&context_.drag, &LiveDrag::ended, this, [this] {
        if (!is_held_) return;
        is_held_ = false;
        emit hint_changed();
    });
}

void DragTool::leave() {
    hovered_.reset();
    hovered_set_.clear();
    context_.canvas.show_marks({}, {});
    context_.canvas.show_cursor({});
}

void DragTool::hover(const std::optional<PointerEvent>& event) {
    if (is_held_) return;
    std::optional<Index> node;
    if (event && context_.document().has_mesh()) {
        const MeshTopology& topology = context_.document().state().mesh->topology();
        const IndexSet& selected = context_.edit.nodes();
        node = context_.canvas.node_at(event->position, reach, [&](Index candidate) {
            return topology.is_boundary_node(candidate) ||
                   std::binary_search(selected.begin(), selected.end(), candidate);
        });
    }
    if (node == hovered_) return;
    hovered_ = node;
    hovered_set_ = node ? context_.edit.taken_by(*node) : IndexSet{};
    context_.canvas.show_cursor(!node                  ? QCursor()
                                : hovered_set_.empty() ? QCursor(Qt::ForbiddenCursor)
                                                       : QCursor(Qt::OpenHandCursor));
    show(context_.document().state().mesh ? context_.document().state().mesh->coordinates() : Coordinates());
    emit hint_changed();
}

bool DragTool::press(const PointerEvent& event) {
    if (context_.drag.is_active()) return true;
    hover(event);
    if (!hovered_ || hovered_set_.empty()) return false;
    const Coordinates& x = context_.document().state().mesh->coordinates();
    held_ = *hovered_;
    held_set_ = hovered_set_;
    from_ = x.row(held_);
    normal_ = context_.edit.boundary().normal(x, held_).transpose();
    grip_ = context_.canvas.to_display(from_) - event.position;
    last_ = event;
    direction_.reset();
    displacement_.setZero();
    is_held_ = true;
    context_.canvas.show_cursor(Qt::ClosedHandCursor);
    dragged_ = context_.edit.dragged(held_set_);
    context_.drag.begin(make_request());
    show(x);
    emit hint_changed();
    return true;
}

DragRequest DragTool::make_request() const {
    const IndexSet& selected = context_.edit.nodes();
    const bool is_selection = std::binary_search(selected.begin(), selected.end(), held_);
    QString name = name_of(context_.edit.settings().unit, held_set_.size(), is_selection);
    if (name.isEmpty())
        name = tr("Drag node %1").arg(context_.document().state().mesh->topology().node_tag(held_).value);
    return {dragged_, ResponseKind::translation, from_.transpose(), name};
}

Eigen::RowVector3d DragTool::constrained(const Eigen::RowVector3d& displacement) const {
    DragDirection direction = direction_.value_or(context_.edit.settings().direction);
    if (!direction_ && last_.modifiers.testFlag(Qt::ShiftModifier)) direction = DragDirection::along_normal;
    Eigen::RowVector3d along = Eigen::RowVector3d::Zero();
    switch (direction) {
        case DragDirection::view_plane:
            return displacement;
        case DragDirection::along_x:
            along[0] = 1.0;
            break;
        case DragDirection::along_y:
            along[1] = 1.0;
            break;
        case DragDirection::along_z:
            along[2] = 1.0;
            break;
        case DragDirection::along_normal:
            along = normal_;
            break;
    }
    if (context_.canvas.is_flat() || along.isZero()) return displacement.dot(along) * along;
    // The point of the axis that shows nearest to the mouse: the axis as it shows decides, not its length in the plane.
    const double unit = 100.0 * context_.canvas.units_per_pixel(from_);
    const QPointF origin = context_.canvas.to_display(from_), tip = context_.canvas.to_display(from_ + unit * along);
    const QPointF way = tip - origin, mouse = last_.position + grip_ - origin;
    const double length = QPointF::dotProduct(way, way);
    return length > 25.0 ? Eigen::RowVector3d(QPointF::dotProduct(mouse, way) / length * unit * along)
                         : Eigen::RowVector3d::Zero();
}

void DragTool::follow() {
    displacement_ = constrained(context_.canvas.to_mesh(last_.position + grip_, from_) - from_);
    const SnapSettings& snap = context_.edit.settings().snap;
    // Ctrl: as free as ever.
    if (snap.target != SnapTarget::nothing && !last_.modifiers.testFlag(Qt::ControlModifier)) {
        displacement_ = snapped(snap, from_ + displacement_) - from_;
        if (context_.canvas.is_flat()) displacement_[2] = 0.0;
    }
    context_.drag.move(AffineMotion::translation(displacement_.transpose()));
    if (!context_.drag.is_live()) show(context_.document().state().mesh->coordinates());
    emit hint_changed();
}

void DragTool::move(const PointerEvent& event) {
    if (!is_held_) return;
    last_ = event;
    follow();
}

void DragTool::release(const PointerEvent& event) {
    if (!is_held_) return;
    last_ = event;
    context_.canvas.show_cursor(Qt::OpenHandCursor);
    context_.drag.finish();
}

bool DragTool::wheel(const PointerEvent& event, double steps) {
    // In hand, or with Shift beside it: the radius.
    const bool is_meant = is_held_ || (event.modifiers.testFlag(Qt::ShiftModifier) && hovered_);
    if (!is_meant || !context_.edit.settings().is_soft) return false;
    EditSettings settings = context_.edit.settings();
    settings.soft.radius = std::max(1e-300, settings.soft.radius * std::pow(1.12, steps));
    context_.edit.set_settings(settings);
    if (is_held_) {
        dragged_ = context_.edit.dragged(held_set_);
        context_.drag.change(make_request());
    }
    refresh();
    return true;
}

bool DragTool::key(int key, Qt::KeyboardModifiers) {
    if (!is_held_) return false;
    const struct {
        int key;
        DragDirection direction;
    } keys[] = {{Qt::Key_X, DragDirection::along_x},
                {Qt::Key_Y, DragDirection::along_y},
                {Qt::Key_Z, DragDirection::along_z},
                {Qt::Key_N, DragDirection::along_normal}};
    for (const auto& entry : keys)
        if (key == entry.key) {
            // The same key again: free.
            direction_ = direction_ == entry.direction ? std::nullopt : std::optional(entry.direction);
            follow();
            return true;
        }
    return false;
}

bool DragTool::cancel() {
    if (!is_held_) return false;
    context_.drag.cancel();
    hovered_.reset();
    hovered_set_.clear();
    context_.canvas.show_cursor({});
    refresh();
    return true;
}

void DragTool::refresh() {
    if (!context_.document().has_mesh()) {
        hovered_.reset();
        hovered_set_.clear();
        context_.canvas.show_marks({}, {});
        return;
    }
    const CurvedMesh& mesh = *context_.document().state().mesh;
    if (hovered_ && *hovered_ >= mesh.topology().node_count()) hovered_.reset();
    if (!is_held_) hovered_set_ = hovered_ ? context_.edit.taken_by(*hovered_) : IndexSet{};
    if (!is_held_ || !context_.drag.is_live()) show(mesh.coordinates());
}

void DragTool::show(const Coordinates& positions) {
    Marks marks;
    add_state_marks(marks, context_.edit, positions);
    if (is_held_ || hovered_) {
        const DraggedSet set = is_held_ ? dragged_ : context_.edit.dragged(hovered_set_);
        for (std::size_t i = 0; i < set.nodes.size(); ++i) {
            const Index node = set.nodes[i];
            const double share = set.weights.empty() ? 1.0 : set.weights[i];
            marks.points.push_back(
                {{positions(node, 0), positions(node, 1), positions(node, 2)}, MarkRole::soft, share});
        }
        const Index node = is_held_ ? held_ : *hovered_;
        Eigen::RowVector3d at = positions.row(node);
        if (is_held_ && !context_.drag.is_live()) at = from_ + displacement_;
        if (is_held_ || !hovered_set_.empty()) marks.points.push_back({{at[0], at[1], at[2]}, MarkRole::hovered, 1.0});
        if (is_held_ && displacement_.norm() > 0.0)
            marks.lines.push_back({{{from_[0], from_[1], from_[2]}, {at[0], at[1], at[2]}}, MarkRole::ghost, 1.0});
    }
    context_.canvas.show_marks(std::move(marks), {});
}

Eigen::Vector3d DragTool::displacement() const {
    return is_held_ ? Eigen::Vector3d(displacement_.transpose()) : Eigen::Vector3d::Zero().eval();
}

QString DragTool::hint() const {
    if (is_held_) {
        const auto component = [this](Eigen::Index d) {
            return format_component(displacement_[d], displacement_.norm());
        };
        QString text = tr("moved (%1, %2").arg(component(0), component(1));
        if (!context_.canvas.is_flat()) text += QStringLiteral(", ") + component(2);
        text += tr(") · X Y Z N: along an axis or the normal");
        if (context_.edit.settings().is_soft) text += tr(" · wheel: radius");
        return text + tr(" · Esc: put back");
    }
    if (hovered_ && hovered_set_.empty()) return tr("This node is pinned.");
    if (hovered_) {
        const QString what = std::binary_search(context_.edit.nodes().begin(), context_.edit.nodes().end(), *hovered_)
                                 ? tr("the selection")
                             : context_.edit.settings().unit == GrabUnit::node ? tr("the node")
                             : context_.edit.settings().unit == GrabUnit::side ? tr("the side")
                                                                               : tr("the boundary");
        return tr("drag: move %1 · Shift+drag: along the normal · Shift+wheel: radius").arg(what);
    }
    return context_.canvas.is_flat()
               ? tr("Drag a boundary node, and the mesh follows. Elsewhere: move the view · "
                    "wheel: zoom · click: what is this element?")
               : tr("Drag a boundary node, and the mesh follows. Elsewhere: turn · Shift: move · wheel: zoom");
}

}  // namespace curvewright
