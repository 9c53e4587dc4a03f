#pragma once

#include <array>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "core/mesh/curved_mesh.h"
#include "core/quality/orientation_signs.h"

namespace curvewright {

/// An edge between two triangles of a 2D mesh.
struct InteriorEdge {
    std::array<Index, 2> triangles{};  ///< ascending
    std::array<int, 2> local_edges{};  ///< the edge's number in each
    std::vector<Index> nodes;          ///< its high-order nodes, from its start to its end in triangles[0]
};

/// All interior edges that have high-order nodes, in ascending order of their first triangle and its local edges.
/// Throws Unsupported if an edge belongs to more than two triangles.
std::vector<InteriorEdge> find_interior_edges(const MeshTopology& topology);

/// The interior edge with a given high-order node, between two triangles in any order. None if the node is on no edge
/// that the two share.
std::optional<InteriorEdge> find_interior_edge(const MeshTopology& topology, std::array<Index, 2> triangles,
                                               Index node);

/// A high-order node on an interior edge of a 2D mesh of triangles.
struct EdgeNode {
    Index node = 0;
    std::array<Index, 2> triangles{};  ///< the two that share the edge
    std::array<int, 2> local_edges{};  ///< the edge's number in each
    int position = 0;                  ///< the node's position in the edge of triangles[0]
};

/// All high-order nodes of the interior edges, in ascending order of the nodes. Throws like find_interior_edges.
std::vector<EdgeNode> find_interior_edge_nodes(const MeshTopology& topology);

/// The tangents that the angles at the ends of a curved edge are made of, as functions of the positions of some of the
/// edge's own nodes. All leave the end.
struct EdgeTangents {
    /// positions: the variable nodes' positions in the edge of triangles[0] (2 and up). The other nodes' positions are
    /// read from x. signs: orientation of the mesh.
    EdgeTangents(const MeshTopology& topology, const Coordinates& x, const std::array<Index, 2>& triangles,
                 const std::array<int, 2>& local_edges, const std::vector<int>& positions,
                 const OrientationSigns& signs);

    /// Per end, the edge's own tangent: fixed + sum over the variable nodes of weight × node.
    std::array<Eigen::Vector2d, 2> fixed{};
    std::array<Eigen::VectorXd, 2> weights{};
    /// Per angle (triangle 0 at the edge's start and end, triangle 1 at the edge's start and end): the unit tangent of
    /// the triangle's other edge there, and +1 if the edge itself comes first in the cross product, else -1.
    std::array<Eigen::Vector2d, 4> others{};
    std::array<double, 4> senses{};
    double edge_length = 0.0;  ///< distance of the edge's end points
};

/// The four signed angles at the ends of a curved edge in its two triangles (thesis 4.2 and fig. 4.5) as functions of
/// the position of one of the edge's nodes. At a corner of a counter-clockwise triangle, with unit tangents v1 of the
/// edge that follows and v2 of the edge that precedes it, both leaving the corner, the signed angle is sgn(v1 × v2)
/// arccos(v1 · v2): negative means that the element is tangled there.
class EdgeAngles {
  public:
    /// signs: orientation of the mesh. The other nodes' positions are read now.
    EdgeAngles(const MeshTopology& topology, const Coordinates& x, const EdgeNode& edge_node,
               const OrientationSigns& signs);

    /// Radians, in (-pi, pi]; order: triangle 0 at the edge's start and end, triangle 1 at the edge's start and end.
    std::array<double, 4> evaluate(const Eigen::Vector2d& position) const;
    /// Distance of the edge's end points.
    double edge_length() const { return tangents_.edge_length; }

  private:
    EdgeTangents tangents_;
    std::array<double, 2> weight_{};
};

/// The sum of the four unsigned angles at the ends of a curved edge (thesis (3.1)) as a function of the positions of
/// all its high-order nodes. Variables: x, y of each node in turn.
class UnsignedAngleSum {
  public:
    UnsignedAngleSum(const MeshTopology& topology, const Coordinates& x, const InteriorEdge& edge);

    Eigen::Index variable_count() const { return 2 * tangents_.weights[0].size(); }
    /// Radians, in [0, pi]; order as in EdgeAngles.
    std::array<double, 4> angles(const Eigen::VectorXd& variables) const;
    double evaluate(const Eigen::VectorXd& variables) const;
    /// The exact gradient, radians per unit of length. Where an angle is 0 or pi, the sum has a kink and the angle
    /// contributes nothing.
    double evaluate(const Eigen::VectorXd& variables, Eigen::VectorXd& gradient) const;
    /// Gradient by central differences of sixth order.
    Eigen::VectorXd difference_gradient(const Eigen::VectorXd& variables, double step) const;
    /// Distance of the edge's end points.
    double edge_length() const { return tangents_.edge_length; }

  private:
    Eigen::Vector2d tangent(const Eigen::VectorXd& variables, int end) const;

    EdgeTangents tangents_;
};

}  // namespace curvewright
