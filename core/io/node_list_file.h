#pragma once

#include <filesystem>
#include <vector>

#include "core/mesh/mesh_topology.h"

namespace curvewright {

/// Reads a list of nodes: one tag per line, or a table (.csv or not) whose header has a column "tag". Empty lines do
/// not count. Throws InvalidInput (file and line) for anything else, for a node that the mesh does not have, and for a
/// file that cannot be read or names no node.
std::vector<NodeTag> read_node_list(const std::filesystem::path& file, const MeshTopology& topology);

}  // namespace curvewright
