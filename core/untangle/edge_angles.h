#pragma once

#include <array>
#include <vector>

#include <Eigen/Core>

#include "core/mesh/curved_mesh.h"

namespace curvewright {

/// A high-order node on an interior edge of a 2D mesh of triangles.
struct EdgeNode {
    Index node = 0;
    std::array<Index, 2> triangles{};  ///< the two that share the edge
    std::array<int, 2> local_edges{};  ///< the edge's number in each
    int position = 0;                  ///< the node's position in the edge of triangles[0]
};

/// All high-order nodes of the interior edges, in ascending order of the nodes. Throws Unsupported if an edge belongs
/// to more than two triangles.
std::vector<EdgeNode> find_interior_edge_nodes(const MeshTopology& topology);

/// The four signed angles at the ends of a curved edge in its two triangles (thesis 4.2 and fig. 4.5) as functions of
/// the position of one of the edge's nodes. At a corner of a counter-clockwise triangle, with unit tangents v1 of the
/// edge that follows and v2 of the edge that precedes it, both leaving the corner, the signed angle is sgn(v1 × v2)
/// arccos(v1 · v2): negative means that the element is tangled there.
class EdgeAngles {
  public:
    /// sign: orientation of the mesh, +1 or -1. The other nodes' positions are read now.
    EdgeAngles(const MeshTopology& topology, const Coordinates& x, const EdgeNode& edge_node, double sign);

    /// Radians, in (-pi, pi]; order: triangle 0 at the edge's start and end, triangle 1 at the edge's start and end.
    std::array<double, 4> evaluate(const Eigen::Vector2d& position) const;
    /// Distance of the edge's end points.
    double edge_length() const { return edge_length_; }

  private:
    /// Tangent of the edge at each end, leaving it: fixed part + weight × position.
    std::array<Eigen::Vector2d, 2> fixed_{};
    std::array<double, 2> weight_{};
    /// Per angle: the other edge's unit tangent, and +1 if the edge comes first in the cross product, else -1.
    std::array<Eigen::Vector2d, 4> other_{};
    std::array<double, 4> sense_{};
    double edge_length_ = 0.0;
};

}  // namespace curvewright
