#include <array>
#include <map>

#include <fmt/format.h>
#include <Eigen/Geometry>

#include "core/base/error.h"
#include "core/basis/lagrange.h"
#include "core/basis/quadrature.h"
#include "core/basis/reference_element.h"
#include "core/quality/quality.h"

namespace curvewright {
namespace {

/// Signed areas or volumes of straight-sided elements: those of order 1 on the elements' corners.
class StraightVolumes {
  public:
    explicit StraightVolumes(const CurvedMesh& mesh) : mesh_(mesh) {}

    double operator()(Index element) {
        const MeshTopology& topology = mesh_.topology();
        const Rule& rule = rule_of(topology.element_type(element).shape);
        const auto nodes = topology.element_nodes(element);
        const Eigen::RowVector3d origin = mesh_.coordinates().row(nodes[0]);
        double volume = 0.0;
        for (Eigen::Index q = 0; q < rule.weights.size(); ++q) {
            std::array<Eigen::RowVector3d, 3> tangents;
            for (int k = 0; k < topology.dimension(); ++k) {
                const Eigen::MatrixXd& gradient = rule.basis.gradients[static_cast<std::size_t>(k)];
                tangents[k].setZero();
                for (Eigen::Index corner = 1; corner < gradient.cols(); ++corner)
                    tangents[k] += gradient(q, corner) *
                                   (mesh_.coordinates().row(nodes[static_cast<std::size_t>(corner)]) - origin);
            }
            const auto& [u, v, w] = tangents;
            const double jacobian = topology.dimension() == 2 ? u[0] * v[1] - u[1] * v[0] : u.cross(v).dot(w);
            volume += rule.weights[q] * jacobian;
        }
        return volume;
    }

  private:
    struct Rule {
        BasisTable basis;
        Eigen::VectorXd weights;
    };
    /// J of an element of order 1 is constant on a simplex and of degree 2 or less in each direction elsewhere.
    const Rule& rule_of(Shape shape) {
        const auto [entry, is_new] = rules_.try_emplace(shape);
        if (is_new) {
            QuadratureRule points = quadrature(shape, 2);
            if (is_simplex(shape)) {
                const double measure = points.weights.sum();
                points = {Eigen::MatrixX3d::Zero(1, 3), Eigen::VectorXd::Constant(1, measure)};
            }
            entry->second = {lagrange_basis({shape, 1}, points.points), points.weights};
        }
        return entry->second;
    }

    const CurvedMesh& mesh_;
    std::map<Shape, Rule> rules_;
};

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
        if (simplex_factors(shape).empty())
            throw Unsupported(
                fmt::format("Element {} is a {}, whose shape functions are rational; the scaled Jacobian is available "
                            "for triangles, quadrilaterals, tetrahedra, hexahedra and prisms.",
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
    StraightVolumes volume_of(mesh);
    for (Index element = 0; element < mesh.topology().element_count(); ++element) {
        const double volume = volume_of(element);
        any_positive = any_positive || volume > 0.0;
        any_negative = any_negative || volume < 0.0;
    }
    if (any_negative) return any_positive ? Orientation::mixed : Orientation::negative;
    return Orientation::positive;
}

double orientation_sign(Orientation orientation, const CurvedMesh& mesh) {
    if (orientation != Orientation::mixed) return orientation == Orientation::positive ? 1.0 : -1.0;
    StraightVolumes volume_of(mesh);
    double total = 0.0;
    for (Index element = 0; element < mesh.topology().element_count(); ++element) total += volume_of(element);
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
