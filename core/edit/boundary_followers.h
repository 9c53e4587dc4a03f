#pragma once

#include <memory>
#include <vector>

#include "core/boundary/boundary_rules.h"
#include "core/boundary/boundary_shape.h"
#include "core/warp/response.h"

namespace curvewright {

/// The boundary nodes that are not in hand but may move when others are dragged: those that slide along the boundary as
/// it was when the drag began, and those that are free.
class BoundaryFollowers {
  public:
    BoundaryFollowers() = default;
    /// start: where the drag begins. held: nodes that are dragged or stay. Throws like resolve(BoundaryRules, ...).
    BoundaryFollowers(const CurvedMesh& start, const BoundaryRules& rules, const std::vector<Index>& held);

    /// Ascending.
    const std::vector<Index>& nodes() const { return nodes_; }
    bool is_empty() const { return nodes_.empty(); }
    bool has_sliding() const { return !sliding_.empty(); }
    /// Onto the tangents that a node slides along, or the identity for one that is free; in the order of nodes().
    const std::vector<Eigen::Matrix3d>& projections() const { return projections_; }

    /// Puts the sliding nodes, which a motion takes along their tangents, on the boundary: each on the closest point of
    /// its smooth part, which goes on straight where it ends (an end that is dragged away makes it longer). positions:
    /// nodes × 3.
    void put_on_boundary(Coordinates& positions) const;

  private:
    std::shared_ptr<const BoundaryShape> shape_;
    std::vector<Index> nodes_, sliding_;
    std::vector<Eigen::Matrix3d> projections_;
    Coordinates start_;
};

}  // namespace curvewright
