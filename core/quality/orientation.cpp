#include <algorithm>
#include <map>

#include <fmt/format.h>
#include <Eigen/Geometry>

#include "core/base/error.h"
#include "core/basis/reference_element.h"
#include "core/quality/quality.h"

namespace curvewright {
namespace {

/// Signed area × 2 or volume × 6 of the straight-sided element.
double corner_determinant(const CurvedMesh& mesh, Index element) {
    const auto nodes = mesh.topology().element_nodes(element);
    const auto& x = mesh.coordinates();
    const Eigen::RowVector3d origin = x.row(nodes[0]);
    const Eigen::RowVector3d u = x.row(nodes[1]) - origin, v = x.row(nodes[2]) - origin;
    if (mesh.topology().dimension() == 2) return u[0] * v[1] - u[1] * v[0];
    return u.cross(v).dot(x.row(nodes[3]) - origin);
}

/// For every node of an element, the node that takes its place when corners 1 and 2 are exchanged.
std::vector<int> mirrored_nodes(ElementType type) {
    const ReferenceElement& element = reference_element(type);
    std::vector<int> mirrored;
    for (LatticePoint point : element.lattice) {
        std::swap(point[0], point[1]);
        mirrored.push_back(element.find_node(point));
    }
    return mirrored;
}

}  // namespace

const char* to_string(Validity validity) {
    switch (validity) {
        case Validity::valid:
            return "valid";
        case Validity::invalid:
            return "invalid";
        case Validity::undecided:
            return "undecided";
    }
    return "";
}

const char* to_string(Orientation orientation) {
    switch (orientation) {
        case Orientation::positive:
            return "positive";
        case Orientation::negative:
            return "negative";
        case Orientation::mixed:
            return "mixed";
    }
    return "";
}

void require_assessable(const CurvedMesh& mesh) {
    const MeshTopology& topology = mesh.topology();
    if (topology.dimension() < 2)
        throw Unsupported("The mesh has no elements of dimension 2 or 3; its quality is not defined.");
    for (Index element = 0; element < topology.element_count(); ++element) {
        const Shape shape = topology.element_type(element).shape;
        if (shape != Shape::triangle && shape != Shape::tetrahedron)
            throw Unsupported(
                fmt::format("Element {} is a {}; the scaled Jacobian is available for triangles and "
                            "tetrahedra.",
                            topology.element_tag(element).value, name(shape)));
    }
    if (topology.dimension() == 2 && topology.element_count() > 0) {
        const auto box = bounding_box(mesh);
        const double diagonal = (box.row(1) - box.row(0)).norm();
        if (box(1, 2) - box(0, 2) > 1e-9 * diagonal)
            throw Unsupported(
                fmt::format("The surface mesh is not in a plane of constant z (z goes from {} to {}); 2D "
                            "meshes must be.",
                            box(0, 2), box(1, 2)));
    }
}

Orientation find_orientation(const CurvedMesh& mesh) {
    require_assessable(mesh);
    bool any_positive = false, any_negative = false;
    for (Index element = 0; element < mesh.topology().element_count(); ++element) {
        const double determinant = corner_determinant(mesh, element);
        any_positive = any_positive || determinant > 0.0;
        any_negative = any_negative || determinant < 0.0;
    }
    if (any_negative) return any_positive ? Orientation::mixed : Orientation::negative;
    return Orientation::positive;
}

double orientation_sign(Orientation orientation, const CurvedMesh& mesh) {
    if (orientation != Orientation::mixed) return orientation == Orientation::positive ? 1.0 : -1.0;
    double total = 0.0;
    for (Index element = 0; element < mesh.topology().element_count(); ++element)
        total += corner_determinant(mesh, element);
    return total < 0.0 ? -1.0 : 1.0;
}

CurvedMesh flip_orientation(const CurvedMesh& mesh) {
    require_assessable(mesh);
    MeshData data = mesh.topology().data();
    for (ElementBlock& block : data.blocks) {
        if (dimension(block.type.shape) != mesh.topology().dimension()) continue;
        const std::vector<int> mirrored = mirrored_nodes(block.type);
        const std::vector<Index> old = block.nodes;
        for (std::size_t first = 0; first < old.size(); first += mirrored.size())
            for (std::size_t i = 0; i < mirrored.size(); ++i) block.nodes[first + i] = old[first + mirrored[i]];
    }
    return {std::make_shared<const MeshTopology>(std::move(data)), mesh.coordinates()};
}

}  // namespace curvewright
