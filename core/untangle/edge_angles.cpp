#include "core/untangle/edge_angles.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include <fmt/format.h>

#include "core/base/error.h"
#include "core/basis/lagrange.h"
#include "core/basis/reference_element.h"

namespace curvewright {
namespace {

/// Derivatives of the shape functions of an edge at its start and end: 2 × (order + 1).
const Eigen::MatrixXd& end_derivatives(int order) {
    static const auto tables = [] {
        std::array<Eigen::MatrixXd, max_order + 1> built;
        Eigen::MatrixX3d ends = Eigen::MatrixX3d::Zero(2, 3);
        ends(1, 0) = 1.0;
        for (int p = 1; p <= max_order; ++p) built[p] = lagrange_basis({Shape::line, p}, ends).gradients[0];
        return built;
    }();
    return tables[order];
}

const std::vector<int>& edge_nodes(const MeshTopology& topology, Index triangle, int local_edge) {
    return reference_element(topology.element_type(triangle)).edges[local_edge].nodes;
}

/// Tangent that leaves the start (end = 0) or the end (end = 1) of a triangle's edge.
Eigen::Vector2d tangent(const MeshTopology& topology, const Coordinates& x, Index triangle, int local_edge, int end) {
    const auto nodes = topology.element_nodes(triangle);
    const auto& local = edge_nodes(topology, triangle, local_edge);
    const Eigen::MatrixXd& derivative = end_derivatives(static_cast<int>(local.size()) - 1);
    Eigen::Vector2d sum = Eigen::Vector2d::Zero();
    for (std::size_t i = 0; i < local.size(); ++i)
        sum += derivative(end, static_cast<Eigen::Index>(i)) * x.row(nodes[local[i]]).head<2>().transpose();
    return end == 0 ? sum : Eigen::Vector2d(-sum);
}

}  // namespace

std::vector<InteriorEdge> find_interior_edges(const MeshTopology& topology) {
    std::vector<InteriorEdge> found;
    std::map<Index, std::pair<std::size_t, int>> of_node;  // least node of an edge to its place and its uses
    for (Index triangle = 0; triangle < topology.element_count(); ++triangle) {
        const auto nodes = topology.element_nodes(triangle);
        const auto& edges = reference_element(topology.element_type(triangle)).edges;
        for (int e = 0; e < static_cast<int>(edges.size()); ++e) {
            std::vector<Index> inner;
            for (std::size_t i = 2; i < edges[e].nodes.size(); ++i) inner.push_back(nodes[edges[e].nodes[i]]);
            if (inner.empty() || !topology.is_interior_node(inner[0]) || topology.is_interface_node(inner[0])) continue;
            const Index least = *std::min_element(inner.begin(), inner.end());
            const auto [entry, is_new] = of_node.try_emplace(least, found.size(), 0);
            auto& [place, uses] = entry->second;
            if (is_new) found.emplace_back().nodes = std::move(inner);
            if (uses > 1)
                throw Unsupported(fmt::format("The edge of node {} belongs to more than two triangles.",
                                              topology.node_tag(least).value));
            found[place].triangles[uses] = triangle;
            found[place].local_edges[uses] = e;
            ++uses;
        }
    }
    return found;
}

std::optional<InteriorEdge> find_interior_edge(const MeshTopology& topology, std::array<Index, 2> triangles,
                                               Index node) {
    std::sort(triangles.begin(), triangles.end());
    InteriorEdge edge{triangles, {-1, -1}, {}};
    for (int side = 0; side < 2; ++side) {
        const auto nodes = topology.element_nodes(triangles[side]);
        const auto& edges = reference_element(topology.element_type(triangles[side])).edges;
        for (int e = 0; e < static_cast<int>(edges.size()); ++e) {
            std::vector<Index> inner;
            for (std::size_t i = 2; i < edges[e].nodes.size(); ++i) inner.push_back(nodes[edges[e].nodes[i]]);
            if (std::find(inner.begin(), inner.end(), node) == inner.end()) continue;
            edge.local_edges[side] = e;
            if (side == 0) edge.nodes = std::move(inner);
        }
        if (edge.local_edges[side] < 0) return std::nullopt;
    }
    return edge;
}

std::vector<EdgeNode> find_interior_edge_nodes(const MeshTopology& topology) {
    std::vector<EdgeNode> result;
    for (const InteriorEdge& edge : find_interior_edges(topology))
        for (std::size_t i = 0; i < edge.nodes.size(); ++i)
            result.push_back({edge.nodes[i], edge.triangles, edge.local_edges, static_cast<int>(i) + 2});
    std::sort(result.begin(), result.end(), [](const EdgeNode& a, const EdgeNode& b) { return a.node < b.node; });
    return result;
}

EdgeTangents::EdgeTangents(const MeshTopology& topology, const Coordinates& x, const std::array<Index, 2>& triangles,
                           const std::array<int, 2>& local_edges, const std::vector<int>& positions,
                           const OrientationSigns& signs) {
    const auto nodes = topology.element_nodes(triangles[0]);
    const auto& local = edge_nodes(topology, triangles[0], local_edges[0]);
    const Eigen::MatrixXd& derivative = end_derivatives(static_cast<int>(local.size()) - 1);
    for (int end = 0; end < 2; ++end) {
        const double direction = end == 0 ? 1.0 : -1.0;
        fixed[end].setZero();
        weights[end].resize(static_cast<Eigen::Index>(positions.size()));
        for (int i = 0; i < static_cast<int>(local.size()); ++i) {
            const double weight = direction * derivative(end, i);
            const auto variable = std::find(positions.begin(), positions.end(), i);
            if (variable != positions.end())
                weights[end][variable - positions.begin()] = weight;
            else
                fixed[end] += weight * x.row(nodes[local[i]]).head<2>().transpose();
        }
    }
    edge_length = (x.row(nodes[local[1]]) - x.row(nodes[local[0]])).head<2>().norm();

    for (int side = 0; side < 2; ++side) {
        const Index triangle = triangles[side];
        const int edge = local_edges[side], next = (edge + 1) % 3, previous = (edge + 2) % 3;
        // In the second triangle the edge usually runs the other way round.
        const Index start = topology.element_nodes(triangle)[edge_nodes(topology, triangle, edge)[0]];
        const bool is_reversed = start != nodes[local[0]];
        const double sign = signs.of_element(topology, triangle);
        for (int end = 0; end < 2; ++end) {
            // At the start of this triangle's edge it is the following edge (v1); at its end it is the preceding one.
            const bool at_own_start = (end == 0) != is_reversed;
            const Eigen::Vector2d other =
                at_own_start ? tangent(topology, x, triangle, previous, 1) : tangent(topology, x, triangle, next, 0);
            others[2 * side + end] = other.normalized();
            senses[2 * side + end] = at_own_start ? sign : -sign;
        }
    }
}

EdgeAngles::EdgeAngles(const MeshTopology& topology, const Coordinates& x, const EdgeNode& edge_node,
                       const OrientationSigns& signs)
    : tangents_(topology, x, edge_node.triangles, edge_node.local_edges, {edge_node.position}, signs),
      weight_{tangents_.weights[0][0], tangents_.weights[1][0]} {}

std::array<double, 4> EdgeAngles::evaluate(const Eigen::Vector2d& position) const {
    std::array<Eigen::Vector2d, 2> unit;
    for (int end = 0; end < 2; ++end) unit[end] = (tangents_.fixed[end] + weight_[end] * position).normalized();
    std::array<double, 4> angles{};
    for (int i = 0; i < 4; ++i) {
        const Eigen::Vector2d &own = unit[i % 2], &other = tangents_.others[i];
        const double cross = tangents_.senses[i] * (own[0] * other[1] - own[1] * other[0]);
        const double angle = std::acos(std::clamp(own.dot(other), -1.0, 1.0));
        angles[i] = cross < 0.0 ? -angle : angle;
    }
    return angles;
}

namespace {

std::vector<int> all_inner_positions(const InteriorEdge& edge) {
    std::vector<int> positions(edge.nodes.size());
    std::iota(positions.begin(), positions.end(), 2);
    return positions;
}

}  // namespace

UnsignedAngleSum::UnsignedAngleSum(const MeshTopology& topology, const Coordinates& x, const InteriorEdge& edge)
    : tangents_(topology, x, edge.triangles, edge.local_edges, all_inner_positions(edge), 1.0) {}

Eigen::Vector2d UnsignedAngleSum::tangent(const Eigen::VectorXd& variables, int end) const {
    const Eigen::Map<const Eigen::Matrix2Xd> nodes(variables.data(), 2, variables.size() / 2);
    return tangents_.fixed[end] + nodes * tangents_.weights[end];
}

std::array<double, 4> UnsignedAngleSum::angles(const Eigen::VectorXd& variables) const {
    const std::array<Eigen::Vector2d, 2> own{tangent(variables, 0), tangent(variables, 1)};
    std::array<double, 4> result{};
    for (int i = 0; i < 4; ++i) {
        const Eigen::Vector2d &t = own[i % 2], &other = tangents_.others[i];
        // More accurate near 0 and pi than the arc cosine of the thesis, and the same elsewhere.
        result[i] = std::atan2(std::abs(t[0] * other[1] - t[1] * other[0]), t.dot(other));
    }
    return result;
}

double UnsignedAngleSum::evaluate(const Eigen::VectorXd& variables) const {
    double sum = 0.0;
    for (const double angle : angles(variables)) sum += angle;
    return sum;
}

double UnsignedAngleSum::evaluate(const Eigen::VectorXd& variables, Eigen::VectorXd& gradient) const {
    gradient.setZero(variables.size());
    Eigen::Map<Eigen::Matrix2Xd> by_node(gradient.data(), 2, variables.size() / 2);
    for (int end = 0; end < 2; ++end) {
        const Eigen::Vector2d t = tangent(variables, end);
        const double square = t.squaredNorm();
        if (!(square > 0.0)) continue;
        double turn = 0.0;  // +1 for each angle that shrinks when the tangent turns to the left
        for (const int i : {end, end + 2}) {
            const double cross = t[0] * tangents_.others[i][1] - t[1] * tangents_.others[i][0];
            turn += cross > 0.0 ? 1.0 : cross < 0.0 ? -1.0 : 0.0;
        }
        by_node += (turn / square) * Eigen::Vector2d(t[1], -t[0]) * tangents_.weights[end].transpose();
    }
    return evaluate(variables);
}

Eigen::VectorXd UnsignedAngleSum::difference_gradient(const Eigen::VectorXd& variables, double step) const {
    Eigen::VectorXd gradient(variables.size()), x = variables;
    for (Eigen::Index i = 0; i < x.size(); ++i) {
        const auto difference = [&](double multiple) {
            x[i] = variables[i] + multiple * step;
            const double ahead = evaluate(x);
            x[i] = variables[i] - multiple * step;
            const double behind = evaluate(x);
            x[i] = variables[i];
            return ahead - behind;
        };
        gradient[i] = (45.0 * difference(1.0) - 9.0 * difference(2.0) + difference(3.0)) / (60.0 * step);
    }
    return gradient;
}

}  // namespace curvewright
