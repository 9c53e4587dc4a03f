#pragma once

#include <span>
#include <vector>

#include "core/mesh/curved_mesh.h"

namespace curvewright {

/// The boundary of a mesh as pieces that people take hold of: its connected components, and the smooth parts (sides,
/// faces) that its corners and feature edges leave. Made for one state of a mesh; holds for another state of the same
/// topology as long as its features do.
class BoundaryParts {
  public:
    /// Facets of the default feature angle of a CAD model's tessellation.
    static constexpr double default_feature_angle = 40.0;

    /// Two facets that meet belong to the same smooth part if the boundary turns by less than the feature angle
    /// (degrees) there: in 2D at their common corner, in 3D in the middle of their common edge. Where more than two
    /// facets meet the boundary is not smooth. 2D and 3D meshes; others have no parts.
    explicit BoundaryParts(const CurvedMesh& mesh, double feature_angle = default_feature_angle);

    int component_count() const { return component_count_; }
    int smooth_part_count() const { return smooth_part_count_; }
    /// Per boundary facet, in the order of MeshTopology::boundary_facets(): 0 .. count - 1.
    const std::vector<int>& component_of_facet() const { return component_; }
    const std::vector<int>& smooth_part_of_facet() const { return smooth_part_; }

    /// Nodes of the facets of a component or of a smooth part, ascending. Corners belong to each part that meets there.
    std::vector<Index> component_nodes(int component) const { return collect(component_, component); }
    std::vector<Index> smooth_part_nodes(int part) const { return collect(smooth_part_, part); }

    /// Boundary facets that contain a node (positions in boundary_facets()), ascending; none for other nodes.
    std::span<const Index> facets_of_node(Index node) const;
    std::vector<Index> facet_nodes(Index facet) const;

    /// Nodes of the smooth parts that meet in a boundary node, or of its component; none for other nodes.
    std::vector<Index> smooth_nodes_around(Index node) const;
    std::vector<Index> component_nodes_around(Index node) const;

    /// 3D: nodes of the feature edges (those between smooth parts) that hang together with the ones a node is on, up to
    /// where other than two of them meet; ascending, none for nodes on no feature edge.
    std::vector<Index> feature_line_nodes_around(Index node) const;

    /// Unit normal of the boundary at a boundary node, outward, the mean of its facets'; zero where there is none
    /// (other nodes, facets that cancel). x: positions of the mesh's nodes, of any state.
    Eigen::Vector3d normal(const Coordinates& x, Index node) const;

  private:
    void add_feature_edge(int facet, int edge);
    void join_feature_edges();
    std::vector<Index> collect(const std::vector<int>& labels, int label) const;

    std::shared_ptr<const MeshTopology> topology_;
    std::vector<signed char> signs_;  ///< per facet; -1: its element is numbered so that the facet's normal is inward
    std::vector<std::size_t> facet_offsets_;  ///< facets + 1
    std::vector<Index> facet_nodes_;
    std::vector<std::size_t> node_offsets_;  ///< nodes + 1
    std::vector<Index> node_facets_;
    std::vector<int> component_, smooth_part_;
    std::vector<std::vector<Index>> feature_edges_;  ///< 3D: their nodes, the ends first
    std::vector<int> feature_line_;                  ///< per feature edge: 0 .. count - 1
    int component_count_ = 0, smooth_part_count_ = 0;
};

}  // namespace curvewright
