#include "ui/tools/tool.h"

namespace curvewright {

void add_points(Marks& marks, const IndexSet& nodes, const Coordinates& positions, MarkRole role) {
    for (Index node : nodes)
        marks.points.push_back({{positions(node, 0), positions(node, 1), positions(node, 2)}, role, 1.0});
}

void add_state_marks(Marks& marks, const EditState& edit, const Coordinates& positions) {
    add_points(marks, edit.nodes(), positions, MarkRole::selected);
    add_points(marks, edit.pins(), positions, MarkRole::pinned);
}

}  // namespace curvewright
