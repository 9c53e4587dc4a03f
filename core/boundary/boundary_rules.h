#pragma once

#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "core/mesh/mesh_topology.h"

namespace curvewright {

/// What the nodes of the boundary, and of interfaces inside the domain, may do while a mesh is untangled.
enum class BoundaryMode {
    fixed,  ///< stay, bit for bit
    slide,  ///< move along the boundary or interface as it was read; corners stay and feature edges keep their nodes
    free,   ///< move like interior nodes
};

/// Modes of the boundary: one for all of it, and others for named groups. Interfaces (see
/// MeshTopology::interface_facets) and the curves and points inside the domain that groups name are fixed unless a
/// group says otherwise.
struct BoundaryRules {
    /// The mode of a named group.
    struct Rule {
        std::string group;
        BoundaryMode mode = BoundaryMode::fixed;
    };
    BoundaryMode otherwise = BoundaryMode::fixed;  ///< of boundary facets that are in none of the groups
    std::vector<Rule> groups;
    /// Facets of a sliding boundary that meet at more than this many degrees have a feature (a corner in 2D) between
    /// them.
    double feature_angle = 40.0;

    bool is_all_fixed() const;
    /// Adds "MODE" or "GROUP=MODE" with MODE one of fixed, slide, free. Throws InvalidInput for anything else.
    void add(std::string_view text);
};

/// The rules applied to a mesh.
struct BoundaryModes {
    std::vector<BoundaryMode> facets;  ///< one per facet of geometry_facets()
    /// One per node: the strictest (fixed before slide before free) of its facets and of the groups of lower dimension
    /// that contain it. `free` for interior nodes that are on no interface.
    std::vector<BoundaryMode> nodes;
    std::vector<int> facet_entities;  ///< per facet: the entity of the cell that lies on it; 0 = none
};

/// All facets that are geometry: those of the boundary, then those of interfaces.
std::vector<Facet> geometry_facets(const MeshTopology& topology);

/// What a rule calls all interfaces, unless the mesh has a group of that name: "interfaces".
extern const char* const all_interfaces_name;
/// Per interface node the names under which rules speak of it: the groups of cells of lower dimension that it is in, or
/// all_interfaces_name if there are none.
std::map<Index, std::set<std::string>> names_of_interface_nodes(const MeshTopology& topology);

/// A facet has the strictest mode of the groups it is in: by a cell of the group that has the same nodes, or by its
/// element (by that on either side of an interface). Throws InvalidInput for a group that the mesh does not have (and
/// says which it has) and for a feature angle outside (0, 180).
BoundaryModes resolve(const BoundaryRules& rules, const MeshTopology& topology);

}  // namespace curvewright
