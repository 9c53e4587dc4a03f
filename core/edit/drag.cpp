#include "core/edit/drag.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include "core/base/error.h"

namespace curvewright {
namespace {

void check_same(const CurvedMesh& mesh, const CurvedMesh& start) {
    if (mesh.shared_topology() != start.shared_topology())
        throw InvalidInput("The weights of a drag belong to another mesh than the one to be moved.");
}

ResponseField make_response(const DragSetup& setup, const Warper& warper, const BoundaryFollowers& followers,
                            const CurvedMesh& start, const WarperSource& warper_of, const TaskContext& context) {
    check_same(warper.mesh(), start);
    BoundaryFollowing following;
    if (!followers.is_empty()) {
        WarpOptions options = warper.options();
        options.following_nodes = followers.nodes();
        following = {warper_of(warper.mesh(), options), followers.nodes(), followers.projections()};
    }
    return {warper, setup.set, setup.kind, setup.origin, start.coordinates(), context, following};
}

BoundaryFollowers make_followers(const DragSetup& setup, const CurvedMesh& start) {
    std::vector<Index> held = setup.set.nodes;
    held.insert(held.end(), setup.pinned.begin(), setup.pinned.end());
    return {start, setup.rules.boundary, held};
}

}  // namespace

Drag::Drag(const DragSetup& setup, std::shared_ptr<const Warper> warper, BoundaryFollowers followers,
           const CurvedMesh& start, std::shared_ptr<const QualityReport> start_quality, const WarperSource& warper_of,
           const TaskContext& context)
    : start_(start),
      start_quality_(std::move(start_quality)),
      warper_(std::move(warper)),
      followers_(std::move(followers)),
      solves_anew_(setup.rules.solves_anew),
      response_(make_response(setup, *warper_, followers_, start, warper_of, context)),
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

Drag::Drag(const DragSetup& setup, const CurvedMesh& base, const CurvedMesh& start,
           std::shared_ptr<const QualityReport> start_quality, const WarperSource& warper_of,
           const TaskContext& context)
    : Drag(setup, warper_of(base, drag_options(setup.options, start.topology(), setup.set.nodes, setup.pinned)),
           make_followers(setup, start), start, std::move(start_quality), warper_of, context) {}

Drag::Drag(std::shared_ptr<const Warper> warper, const DraggedSet& set, ResponseKind kind,
           const Eigen::Vector3d& origin, const CurvedMesh& start, std::shared_ptr<const QualityReport> start_quality,
           const TaskContext& context)
    : Drag(DragSetup{set, kind, origin, {}, {}, {}}, std::move(warper), BoundaryFollowers(), start,
           std::move(start_quality), {}, context) {}

const Coordinates& Drag::move(const AffineMotion& motion) {
    response_.apply(motion, start_.coordinates(), positions_);
    if (followers_.has_sliding()) followers_.put_on_boundary(positions_);
    return positions_;
}

Coordinates Drag::settled(const Coordinates& positions, const WarperSource& warper_of,
                          const TaskContext& context) const {
    if (!needs_settling()) return positions;
    if (solves_anew_) return warper_of(start_, warper_->options())->move(positions, context).coordinates;
    const int dim = start_.topology().dimension();
    MultiVector displacement = MultiVector::Zero(positions.rows(), dim);
    for (const Index node : warper_->given_nodes())
        displacement.row(node) = (positions.row(node) - start_.coordinates().row(node)).head(dim);
    SolveReport report;
    const MultiVector moved = warper_->extend(displacement, report, context);
    Coordinates result = start_.coordinates();
    result.leftCols(dim) += moved;
    for (const Index node : warper_->given_nodes()) result.row(node) = positions.row(node);
    return result;
}

void Drag::certify(const Coordinates& positions, QualityReport& report, const TaskContext& context) const {
    if (!needs_settling()) {
        update_quality(report, start_.topology(), positions, moving_elements_, {}, context);
        return;
    }
    // What is settled may move more than the frames did.
    const MeshTopology& topology = start_.topology();
    std::vector<Index> elements;
    for (Index element = 0; element < topology.element_count(); ++element) {
        const auto nodes = topology.element_nodes(element);
        if (std::any_of(nodes.begin(), nodes.end(),
                        [&](Index node) { return positions.row(node) != start_.coordinates().row(node); }))
            elements.push_back(element);
    }
    std::vector<Index> all;
    std::set_union(elements.begin(), elements.end(), moving_elements_.begin(), moving_elements_.end(),
                   std::back_inserter(all));
    update_quality(report, topology, positions, all, {}, context);
}

WarpOptions drag_options(WarpOptions options, const MeshTopology& topology, const std::vector<Index>& dragged,
                         const std::vector<Index>& pinned) {
    std::vector<Index>& prescribed = options.prescribed_nodes;
    prescribed.clear();
    for (const std::vector<Index>* nodes : {&dragged, &pinned})
        for (const Index node : *nodes)
            if (topology.is_interior_node(node)) prescribed.push_back(node);
    std::sort(prescribed.begin(), prescribed.end());
    prescribed.erase(std::unique(prescribed.begin(), prescribed.end()), prescribed.end());
    return options;
}

}  // namespace curvewright
