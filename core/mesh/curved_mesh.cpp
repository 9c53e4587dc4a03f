#include "core/mesh/curved_mesh.h"

#include <fmt/format.h>

#include "core/base/error.h"

namespace curvewright {

CurvedMesh::CurvedMesh(std::shared_ptr<const MeshTopology> topology, Coordinates coordinates)
    : topology_(std::move(topology)), coordinates_(std::move(coordinates)) {
    if (coordinates_.rows() != topology_->node_count())
        throw InvalidInput(
            fmt::format("The mesh has {} nodes but {} positions.", topology_->node_count(), coordinates_.rows()));
    if (!coordinates_.allFinite())
        for (Index node = 0; node < topology_->node_count(); ++node)
            if (!coordinates_.row(node).allFinite())
                throw InvalidInput(
                    fmt::format("Node {} has a coordinate that is not finite.", topology_->node_tag(node).value));
}

Eigen::MatrixX3d CurvedMesh::element_coordinates(Index element) const {
    const auto nodes = topology_->element_nodes(element);
    Eigen::MatrixX3d x(nodes.size(), 3);
    for (std::size_t i = 0; i < nodes.size(); ++i) x.row(static_cast<Eigen::Index>(i)) = coordinates_.row(nodes[i]);
    return x;
}

Eigen::RowVector3d CurvedMesh::element_center(Index element) const {
    const int corners = corner_count(topology_->element_type(element).shape);
    const auto nodes = topology_->element_nodes(element);
    Eigen::RowVector3d sum = Eigen::RowVector3d::Zero();
    for (int i = 0; i < corners; ++i) sum += coordinates_.row(nodes[i]);
    return sum / corners;
}

Eigen::Matrix<double, 2, 3> bounding_box(const CurvedMesh& mesh) {
    const MeshTopology& topology = mesh.topology();
    if (topology.element_count() == 0) return Eigen::Matrix<double, 2, 3>::Zero();
    const double* x = mesh.coordinates().data();
    const Index first = *topology.element_nodes(0).begin();
    Eigen::Array3d low = mesh.coordinates().row(first).transpose(), high = low;
    for (Index element = 0; element < topology.element_count(); ++element)
        for (const Index node : topology.element_nodes(element)) {
            const Eigen::Map<const Eigen::Array3d> at(x + 3 * static_cast<std::ptrdiff_t>(node));
            low = low.min(at);
            high = high.max(at);
        }
    Eigen::Matrix<double, 2, 3> box;
    box << low.matrix().transpose(), high.matrix().transpose();
    return box;
}

}  // namespace curvewright
