#pragma once

#include <limits>
#include <string>
#include <vector>

#include "core/base/task.h"
#include "core/mesh/curved_mesh.h"
#include "core/mesh/field_array.h"

namespace curvewright {

/// When two nodes are at one place.
struct CoincidenceOptions {
    /// Largest distance, relative to the diagonal of the mesh's bounding box; 0 = equal coordinates. Coordinates in
    /// single precision, as many programs write them, are some 1e-7 apart.
    double tolerance = 1e-6;
    /// Nor are nodes at one place whose distance is more than this share of what lies between either of them and its
    /// neighbours in its elements: layers of elements that are thinner than the tolerance stay.
    double spacing_share = std::numeric_limits<double>::infinity();
};

/// The tolerance and share by which files are examined that nobody has said anything about.
inline constexpr CoincidenceOptions cautious_coincidence{1e-6, 1e-3};

/// Nodes at one place.
struct CoincidentNodes {
    /// Groups of two nodes or more, ascending within a group, the groups by their first nodes.
    std::vector<std::vector<Index>> groups;

    /// Nodes that lie at the place of an earlier one.
    Index surplus() const;
};

/// Finds the nodes of unmatched facets and of cells of lower dimension that lie at one place; nodes inside the mesh,
/// where facets match, are not looked at. A chain of nodes each of which is at the place of the next is one group.
/// O(n log n) unless a good part of them lies within a few tolerances.
CoincidentNodes find_coincident_nodes(const CurvedMesh& mesh, const CoincidenceOptions& options = {},
                                      const TaskContext& context = {});

/// Whether there are several elements and no two of them share a node: every cell has its own points, as discontinuous
/// Galerkin codes write them.
bool has_separate_elements(const MeshTopology& topology);

/// The groups that can be merged without giving a cell the same node twice.
CoincidentNodes without_collapsing(const MeshTopology& topology, const CoincidentNodes& nodes);

/// What merge_nodes returns.
struct MergedMesh {
    CurvedMesh mesh;
    std::vector<Index> new_index;  ///< per node of the old mesh: where it is now
};

/// The mesh in which every group is one node: that of lowest position, with its tag and coordinates and the entity of
/// lowest dimension of the group. All cells stay, those of lower dimension that become equal, too. Throws InvalidInput
/// that names a cell which would get the same node twice.
MergedMesh merge_nodes(const CurvedMesh& mesh, const CoincidentNodes& nodes);

/// The arrays of the mesh after merging: those on nodes have the value of the group's first node. Adds a sentence to
/// notes for every array whose values differ within a group.
std::vector<FieldArray> merged_fields(const std::vector<FieldArray>& fields, const MergedMesh& merged,
                                      std::vector<std::string>& notes);

}  // namespace curvewright
