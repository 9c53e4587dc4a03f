#pragma once

#include <span>
#include <vector>

#include "core/base/task.h"
#include "core/mesh/mesh_topology.h"

namespace curvewright {

/// Neighbours of every interior node: all other nodes of the elements that contain it (thesis, 2.2).
struct NeighbourSets {
    std::vector<std::size_t> offsets;  ///< interior nodes + 1
    std::vector<Index> nodes;          ///< ascending within a set

    std::span<const Index> of(std::size_t interior) const {
        return std::span(nodes).subspan(offsets[interior], offsets[interior + 1] - offsets[interior]);
    }
};

/// One set per entry of topology.interior_nodes(), in that order. Multi-threaded.
NeighbourSets find_neighbours(const MeshTopology& topology, const TaskContext& context = {});

}  // namespace curvewright
