#pragma once

#include <array>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/base/ids.h"

namespace curvewright {

struct MeshData;
class MeshTopology;

/// Two entities of one dimension whose nodes correspond to each other (a link of MSH's "$Periodic").
struct PeriodicLink {
    int dimension = 0;
    int tag = 0;         ///< of the entity
    int master_tag = 0;  ///< of the entity that it is a copy of
    /// Rows of the 4 × 4 matrix that takes the master onto the entity; none if the file does not tell it.
    std::optional<std::array<double, 16>> affine;
    /// A node of the entity, and its counterpart on the master.
    std::vector<std::pair<Index, Index>> nodes;
};

/// Follows nodes that were given other numbers: new_index has one for each old node, -1 = the node is no more. Pairs
/// that lose a node, and those that say what another one says already, go.
void renumber_periodic(std::vector<PeriodicLink>& links, const std::vector<Index>& new_index);

/// The links of a mesh for the same cells of other orders: `data` has the blocks of `old` cell by cell, and corners
/// keep their tags. Corners stay paired; the other nodes of the cells that lie on the two entities are paired where
/// they have the same place among paired corners. Nodes of entities without cells of their own are not.
std::vector<PeriodicLink> periodic_of_new_order(const MeshTopology& old, const MeshData& data);

/// One sentence per link that leaves nodes of its entity without a counterpart, if there is any.
std::vector<std::string> periodic_gaps(const MeshTopology& topology);

}  // namespace curvewright
