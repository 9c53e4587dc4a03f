#include "ui/tools/pin_tool.h"

#include <algorithm>

namespace curvewright {
namespace {

constexpr double reach = 12.0;  ///< pixels

}  // namespace

void PinTool::enter() {
    context_.canvas.show_cursor(Qt::PointingHandCursor);
    refresh();
}

void PinTool::leave() {
    hovered_.reset();
    context_.canvas.show_marks({}, {});
    context_.canvas.show_cursor({});
}

IndexSet PinTool::unit_around(Index node) const {
    EditState& edit = context_.edit;
    if (std::binary_search(edit.nodes().begin(), edit.nodes().end(), node)) return edit.nodes();
    const bool is_boundary = context_.document().state().mesh->topology().is_boundary_node(node);
    if (is_boundary && edit.settings().unit == GrabUnit::side) return edit.boundary().smooth_nodes_around(node);
    if (is_boundary && edit.settings().unit == GrabUnit::boundary) return edit.boundary().component_nodes_around(node);
    return {node};
}

void PinTool::hover(const std::optional<PointerEvent>& event) {
    std::optional<Index> node;
    if (event && context_.document().has_mesh())
        node = context_.canvas.node_at(event->position, reach, [](Index) { return true; });
    if (node == hovered_) return;
    hovered_ = node;
    refresh();
}

bool PinTool::press(const PointerEvent& event) {
    hover(event);
    if (!hovered_) return false;
    EditState& edit = context_.edit;
    const IndexSet unit = unit_around(*hovered_);
    const bool is_pinned = std::binary_search(edit.pins().begin(), edit.pins().end(), *hovered_);
    edit.set_pins(is_pinned ? without(edit.pins(), unit) : united(edit.pins(), unit));
    return true;
}

void PinTool::refresh() {
    if (!context_.document().has_mesh()) {
        hovered_.reset();
        context_.canvas.show_marks({}, {});
        return;
    }
    const Coordinates& positions = context_.document().state().mesh->coordinates();
    if (hovered_ && *hovered_ >= positions.rows()) hovered_.reset();
    Marks marks;
    add_state_marks(marks, context_.edit, positions);
    if (hovered_) add_points(marks, unit_around(*hovered_), positions, MarkRole::hovered);
    context_.canvas.show_marks(std::move(marks), {});
}

QString PinTool::hint() const {
    return tr("click a node: it stays whatever is dragged; again: it is free. Elsewhere the mouse moves the view");
}

}  // namespace curvewright
