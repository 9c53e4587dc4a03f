#pragma once

#include <array>
#include <span>
#include <vector>

#include "core/basis/element_type.h"
#include "core/mesh/mesh_topology.h"

namespace curvewright {

/// How the corners of a facet b lie on those of a facet a with the same corners: corner k of a, counted around it, is
/// corner (first + sense k) mod count of b. A line has sense +1 if it runs the same way.
struct CornerMatch {
    int first = 0;
    int sense = 0;  ///< +1 or -1: whether b runs round the same way as a; 0: they do not match
};

/// corners: of the two facets, in the order of their cells.
CornerMatch match_corners(std::span<const Index> a, std::span<const Index> b);

/// Per node of a facet of the given type, in the order of its cell, the node of a matching facet of the same type at
/// the same place.
const std::vector<int>& matched_nodes(ElementType type, CornerMatch match);

/// +1 if a facet of an element runs round so that its normal (of d/du × d/dv in 3D; to the right of it in 2D) points
/// outward from an element with J > 0, -1 otherwise.
int outward_sense(ElementType element, int facet);

/// Facets of a mesh that its elements do not share as they should.
struct FacetConflict {
    enum class Kind {
        shared_by_many,  ///< by three elements or more
        other_order,     ///< the same nodes in another order
        same_side,       ///< both elements lie on the same side of the facet
    };
    Kind kind = Kind::shared_by_many;
    Facet a, b;
};

/// All conflicts between elements that share a facet's nodes, in the order of their first elements. Sides are told from
/// the numbering of the elements' nodes, which is taken for reversed where is_reversed (per element; empty: none).
std::vector<FacetConflict> find_facet_conflicts(const MeshTopology& topology, const std::vector<bool>& is_reversed);

}  // namespace curvewright
