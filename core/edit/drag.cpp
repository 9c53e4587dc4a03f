#include "core/edit/drag.h"

#include "core/base/error.h"

namespace curvewright {
namespace {

ResponseField make_response(const Warper& warper, const DraggedSet& set, ResponseKind kind,
                            const Eigen::Vector3d& origin, const CurvedMesh& start, const TaskContext& context) {
    if (warper.mesh().shared_topology() != start.shared_topology())
        throw InvalidInput("The weights of a drag belong to another mesh than the one to be moved.");
    return {warper, set, kind, origin, start.coordinates(), context};
}

}  // namespace

Drag::Drag(std::shared_ptr<const Warper> warper, const DraggedSet& set, ResponseKind kind,
           const Eigen::Vector3d& origin, const CurvedMesh& start, std::shared_ptr<const QualityReport> start_quality,
           const TaskContext& context)
    : start_(start),
      start_quality_(std::move(start_quality)),
      response_(make_response(*warper, set, kind, origin, start, context)),
      positions_(start.coordinates()) {
    const MeshTopology& topology = start_.topology();
    std::vector<char> moves(static_cast<std::size_t>(topology.node_count()), 0);
    for (Index node : response_.moving_nodes()) moves[static_cast<std::size_t>(node)] = 1;
    for (Index element = 0; element < topology.element_count(); ++element)
        for (Index node : topology.element_nodes(element))
            if (moves[static_cast<std::size_t>(node)]) {
                moving_elements_.push_back(element);
                break;
            }
}

const Coordinates& Drag::move(const AffineMotion& motion) {
    response_.apply(motion, start_.coordinates(), positions_);
    return positions_;
}

void Drag::certify(const Coordinates& positions, QualityReport& report, const TaskContext& context) const {
    update_quality(report, start_.topology(), positions, moving_elements_, {}, context);
}

}  // namespace curvewright
