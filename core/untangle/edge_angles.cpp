#include "core/untangle/edge_angles.h"

#include <algorithm>
#include <cmath>
#include <map>

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

std::vector<EdgeNode> find_interior_edge_nodes(const MeshTopology& topology) {
    std::map<Index, EdgeNode> found;
    std::map<Index, int> uses;
    for (Index triangle = 0; triangle < topology.element_count(); ++triangle) {
        const auto nodes = topology.element_nodes(triangle);
        const auto& edges = reference_element(topology.element_type(triangle)).edges;
        for (int e = 0; e < static_cast<int>(edges.size()); ++e)
            for (int i = 2; i < static_cast<int>(edges[e].nodes.size()); ++i) {
                const Index node = nodes[edges[e].nodes[i]];
                if (!topology.is_interior_node(node)) continue;
                EdgeNode& edge_node = found[node];
                const int use = uses[node]++;
                if (use > 1)
                    throw Unsupported(fmt::format("The edge of node {} belongs to more than two triangles.",
                                                  topology.node_tag(node).value));
                edge_node.node = node;
                edge_node.triangles[use] = triangle;
                edge_node.local_edges[use] = e;
                if (use == 0) edge_node.position = i;
            }
    }
    std::vector<EdgeNode> result;
    for (const auto& [node, edge_node] : found)
        if (uses[node] == 2) result.push_back(edge_node);
    return result;
}

EdgeAngles::EdgeAngles(const MeshTopology& topology, const Coordinates& x, const EdgeNode& edge_node, double sign) {
    const Index first = edge_node.triangles[0];
    const int first_edge = edge_node.local_edges[0];
    const auto nodes = topology.element_nodes(first);
    const auto& local = edge_nodes(topology, first, first_edge);
    const Eigen::MatrixXd& derivative = end_derivatives(static_cast<int>(local.size()) - 1);
    for (int end = 0; end < 2; ++end) {
        const double direction = end == 0 ? 1.0 : -1.0;
        fixed_[end].setZero();
        for (int i = 0; i < static_cast<int>(local.size()); ++i) {
            const double weight = direction * derivative(end, i);
            if (i == edge_node.position)
                weight_[end] = weight;
            else
                fixed_[end] += weight * x.row(nodes[local[i]]).head<2>().transpose();
        }
    }
    edge_length_ = (x.row(nodes[local[1]]) - x.row(nodes[local[0]])).head<2>().norm();

    for (int side = 0; side < 2; ++side) {
        const Index triangle = edge_node.triangles[side];
        const int edge = edge_node.local_edges[side], next = (edge + 1) % 3, previous = (edge + 2) % 3;
        // In the second triangle the edge usually runs the other way round.
        const Index start = topology.element_nodes(triangle)[edge_nodes(topology, triangle, edge)[0]];
        const bool is_reversed = start != nodes[local[0]];
        for (int end = 0; end < 2; ++end) {
            // At the start of this triangle's edge it is the following edge (v1); at its end it is the preceding one.
            const bool at_own_start = (end == 0) != is_reversed;
            const Eigen::Vector2d other =
                at_own_start ? tangent(topology, x, triangle, previous, 1) : tangent(topology, x, triangle, next, 0);
            other_[2 * side + end] = other.normalized();
            sense_[2 * side + end] = at_own_start ? sign : -sign;
        }
    }
}

std::array<double, 4> EdgeAngles::evaluate(const Eigen::Vector2d& position) const {
    std::array<Eigen::Vector2d, 2> unit;
    for (int end = 0; end < 2; ++end) unit[end] = (fixed_[end] + weight_[end] * position).normalized();
    std::array<double, 4> angles{};
    for (int i = 0; i < 4; ++i) {
        const Eigen::Vector2d& own = unit[i % 2];
        const double cross = sense_[i] * (own[0] * other_[i][1] - own[1] * other_[i][0]);
        const double angle = std::acos(std::clamp(own.dot(other_[i]), -1.0, 1.0));
        angles[i] = cross < 0.0 ? -angle : angle;
    }
    return angles;
}

}  // namespace curvewright
