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
    /// By element, facet and node; a node once per facet it hangs on. The node and the element are of one body: they
    /// are connected some other way.
    std::vector<HangingNode> hanging;
    std::vector<UnlikeFacets> unlike;  ///< by elements
    /// The same of nodes of other bodies, which have no node in common with the element's: parts of an assembly that
    /// touch, each with a mesh of its own. These conform; they move apart like separate meshes in one file.
    std::vector<HangingNode> touching;

    bool conforms() const { return hanging.empty() && unlike.empty(); }
};

/// Finds hanging nodes and unlike neighbours. Only unmatched facets are looked at, so the cost is that of the boundary.
/// Slits, whose two sides match node for node, conform, and so do boundaries that touch at a point: a node
/// hangs where it is on a facet to 1e-6 of the facet's extent, at none of its nodes, and a facet of the node's own
/// faces the other there.
Nonconformity find_nonconformity(const CurvedMesh& mesh, const TaskContext& context = {});

/// The first of them as a sentence without what follows from it ("Node 17 hangs on an edge of element 4 (one of 3)").
/// pre: does not conform.
std::string describe(const Nonconformity& nonconformity, const MeshTopology& topology);

/// For everything that moves nodes: elements that touch and are not connected would come apart. Throws Unsupported that
/// names the first of them.
void require_conforming(const CurvedMesh& mesh, const TaskContext& context = {});

}  // namespace curvewright
