#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/base/task.h"
#include "core/mesh/curved_mesh.h"
#include "core/quality/quality.h"

namespace curvewright {

/// How far a set of nodes moved, in the meshes' unit of length. Nodes are the same if their tags are.
struct NodeMotion {
    Index nodes = 0;                          ///< compared
    Index moved = 0;                          ///< of them with other coordinates, be it in the last bit
    double max = 0.0, mean = 0.0, rms = 0.0;  ///< over all that were compared, those that stayed too
    std::optional<NodeTag> farthest;          ///< the node of the largest motion; none if none moved
};

/// The same for a group of both meshes.
struct GroupMotion {
    std::string name;   ///< as in MeshTopology::display_name
    NodeMotion motion;  ///< of the nodes that are in the group of both
    Index nodes_added = 0, nodes_removed = 0;
};

/// The quality of an element that both meshes have.
struct ElementQualityChange {
    ElementTag tag;
    double before = 0.0, after = 0.0;  ///< scaled Jacobians
};

/// What is different between two states of a mesh, A (before) and B (after). Lists of tags are ascending.
struct MeshComparison {
    double size = 0.0;                   ///< diagonal of A's bounding box, to which motions may be related
    NodeMotion all, boundary, interior;  ///< boundary and interior as in A
    std::vector<GroupMotion> groups;     ///< of both meshes
    std::vector<NodeTag> nodes_added, nodes_removed;
    std::vector<ElementTag> elements_added, elements_removed;
    std::vector<ElementTag> elements_reconnected;   ///< of another type, or with other nodes or another order of them
    std::vector<ElementTag> elements_moved;         ///< the same nodes, but some of them elsewhere
    std::vector<ElementTag> elements_reclassified;  ///< on another entity
    /// Cells of lower dimension (boundary lines, corner points) that only one of the meshes has; the same tag with
    /// other nodes counts on both sides.
    Index lower_cells_added = 0, lower_cells_removed = 0;
    std::vector<std::string> groups_added, groups_removed;
    /// Quality of all elements; not given where a mesh cannot be assessed. B is judged with A's orientation.
    std::optional<QualitySummary> quality_before, quality_after;
    std::vector<ElementTag> became_invalid, became_valid;  ///< by proof; undecided elements are in neither list
    std::optional<ElementQualityChange> most_worsened;     ///< of the elements of both

    /// Whether anything but positions is different.
    bool is_structure_equal() const;
    /// The largest motion relative to the size of A.
    double relative_motion() const;
};

/// Compares two meshes by the tags of their nodes, elements and groups. Throws Cancelled.
MeshComparison compare_meshes(const CurvedMesh& before, const CurvedMesh& after, const TaskContext& context = {});

}  // namespace curvewright
