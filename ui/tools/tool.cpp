#include "ui/tools/tool.h"

#include <algorithm>
#include <cmath>

namespace curvewright {

void add_points(Marks& marks, const IndexSet& nodes, const Coordinates& positions, MarkRole role) {
    for (Index node : nodes)
        marks.points.push_back({{positions(node, 0), positions(node, 1), positions(node, 2)}, role, 1.0});
}

void add_state_marks(Marks& marks, const EditState& edit, const Coordinates& positions) {
    const Spokes& spokes = edit.spokes();
    if (spokes.node && *spokes.node < positions.rows()) {
        double largest = 0.0;
        for (const double weight : spokes.weights) largest = std::max(largest, std::abs(weight));
        const auto at = [&](Index node) {
            return std::array<double, 3>{positions(node, 0), positions(node, 1), positions(node, 2)};
        };
        for (std::size_t i = 0; i < spokes.neighbours.size(); ++i)
            marks.lines.push_back({{at(*spokes.node), at(spokes.neighbours[i])},
                                   MarkRole::spoke,
                                   largest > 0.0 ? spokes.weights[i] / largest : 0.0});
    }
    add_points(marks, edit.nodes(), positions, MarkRole::selected);
    add_points(marks, edit.pins(), positions, MarkRole::pinned);
}

}  // namespace curvewright
