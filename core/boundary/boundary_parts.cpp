#include "core/boundary/boundary_parts.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>

#include <Eigen/Geometry>

#include "core/basis/lagrange.h"
#include "core/basis/reference_element.h"
#include "core/boundary/disjoint_sets.h"

namespace curvewright {
namespace {

/// Where facets of a type meet their neighbours, and derivatives of the facet's map there.
struct MeetingPoints {
    std::vector<std::vector<int>> corners;  ///< per meeting point: corners of the facet there (1 in 2D, 2 in 3D)
    BasisTable basis;                       ///< at the meeting points
    std::vector<Eigen::Vector2d> along;     ///< 3D: direction of the edge in reference coordinates
};

const MeetingPoints& meeting_points(ElementType type) {
    thread_local std::map<ElementType, MeetingPoints> cache;
    const auto found = cache.find(type);
    if (found != cache.end()) return found->second;
    MeetingPoints points;
    const Eigen::MatrixX3d nodes = reference_nodes(type);
    Eigen::MatrixX3d at;
    if (type.shape == Shape::line) {
        points.corners = {{0}, {1}};
        at = nodes.topRows(2);
    } else {
        const auto& edges = reference_element(type).edges;
        at.resize(static_cast<Eigen::Index>(edges.size()), 3);
        for (std::size_t e = 0; e < edges.size(); ++e) {
            const int a = edges[e].nodes[0], b = edges[e].nodes[1];
            points.corners.push_back({a, b});
            at.row(static_cast<Eigen::Index>(e)) = 0.5 * (nodes.row(a) + nodes.row(b));
            points.along.emplace_back((nodes.row(b) - nodes.row(a)).head<2>().transpose());
        }
    }
    points.basis = lagrange_basis(type, at);
    return cache.emplace(type, std::move(points)).first->second;
}

Eigen::MatrixX3d positions(const Coordinates& x, std::span<const Index> nodes) {
    Eigen::MatrixX3d result(static_cast<Eigen::Index>(nodes.size()), 3);
    for (std::size_t i = 0; i < nodes.size(); ++i) result.row(static_cast<Eigen::Index>(i)) = x.row(nodes[i]);
    return result;
}

/// Unit direction in which a facet leaves a meeting point: in it, and in 3D across the edge. Zero if there is none.
Eigen::Vector3d leaving_direction(const MeetingPoints& points, const Eigen::MatrixX3d& x, std::size_t at) {
    const auto row = static_cast<Eigen::Index>(at);
    const Eigen::Vector3d du = (points.basis.gradients[0].row(row) * x).transpose();
    if (points.along.empty()) {
        const Eigen::Vector3d direction = at == 0 ? du : -du;
        return direction.norm() > 0.0 ? direction.normalized() : Eigen::Vector3d::Zero().eval();
    }
    const Eigen::Vector3d dv = (points.basis.gradients[1].row(row) * x).transpose();
    const Eigen::Vector3d along = points.along[at][0] * du + points.along[at][1] * dv;
    // Inward in reference coordinates, then perpendicular to the edge in the tangent plane.
    const Eigen::Vector3d inward = -points.along[at][1] * du + points.along[at][0] * dv;
    const double length = along.squaredNorm();
    if (length == 0.0) return Eigen::Vector3d::Zero();
    const Eigen::Vector3d across = inward - inward.dot(along) / length * along;
    return across.norm() > 0.0 ? across.normalized() : Eigen::Vector3d::Zero().eval();
}

}  // namespace

BoundaryParts::BoundaryParts(const CurvedMesh& mesh, double feature_angle) : topology_(mesh.shared_topology()) {
    const MeshTopology& topology = *topology_;
    facet_offsets_.push_back(0);
    node_offsets_.assign(static_cast<std::size_t>(topology.node_count()) + 1, 0);
    if (topology.dimension() < 2) return;
    const auto& facets = topology.boundary_facets();
    for (const Facet& facet : facets) {
        const std::vector<Index> nodes = topology.facet_nodes(facet);
        facet_nodes_.insert(facet_nodes_.end(), nodes.begin(), nodes.end());
        facet_offsets_.push_back(facet_nodes_.size());
        for (Index node : nodes) ++node_offsets_[static_cast<std::size_t>(node) + 1];
    }
    std::partial_sum(node_offsets_.begin(), node_offsets_.end(), node_offsets_.begin());
    node_facets_.resize(facet_nodes_.size());
    std::vector<std::size_t> next(node_offsets_.begin(), node_offsets_.end() - 1);
    for (std::size_t facet = 0; facet < facets.size(); ++facet)
        for (std::size_t i = facet_offsets_[facet]; i < facet_offsets_[facet + 1]; ++i)
            node_facets_[next[static_cast<std::size_t>(facet_nodes_[i])]++] = static_cast<Index>(facet);

    std::vector<double> volumes(static_cast<std::size_t>(topology.winding().part_count), 0.0);
    for (Index element = 0; element < topology.element_count(); ++element) {
        // Signed size of the simplex of the first corner and its neighbours: what the numbering says about the sides.
        const auto nodes = topology.element_nodes(element);
        const auto& x = mesh.coordinates();
        const Shape shape = topology.element_type(element).shape;
        const int up = shape == Shape::tetrahedron || shape == Shape::prism ? 3 : 4;
        const int across =
            shape == Shape::quadrilateral || shape == Shape::hexahedron || shape == Shape::pyramid ? 3 : 2;
        const Eigen::Vector3d a = (x.row(nodes[1]) - x.row(nodes[0])).transpose();
        const Eigen::Vector3d b = (x.row(nodes[static_cast<std::size_t>(across)]) - x.row(nodes[0])).transpose();
        Eigen::Vector3d c = Eigen::Vector3d::UnitZ();
        if (topology.dimension() == 3) c = (x.row(nodes[static_cast<std::size_t>(up)]) - x.row(nodes[0])).transpose();
        const double volume = a.cross(b).dot(c);
        volumes[topology.winding().part_of_element[element]] += topology.is_reversed(element) ? -volume : volume;
    }
    for (const Facet& facet : facets) {
        const bool is_negative = volumes[topology.winding().part_of_element[facet.element]] < 0.0;
        signs_.push_back(is_negative != topology.is_reversed(facet.element) ? -1 : 1);
    }

    DisjointSets components(facets.size()), parts(facets.size());
    struct Meeting {
        std::array<Index, 2> corners;
        int facet, at;
        Eigen::Vector3d leaving;
    };
    std::vector<Meeting> meetings;
    for (std::size_t facet = 0; facet < facets.size(); ++facet) {
        const ElementType type =
            reference_element(topology.element_type(facets[facet].element)).facets[facets[facet].local].type;
        const MeetingPoints& points = meeting_points(type);
        const std::span nodes(facet_nodes_.data() + facet_offsets_[facet],
                              facet_offsets_[facet + 1] - facet_offsets_[facet]);
        const Eigen::MatrixX3d x = positions(mesh.coordinates(), nodes);
        for (std::size_t at = 0; at < points.corners.size(); ++at) {
            std::array<Index, 2> corners{nodes[static_cast<std::size_t>(points.corners[at].front())],
                                         nodes[static_cast<std::size_t>(points.corners[at].back())]};
            std::sort(corners.begin(), corners.end());
            meetings.push_back(
                {corners, static_cast<int>(facet), static_cast<int>(at), leaving_direction(points, x, at)});
        }
        for (Index node : nodes) components.join(static_cast<int>(facet), facets_of_node(node).front());
    }
    std::stable_sort(meetings.begin(), meetings.end(),
                     [](const Meeting& a, const Meeting& b) { return a.corners < b.corners; });
    const double least = std::cos(feature_angle * std::numbers::pi / 180.0);
    for (std::size_t i = 0; i < meetings.size();) {
        std::size_t end = i + 1;
        while (end < meetings.size() && meetings[end].corners == meetings[i].corners) ++end;
        if (end == i + 2 && -meetings[i].leaving.dot(meetings[i + 1].leaving) >= least)
            parts.join(meetings[i].facet, meetings[i + 1].facet);
        else if (topology.dimension() == 3)
            add_feature_edge(meetings[i].facet, meetings[i].at);
        i = end;
    }
    join_feature_edges();
    component_count_ = components.label(component_);
    smooth_part_count_ = parts.label(smooth_part_);
}

void BoundaryParts::add_feature_edge(int facet, int edge) {
    const Facet& its = topology_->boundary_facets()[static_cast<std::size_t>(facet)];
    const ElementType type = reference_element(topology_->element_type(its.element)).facets[its.local].type;
    std::vector<Index> nodes;
    for (const int local : reference_element(type).edges[static_cast<std::size_t>(edge)].nodes)
        nodes.push_back(
            facet_nodes_[facet_offsets_[static_cast<std::size_t>(facet)] + static_cast<std::size_t>(local)]);
    feature_edges_.push_back(std::move(nodes));
}

void BoundaryParts::join_feature_edges() {
    std::map<Index, std::vector<int>> edges_of_end;
    for (std::size_t edge = 0; edge < feature_edges_.size(); ++edge)
        for (int end = 0; end < 2; ++end)
            edges_of_end[feature_edges_[edge][static_cast<std::size_t>(end)]].push_back(static_cast<int>(edge));
    DisjointSets lines(feature_edges_.size());
    for (const auto& [node, edges] : edges_of_end)
        if (edges.size() == 2) lines.join(edges[0], edges[1]);
    lines.label(feature_line_);
}

std::vector<Index> BoundaryParts::feature_line_nodes_around(Index node) const {
    std::vector<int> lines;
    for (std::size_t edge = 0; edge < feature_edges_.size(); ++edge)
        if (std::find(feature_edges_[edge].begin(), feature_edges_[edge].end(), node) != feature_edges_[edge].end())
            lines.push_back(feature_line_[edge]);
    std::vector<Index> nodes;
    for (std::size_t edge = 0; edge < feature_edges_.size(); ++edge)
        if (std::find(lines.begin(), lines.end(), feature_line_[edge]) != lines.end())
            nodes.insert(nodes.end(), feature_edges_[edge].begin(), feature_edges_[edge].end());
    std::sort(nodes.begin(), nodes.end());
    nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
    return nodes;
}

std::span<const Index> BoundaryParts::facets_of_node(Index node) const {
    if (node < 0 || static_cast<std::size_t>(node) + 1 >= node_offsets_.size()) return {};
    const auto at = static_cast<std::size_t>(node);
    return std::span(node_facets_).subspan(node_offsets_[at], node_offsets_[at + 1] - node_offsets_[at]);
}

std::vector<Index> BoundaryParts::facet_nodes(Index facet) const {
    const auto at = static_cast<std::size_t>(facet);
    return {facet_nodes_.begin() + static_cast<std::ptrdiff_t>(facet_offsets_[at]),
            facet_nodes_.begin() + static_cast<std::ptrdiff_t>(facet_offsets_[at + 1])};
}

std::vector<Index> BoundaryParts::collect(const std::vector<int>& labels, int label) const {
    std::vector<Index> nodes;
    for (std::size_t facet = 0; facet < labels.size(); ++facet)
        if (labels[facet] == label)
            nodes.insert(nodes.end(), facet_nodes_.begin() + static_cast<std::ptrdiff_t>(facet_offsets_[facet]),
                         facet_nodes_.begin() + static_cast<std::ptrdiff_t>(facet_offsets_[facet + 1]));
    std::sort(nodes.begin(), nodes.end());
    nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
    return nodes;
}

std::vector<Index> BoundaryParts::smooth_nodes_around(Index node) const {
    std::vector<int> parts;
    for (Index facet : facets_of_node(node)) parts.push_back(smooth_part_[static_cast<std::size_t>(facet)]);
    std::sort(parts.begin(), parts.end());
    parts.erase(std::unique(parts.begin(), parts.end()), parts.end());
    std::vector<Index> nodes;
    for (int part : parts) {
        const std::vector<Index> more = smooth_part_nodes(part);
        nodes.insert(nodes.end(), more.begin(), more.end());
    }
    std::sort(nodes.begin(), nodes.end());
    nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
    return nodes;
}

std::vector<Index> BoundaryParts::component_nodes_around(Index node) const {
    const auto facets = facets_of_node(node);
    if (facets.empty()) return {};
    return component_nodes(component_[static_cast<std::size_t>(facets.front())]);
}

Eigen::Vector3d BoundaryParts::normal(const Coordinates& x, Index node) const {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (Index facet : facets_of_node(node)) {
        const Facet& its = topology_->boundary_facets()[static_cast<std::size_t>(facet)];
        const ElementType type = reference_element(topology_->element_type(its.element)).facets[its.local].type;
        const std::vector<Index> nodes = facet_nodes(facet);
        const auto local = std::find(nodes.begin(), nodes.end(), node) - nodes.begin();
        const BasisTable basis = lagrange_basis(type, reference_nodes(type).row(local));
        const Eigen::MatrixX3d at = positions(x, nodes);
        const Eigen::Vector3d du = (basis.gradients[0] * at).transpose();
        Eigen::Vector3d dv = Eigen::Vector3d::UnitZ();
        if (type.shape != Shape::line) dv = (basis.gradients[1] * at).transpose();
        sum += signs_[static_cast<std::size_t>(facet)] * du.cross(dv).normalized();
    }
    return sum.norm() > 1e-9 ? Eigen::Vector3d(sum.normalized()) : Eigen::Vector3d::Zero().eval();
}

}  // namespace curvewright
