#include "core/untangle/face_nodes.h"

#include <map>
#include <mutex>

#include "core/basis/lagrange.h"
#include "core/basis/node_ordering.h"
#include "core/basis/reference_element.h"

namespace curvewright {
namespace {

/// The weights of all nodes of a triangle (columns) in the blended position of each of its interior nodes (rows).
Eigen::MatrixXd make_weights(ElementType type) {
    const ElementType line{Shape::line, type.order};
    const ReferenceElement& element = reference_element(type);
    const Eigen::MatrixX3d lattice = reference_nodes(type), line_lattice = reference_nodes(line);
    const auto count = static_cast<Eigen::Index>(element.interior_nodes.size());
    Eigen::MatrixXd weights = Eigen::MatrixXd::Zero(count, node_count(type));
    for (Eigen::Index row = 0; row < count; ++row) {
        const Eigen::RowVector3d at = lattice.row(element.interior_nodes[static_cast<std::size_t>(row)]);
        const std::array<double, 3> l{1.0 - at[0] - at[1], at[0], at[1]};
        for (int corner = 0; corner < 3; ++corner) weights(row, corner) += l[static_cast<std::size_t>(corner)];
        for (const SubElement& edge : element.edges) {
            const double la = l[static_cast<std::size_t>(edge.nodes[0])],
                         lb = l[static_cast<std::size_t>(edge.nodes[1])];
            const double t = 0.5 * (1.0 + lb - la), factor = la * lb / (t * (1.0 - t));
            Eigen::MatrixX3d point = Eigen::MatrixX3d::Zero(1, 3);
            point(0, 0) = t;
            const Eigen::MatrixXd values = lagrange_basis(line, point).values;
            // The deviation: the curve without the straight line between its ends.
            weights(row, edge.nodes[0]) -= factor * (1.0 - t);
            weights(row, edge.nodes[1]) -= factor * t;
            for (std::size_t i = 0; i < edge.nodes.size(); ++i)
                weights(row, edge.nodes[i]) += factor * values(0, static_cast<Eigen::Index>(i));
        }
    }
    return weights;
}

const Eigen::MatrixXd& blending_weights(ElementType type) {
    static std::mutex mutex;
    static std::map<ElementType, Eigen::MatrixXd> tables;
    const std::lock_guard lock(mutex);
    const auto [entry, is_new] = tables.try_emplace(type);
    if (is_new) entry->second = make_weights(type);
    return entry->second;
}

}  // namespace

void place_face_nodes_at_mean(const MeshTopology& topology, Index triangle, Coordinates& x) {
    const ReferenceElement& element = reference_element(topology.element_type(triangle));
    const auto nodes = topology.element_nodes(triangle);
    Eigen::RowVector2d mean = Eigen::RowVector2d::Zero();
    int count = 0;
    for (const SubElement& edge : element.edges)
        for (std::size_t i = 2; i < edge.nodes.size(); ++i, ++count) mean += x.row(nodes[edge.nodes[i]]).head<2>();
    for (const int local : element.interior_nodes) x.row(nodes[local]).head<2>() = mean / count;
}

void blend_face_nodes(const MeshTopology& topology, Index triangle, Coordinates& x) {
    const ElementType type = topology.element_type(triangle);
    if (type.order < 3) return;
    const auto nodes = topology.element_nodes(triangle);
    const Eigen::MatrixXd& weights = blending_weights(type);
    const std::vector<int>& interior = reference_element(type).interior_nodes;
    Eigen::MatrixX2d positions(weights.cols(), 2);
    for (Eigen::Index i = 0; i < weights.cols(); ++i)
        positions.row(i) = x.row(nodes[static_cast<std::size_t>(i)]).head<2>();
    const Eigen::MatrixX2d blended = weights * positions;
    for (std::size_t i = 0; i < interior.size(); ++i)
        x.row(nodes[static_cast<std::size_t>(interior[i])]).head<2>() = blended.row(static_cast<Eigen::Index>(i));
}

}  // namespace curvewright
