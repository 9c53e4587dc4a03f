#pragma once

#include <span>
#include <vector>

#include "core/mesh/mesh_topology.h"

namespace curvewright {

/// The elements that contain each node, compressed by rows; ascending for a node.
struct NodeElements {
    std::vector<std::size_t> offsets;  ///< nodes + 1
    std::vector<Index> elements;

    std::span<const Index> of(Index node) const {
        return std::span(elements).subspan(offsets[node], offsets[node + 1] - offsets[node]);
    }
};
/// The elements of every node of a mesh.
NodeElements elements_of_nodes(const MeshTopology& topology);

}  // namespace curvewright
