#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/base/task.h"
#include "core/mesh/mesh_topology.h"

namespace curvewright {

/// Which nodes an interior node is tied to.
enum class NeighbourKind {
    all,  ///< all other nodes of its elements (thesis, 2.2)
    /// Those of them that are no vertices; fewer weights, for small motions. Needs order 2. Where two triangles form a
    /// larger one, the nodes of their common edge lie on the hull.
    high_order,
    /// Those one step away on the lattice of an element, the edges between nodes: the fewest weights, but the node lies
    /// close to the edge of their hull.
    edge_connected,
};
/// Name of the kind, as options have it.
const char* to_string(NeighbourKind kind);

/// Neighbours of the free nodes, one set per node.
struct NeighbourSets {
    std::vector<Index> centers;        ///< the free nodes
    std::vector<std::size_t> offsets;  ///< free nodes + 1
    std::vector<Index> nodes;          ///< of all sets; in the order in which the elements name them
    /// Per entry of nodes: how many elements contain both the centre and the neighbour, at most 65535.
    std::vector<std::uint16_t> shared_elements;

    std::span<const Index> of(std::size_t i) const {
        return std::span(nodes).subspan(offsets[i], offsets[i + 1] - offsets[i]);
    }
    std::span<const std::uint16_t> shared_elements_of(std::size_t i) const {
        return std::span(shared_elements).subspan(offsets[i], offsets[i + 1] - offsets[i]);
    }
};

/// One set per entry of centers, in that order. Multi-threaded. Throws Unsupported for high_order on a mesh of order 1,
/// Cancelled.
NeighbourSets find_neighbours(const MeshTopology& topology, std::vector<Index> centers,
                              NeighbourKind kind = NeighbourKind::all, const TaskContext& context = {});

}  // namespace curvewright
