#include "core/warp/straight_start.h"

#include <map>

#include "core/basis/lagrange.h"
#include "core/mesh/renumbering.h"

namespace curvewright {
namespace {

/// The mesh with every node at the affine (multilinear) image of its lattice point.
CurvedMesh straight_sided(const CurvedMesh& mesh) {
    const MeshTopology& topology = mesh.topology();
    Coordinates x = mesh.coordinates();
    std::map<ElementType, Eigen::MatrixXd> shapes;  // nodes × corners
    for (Index element = 0; element < topology.element_count(); ++element) {
        const ElementType type = topology.element_type(element);
        if (type.order == 1) continue;
        Eigen::MatrixXd& shape = shapes[type];
        if (shape.size() == 0) shape = lagrange_basis({type.shape, 1}, reference_nodes(type)).values;
        const auto nodes = topology.element_nodes(element);
        for (Eigen::Index i = shape.cols(); i < shape.rows(); ++i) {
            Eigen::RowVector3d position = Eigen::RowVector3d::Zero();
            for (Eigen::Index corner = 0; corner < shape.cols(); ++corner)
                position += shape(i, corner) * mesh.coordinates().row(nodes[corner]);
            // A plane mesh keeps its z exactly.
            if (topology.dimension() < 3) position[2] = mesh.coordinates()(nodes[i], 2);
            x.row(nodes[i]) = position;
        }
    }
    return mesh.with_coordinates(std::move(x));
}

}  // namespace

WarpResult warp_from_straight(const CurvedMesh& mesh, const WarpOptions& options, const TaskContext& context) {
    WarpOptions with_interfaces = options;
    for (const Index node : mesh.topology().interface_nodes()) with_interfaces.prescribed_nodes.push_back(node);
    return warp(straight_sided(NumberedAlike(mesh).mesh()), mesh.coordinates(), with_interfaces, context);
}

}  // namespace curvewright
