#pragma once

#include <array>
#include <vector>

#include "core/mesh/mesh_topology.h"

namespace curvewright {

/// The ends of the edges of a mesh's interfaces (see MeshTopology::interface_facets): pairs of nodes, each ascending,
/// and ascending among each other; edges of several facets may be there several times.
std::vector<std::array<Index, 2>> interface_edges(const MeshTopology& topology);

}  // namespace curvewright
