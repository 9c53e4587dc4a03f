#include "core/quality/orientation_signs.h"

#include <algorithm>
#include <array>
#include <map>

#include <Eigen/Geometry>

#include "core/basis/lagrange.h"
#include "core/basis/quadrature.h"
#include "core/mesh/node_elements.h"
#include "core/quality/quality.h"

namespace curvewright {
namespace {

/// Signed areas or volumes of straight-sided elements: those of order 1 on the elements' corners. The base of a
/// pyramid is taken as two triangles.
class StraightVolumes {
  public:
    explicit StraightVolumes(const CurvedMesh& mesh) : mesh_(mesh) {}

    double operator()(Index element) {
        const MeshTopology& topology = mesh_.topology();
        const Shape shape = topology.element_type(element).shape;
        const auto nodes = topology.element_nodes(element);
        if (shape == Shape::pyramid)
            return tetrahedron(nodes[0], nodes[1], nodes[2], nodes[4]) +
                   tetrahedron(nodes[0], nodes[2], nodes[3], nodes[4]);
        const Rule& rule = rule_of(shape);
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

    double tetrahedron(Index a, Index b, Index c, Index d) const {
        const auto from_a = [&](Index node) -> Eigen::RowVector3d {
            return mesh_.coordinates().row(node) - mesh_.coordinates().row(a);
        };
        return from_a(b).cross(from_a(c)).dot(from_a(d)) / 6.0;
    }

    const CurvedMesh& mesh_;
    std::map<Shape, Rule> rules_;
};

/// Elements that hang together by nodes, as the number of the set that each is in.
std::vector<Index> bodies_of(const MeshTopology& topology) {
    const NodeElements node_elements = elements_of_nodes(topology);
    std::vector<Index> body(static_cast<std::size_t>(topology.element_count()), -1), stack;
    for (Index first = 0; first < topology.element_count(); ++first) {
        if (body[first] >= 0) continue;
        stack.assign(1, first);
        body[first] = first;
        while (!stack.empty()) {
            const Index element = stack.back();
            stack.pop_back();
            for (const Index node : topology.element_nodes(element))
                for (const Index other : node_elements.of(node))
                    if (body[other] < 0) {
                        body[other] = first;
                        stack.push_back(other);
                    }
        }
    }
    return body;
}

}  // namespace

OrientationSigns::OrientationSigns(std::vector<signed char> of_parts)
    : sign_(of_parts.empty() ? 1.0 : static_cast<double>(of_parts.front())) {
    const bool is_mixed = std::adjacent_find(of_parts.begin(), of_parts.end(), std::not_equal_to<>()) != of_parts.end();
    if (is_mixed) signs_ = std::make_shared<const std::vector<signed char>>(std::move(of_parts));
}

OrientationSigns orientation_signs(const CurvedMesh& mesh) {
    require_assessable(mesh);
    const MeshTopology& topology = mesh.topology();
    const Winding& winding = topology.winding();
    const auto elements = static_cast<std::size_t>(topology.element_count());
    StraightVolumes volume_of(mesh);
    std::vector<double> volumes(elements), totals(static_cast<std::size_t>(winding.part_count), 0.0);
    std::vector<Index> sizes(totals.size(), 0);
    for (Index element = 0; element < topology.element_count(); ++element) {
        volumes[element] = topology.is_reversed(element) ? -volume_of(element) : volume_of(element);
        totals[winding.part_of_element[element]] += volumes[element];
        ++sizes[winding.part_of_element[element]];
    }
    const auto sign_of = [](double volume) -> signed char { return volume < 0.0 ? -1 : 1; };
    std::vector<signed char> signs(elements);
    for (std::size_t i = 0; i < elements; ++i) signs[i] = sign_of(totals[winding.part_of_element[i]]);
    OrientationSigns of_parts(signs);
    if (!of_parts.is_mixed() || std::find(sizes.begin(), sizes.end(), 1) == sizes.end()) return of_parts;

    const std::vector<Index> body = bodies_of(topology);
    std::vector<double> body_volumes(elements, 0.0);
    for (std::size_t i = 0; i < elements; ++i) body_volumes[body[i]] += volumes[i];
    for (std::size_t i = 0; i < elements; ++i)
        if (sizes[winding.part_of_element[i]] == 1) signs[i] = sign_of(body_volumes[body[i]]);
    return OrientationSigns(std::move(signs));
}

Orientation orientation_of(const OrientationSigns& signs) {
    if (signs.is_mixed()) return Orientation::mixed;
    return signs.of_part(0) < 0.0 ? Orientation::negative : Orientation::positive;
}

Orientation find_orientation(const CurvedMesh& mesh) {
    return orientation_of(orientation_signs(mesh));
}

}  // namespace curvewright
