#pragma once

#include <string>
#include <vector>

#include "core/mesh/mesh_topology.h"

namespace curvewright {

/// Nodes that stay bit for bit where they are, whatever the method and the boundary's rules allow.
struct NodeRules {
    /// Corners of elements stay: only high-order nodes move.
    bool keeps_vertices = false;
    std::vector<NodeTag> fixed_nodes;
    /// Names of groups whose nodes stay (see MeshTopology::find_group_nodes).
    std::vector<std::string> fixed_groups;

    bool is_empty() const { return !keeps_vertices && fixed_nodes.empty() && fixed_groups.empty(); }
};

/// The rules applied to a mesh.
class KeptNodes {
  public:
    /// Throws InvalidInput for a node or a group that the mesh does not have.
    KeptNodes(const NodeRules& rules, const MeshTopology& topology);

    bool is_kept(Index node) const { return !is_kept_.empty() && is_kept_[node] != 0; }
    /// Ascending.
    std::vector<Index> nodes() const;

  private:
    std::vector<char> is_kept_;  ///< per node; empty if all may move
};

}  // namespace curvewright
