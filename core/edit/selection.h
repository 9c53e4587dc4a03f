#pragma once

#include <functional>
#include <vector>

#include "core/mesh/node_elements.h"
#include "core/quality/quality.h"

namespace curvewright {

/// Sets of nodes or elements are ascending lists of their positions, each once.
using IndexSet = std::vector<Index>;

IndexSet united(const IndexSet& a, const IndexSet& b);
IndexSet without(const IndexSet& a, const IndexSet& b);
/// What is in one of them, not in both.
IndexSet toggled(const IndexSet& a, const IndexSet& b);

/// Nodes of the elements; elements of which a node, or all corners, are among the nodes.
IndexSet nodes_of_elements(const MeshTopology& topology, const IndexSet& elements);
IndexSet elements_with_any(const MeshTopology& topology, const IndexSet& nodes);
IndexSet elements_with_all_corners(const MeshTopology& topology, const IndexSet& nodes);

/// One layer more: the elements that share a node with these; the nodes of all elements that have one of these. Of
/// nodes all of which are on the boundary, the boundary nodes only, facet by facet.
IndexSet grown_elements(const MeshTopology& topology, const NodeElements& node_elements, const IndexSet& elements);
IndexSet grown_nodes(const MeshTopology& topology, const NodeElements& node_elements, const IndexSet& nodes);
/// One layer less. Elements: those that touch no other element than these. Nodes: those of elements (boundary nodes:
/// of boundary facets) that are wholly among them and touch none that is not.
IndexSet shrunk_elements(const MeshTopology& topology, const NodeElements& node_elements, const IndexSet& elements);
IndexSet shrunk_nodes(const MeshTopology& topology, const IndexSet& nodes);

IndexSet inverted_elements(const MeshTopology& topology, const IndexSet& elements);
/// Within the boundary nodes if all of these are such (and there are any), else within all nodes of elements.
IndexSet inverted_nodes(const MeshTopology& topology, const IndexSet& nodes);

/// Elements whose scaled Jacobian lies in [lower, upper].
IndexSet elements_in_range(const QualityReport& report, double lower, double upper);

}  // namespace curvewright
