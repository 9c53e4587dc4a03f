#include "core/edit/boundary_followers.h"

#include "core/base/parallel.h"
#include "core/mesh/renumbering.h"

namespace curvewright {

BoundaryFollowers::BoundaryFollowers(const CurvedMesh& start, const BoundaryRules& rules,
                                     const std::vector<Index>& held) {
    if (rules.is_all_fixed()) return;
    const MeshTopology& topology = start.topology();
    shape_ = std::make_shared<const BoundaryShape>(NumberedAlike(start).mesh(), rules);
    start_ = start.coordinates();
    std::vector<char> is_held(static_cast<std::size_t>(topology.node_count()), 0);
    for (const Index node : held)
        if (node >= 0 && node < topology.node_count()) is_held[static_cast<std::size_t>(node)] = 1;
    for (const Index node : topology.boundary_nodes()) {
        if (is_held[static_cast<std::size_t>(node)] || !shape_->may_move(node)) continue;
        nodes_.push_back(node);
        if (!shape_->slides(node)) {
            projections_.push_back(Eigen::Matrix3d::Identity());
            continue;
        }
        const Eigen::Matrix<double, 3, Eigen::Dynamic> tangents = shape_->tangents(shape_->foot(node));
        projections_.push_back(tangents * tangents.transpose());
        sliding_.push_back(node);
    }
}

void BoundaryFollowers::put_on_boundary(Coordinates& positions) const {
    parallel_for(sliding_.size(), 64, {}, {}, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const Index node = sliding_[i];
            if (positions.row(node) == start_.row(node)) continue;
            const Eigen::Vector3d y = positions.row(node).transpose();
            const Foot foot = shape_->project(y, shape_->foot(node));
            Eigen::Vector3d there = shape_->position(foot);
            if (foot.closest.edge >= 0 || foot.closest.corner >= 0) {
                const auto tangents = shape_->tangents(foot);
                there += tangents * (tangents.transpose() * (y - there));
            }
            positions.row(node) = there.transpose();
        }
    });
}

}  // namespace curvewright
