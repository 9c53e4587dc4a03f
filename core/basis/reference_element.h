#pragma once

#include <array>
#include <vector>

#include "core/basis/element_type.h"
#include "core/basis/node_ordering.h"

namespace curvewright {

/// An edge or a face of an element: its own type, and which nodes of the element it consists of, in the order of a
/// Lagrange cell of that type.
struct SubElement {
    ElementType type;
    std::vector<int> nodes;
};

/// All that depends on shape and order only. Built once per type and shared.
struct ReferenceElement {
    ElementType type;
    int dimension = 0;
    /// Lattice point of every node, in the order of this program (VTK's).
    std::vector<LatticePoint> lattice;
    /// One-dimensional sub-elements, each with the two corners first. A line has itself.
    std::vector<SubElement> edges;
    /// Two-dimensional sub-elements. Their normal points outward in 3D; a triangle or quadrilateral has itself.
    std::vector<SubElement> faces;
    /// Sub-elements of dimension - 1; the two corners of a line.
    std::vector<SubElement> facets;
    /// Nodes that lie inside the element, on no facet of it.
    std::vector<int> interior_nodes;

    /// For every node the one that takes its place in the mirrored element, whose first two axes are exchanged: the
    /// numbering of the same element that runs the other way round. Mirrored twice is as it was.
    std::vector<int> mirrored;

    int node_count() const { return static_cast<int>(lattice.size()); }
    /// Position of the node at a lattice point; -1 if there is none.
    int find_node(LatticePoint point) const;
};

/// The one of a type; made at the first call. Safe to call from several threads at once.
const ReferenceElement& reference_element(ElementType type);

}  // namespace curvewright
