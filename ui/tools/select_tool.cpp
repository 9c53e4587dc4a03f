#include "ui/tools/select_tool.h"

#include <algorithm>

namespace curvewright {
namespace {

constexpr double node_reach = 9.0;    ///< pixels
constexpr double drawing_from = 5.0;  ///< pixels that a click may wander

}  // namespace

void SelectTool::enter() {
    context_.canvas.show_cursor(Qt::CrossCursor);
    refresh();
}

void SelectTool::leave() {
    hovered_ = {};
    is_drawing_ = false;
    context_.canvas.show_marks({}, {});
    context_.canvas.show_cursor({});
}

SelectTool::Found SelectTool::found_at(QPointF position) const {
    const MeshDocument& document = context_.document();
    if (!document.has_mesh()) return {};
    const MeshTopology& topology = document.state().mesh->topology();
    const SelectSettings& settings = context_.edit.settings().select;
    if (settings.what != SelectWhat::elements) {
        const auto node = context_.canvas.node_at(position, node_reach, [&](Index candidate) {
            return settings.what == SelectWhat::nodes || topology.is_boundary_node(candidate);
        });
        if (node) return {{*node}, {}};
        if (settings.what == SelectWhat::nodes) return {};
    }
    if (const auto element = context_.canvas.element_at(position)) return {{}, {*element}};
    return {};
}

void SelectTool::hover(const std::optional<PointerEvent>& event) {
    if (is_drawing_) return;
    Found found = event ? found_at(event->position) : Found{};
    if (found == hovered_) return;
    hovered_ = std::move(found);
    clicks_ = 0;
    refresh();
}

bool SelectTool::press(const PointerEvent& event) {
    is_drawing_ = true;
    path_ = {event.position};
    return true;
}

void SelectTool::move(const PointerEvent& event) {
    if (!is_drawing_) return;
    const QPointF way = event.position - path_.back();
    if (std::hypot(way.x(), way.y()) < 2.0) return;
    path_.push_back(event.position);
    refresh();
}

std::vector<QPointF> SelectTool::outline() const {
    const bool is_click = std::all_of(path_.begin(), path_.end(), [this](const QPointF& point) {
        return (point - path_.front()).manhattanLength() < drawing_from;
    });
    if (!is_drawing_ || is_click) return {};
    if (context_.edit.settings().select.is_lasso) return path_;
    const QPointF a = path_.front(), b = path_.back();
    return {a, {b.x(), a.y()}, b, {a.x(), b.y()}};
}

void SelectTool::take(const Found& found, Qt::KeyboardModifiers modifiers) {
    EditState& edit = context_.edit;
    if (modifiers.testFlag(Qt::ShiftModifier))
        edit.select(united(edit.nodes(), found.nodes), united(edit.elements(), found.elements));
    else if (modifiers.testFlag(Qt::ControlModifier))
        edit.select(toggled(edit.nodes(), found.nodes), toggled(edit.elements(), found.elements));
    else
        edit.select(found.nodes, found.elements);
}

void SelectTool::release(const PointerEvent& event) {
    if (!is_drawing_) return;
    const std::vector<QPointF> polygon = outline();
    is_drawing_ = false;
    if (!context_.document().has_mesh()) return;
    const MeshTopology& topology = context_.document().state().mesh->topology();
    const SelectSettings& settings = context_.edit.settings().select;
    if (polygon.empty()) {
        Found found = found_at(event.position);
        // Again at the same node: what it is part of.
        ++clicks_;
        if (!found.nodes.empty() && topology.is_boundary_node(found.nodes.front()) && clicks_ > 1)
            found.nodes = clicks_ == 2 ? context_.edit.boundary().smooth_nodes_around(found.nodes.front())
                                       : context_.edit.boundary().component_nodes_around(found.nodes.front());
        take(found, clicks_ > 1 && event.modifiers.testFlag(Qt::ControlModifier) ? Qt::ShiftModifier : event.modifiers);
    } else {
        Found found;
        if (settings.what != SelectWhat::elements)
            for (const Index node : context_.canvas.nodes_inside(polygon, settings.sees_through))
                if (settings.what == SelectWhat::nodes || topology.is_boundary_node(node)) found.nodes.push_back(node);
        if (settings.what == SelectWhat::elements)
            found.elements = context_.canvas.elements_inside(polygon, settings.sees_through);
        clicks_ = 0;
        take(found, event.modifiers);
    }
    refresh();
    emit hint_changed();
}

bool SelectTool::cancel() {
    if (is_drawing_) {
        is_drawing_ = false;
        refresh();
        return true;
    }
    if (context_.edit.nodes().empty() && context_.edit.elements().empty()) return false;
    context_.edit.select({}, {});
    return true;
}

void SelectTool::refresh() {
    if (!context_.document().has_mesh()) {
        hovered_ = {};
        context_.canvas.show_marks({}, {});
        return;
    }
    const Coordinates& positions = context_.document().state().mesh->coordinates();
    std::erase_if(hovered_.nodes, [&](Index node) { return node >= positions.rows(); });
    Marks marks;
    add_state_marks(marks, context_.edit, positions);
    add_points(marks, hovered_.nodes, positions, MarkRole::hovered);
    context_.canvas.show_marks(std::move(marks), outline());
}

QString SelectTool::hint() const {
    const SelectSettings& settings = context_.edit.settings().select;
    return tr("click: select %1, again: its side, its boundary · drag: %2 · Shift: add · Ctrl: add or take away · "
              "other buttons: the view · Esc: nothing")
        .arg(settings.what == SelectWhat::elements ? tr("an element") : tr("a node"),
             settings.is_lasso ? tr("lasso") : tr("box"));
}

}  // namespace curvewright
