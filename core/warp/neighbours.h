#pragma once

#include <span>
#include <vector>

#include "core/base/task.h"
#include "core/mesh/mesh_topology.h"

namespace curvewright {

/// Neighbours of the free nodes: all other nodes of the elements that contain it (thesis, 2.2).
struct NeighbourSets {
    std::vector<Index> centers;        ///< the free nodes, ascending
    std::vector<std::size_t> offsets;  ///< free nodes + 1
    std::vector<Index> nodes;          ///< ascending within a set

    std::span<const Index> of(std::size_t i) const {
        return std::span(nodes).subspan(offsets[i], offsets[i + 1] - offsets[i]);
    }
};

/// One set per entry of centers (ascending), in that order. Multi-threaded. Throws Cancelled.
NeighbourSets find_neighbours(const MeshTopology& topology, std::vector<Index> centers,
                              const TaskContext& context = {});

}  // namespace curvewright
