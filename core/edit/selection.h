#pragma once

#include <functional>
#include <vector>

#include "core/mesh/node_elements.h"
#include "core/quality/quality.h"

namespace curvewright {

/// Sets of nodes or elements are ascending lists of their positions, each once.
using IndexSet = std::vector<Index>;

/// What is in one of them or in both.
IndexSet united(const IndexSet& a, const IndexSet& b);
/// What is in a and not in b.
IndexSet without(const IndexSet& a, const IndexSet& b);
/// What is in one of them, not in both.
IndexSet toggled(const IndexSet& a, const IndexSet& b);

/// Nodes of the elements.
IndexSet nodes_of_elements(const MeshTopology& topology, const IndexSet& elements);
/// Elements of which a node is among the nodes.
IndexSet elements_with_any(const MeshTopology& topology, const IndexSet& nodes);
/// Elements all corners of which are among the nodes.
IndexSet elements_with_all_corners(const MeshTopology& topology, const IndexSet& nodes);

/// One layer more: the elements that share a node with these.
IndexSet grown_elements(const MeshTopology& topology, const NodeElements& node_elements, const IndexSet& elements);
/// One layer more: the nodes of all elements that have one of these. Of nodes all of which are on the boundary, the
/// boundary nodes only, facet by facet.
IndexSet grown_nodes(const MeshTopology& topology, const NodeElements& node_elements, const IndexSet& nodes);
/// One layer less: those that touch no other element than these.
IndexSet shrunk_elements(const MeshTopology& topology, const NodeElements& node_elements, const IndexSet& elements);
/// One layer less: those of elements (boundary nodes: of boundary facets) that are wholly among them and touch none
/// that is not.
IndexSet shrunk_nodes(const MeshTopology& topology, const IndexSet& nodes);

/// All other elements.
IndexSet inverted_elements(const MeshTopology& topology, const IndexSet& elements);
/// Within the boundary nodes if all of these are such (and there are any), else within all nodes of elements.
IndexSet inverted_nodes(const MeshTopology& topology, const IndexSet& nodes);

/// Elements whose scaled Jacobian lies in [lower, upper].
IndexSet elements_in_range(const QualityReport& report, double lower, double upper);

}  // namespace curvewright
