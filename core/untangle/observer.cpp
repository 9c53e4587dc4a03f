#include "core/untangle/observer.h"

#include <utility>

namespace curvewright {

const char* to_string(StopReason reason) {
    switch (reason) {
        case StopReason::converged:
            return "converged";
        case StopReason::untangled:
            return "untangled";
        case StopReason::pass_limit:
            return "pass limit";
        case StopReason::no_progress:
            return "no progress";
        case StopReason::cancelled:
            return "cancelled";
    }
    return "";
}

const char* untangle_event::to_string(Placement placement) {
    return placement == Placement::straightened ? "straightened" : "put back";
}

void GivenNumbering::on_event(const UntangleEvent& event) {
    UntangleEvent its = event;
    if (auto* started = std::get_if<untangle_event::Started>(&its)) started->mesh = &given_;
    if (auto* certified = std::get_if<untangle_event::PatchCertified>(&its))
        if (given_.topology().is_reversed(certified->worst_element))
            std::swap(certified->worst_point[0], certified->worst_point[1]);
    observer_->on_event(its);
}

untangle_event::NodesPlaced placed_nodes(untangle_event::Placement placement, const Coordinates& before,
                                         const Coordinates& after) {
    untangle_event::NodesPlaced placed{placement, {}, {}};
    for (Eigen::Index node = 0; node < after.rows(); ++node) {
        if (before.row(node) == after.row(node)) continue;
        placed.nodes.push_back(static_cast<Index>(node));
        placed.positions.push_back(position_of(after, static_cast<Index>(node)));
    }
    return placed;
}

}  // namespace curvewright
