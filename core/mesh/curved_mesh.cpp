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
    Eigen::Matrix<double, 2, 3> box = Eigen::Matrix<double, 2, 3>::Zero();
    bool is_first = true;
    for (Index element = 0; element < mesh.topology().element_count(); ++element)
        for (Index node : mesh.topology().element_nodes(element)) {
            const auto x = mesh.coordinates().row(node);
            box.row(0) = is_first ? Eigen::RowVector3d(x) : Eigen::RowVector3d(box.row(0).cwiseMin(x));
            box.row(1) = is_first ? Eigen::RowVector3d(x) : Eigen::RowVector3d(box.row(1).cwiseMax(x));
            is_first = false;
        }
    return box;
}

}  // namespace curvewright
