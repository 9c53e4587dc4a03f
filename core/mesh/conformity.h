#pragma once

#include <string>
#include <vector>

#include "core/base/task.h"
#include "core/mesh/curved_mesh.h"

namespace curvewright {

/// A node that lies on an edge or face of an element which does not have it as its node.
struct HangingNode {
    Index node = 0;
    Facet facet;             ///< of the element
    bool is_on_edge = true;  ///< of the element; false: inside a face
};

/// Two elements with corners of a common facet whose nodes differ in kind: of different orders, or a quadrilateral
/// beside a triangle that takes half of it.
struct UnlikeFacets {
    Facet one, other;
};

/// Where elements touch and are not connected.
struct Nonconformity {
    std::vector<HangingNode> hanging;  ///< by element, facet and node; a node once per facet it hangs on
    std::vector<UnlikeFacets> unlike;  ///< by elements

    bool empty() const { return hanging.empty() && unlike.empty(); }
};

/// Finds hanging nodes and unlike neighbours. Only unmatched facets are looked at, so the cost is that of the boundary.
/// Slits, whose two sides match node for node, are conforming, and so are boundaries that touch at a point: a node
/// hangs where it is on a facet to 1e-6 of the facet's extent, at none of its nodes, and a facet of the node's own
/// faces the other there.
Nonconformity find_nonconformity(const CurvedMesh& mesh, const TaskContext& context = {});

/// The first of them as a sentence without what follows from it ("Node 17 hangs on an edge of element 4 (one of 3)").
/// pre: not empty.
std::string describe(const Nonconformity& nonconformity, const MeshTopology& topology);

/// For everything that moves nodes: elements that touch and are not connected would come apart. Throws Unsupported that
/// names the first of them.
void require_conforming(const CurvedMesh& mesh, const TaskContext& context = {});

}  // namespace curvewright
