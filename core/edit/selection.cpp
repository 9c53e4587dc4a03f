#include "core/edit/selection.h"

#include <algorithm>
#include <iterator>

namespace curvewright {
namespace {

IndexSet from_flags(const std::vector<char>& flags) {
    IndexSet set;
    for (std::size_t i = 0; i < flags.size(); ++i)
        if (flags[i]) set.push_back(static_cast<Index>(i));
    return set;
}

std::vector<char> to_flags(const IndexSet& set, Index count) {
    std::vector<char> flags(static_cast<std::size_t>(count), 0);
    for (Index i : set)
        if (i >= 0 && i < count) flags[static_cast<std::size_t>(i)] = 1;
    return flags;
}

bool is_on_boundary(const MeshTopology& topology, const IndexSet& nodes) {
    return !nodes.empty() &&
           std::all_of(nodes.begin(), nodes.end(), [&](Index node) { return topology.is_boundary_node(node); });
}

/// Nodes of boundary facets that have one of these.
IndexSet grown_on_boundary(const MeshTopology& topology, const IndexSet& nodes) {
    const std::vector<char> before = to_flags(nodes, topology.node_count());
    std::vector<char> after = before;
    for (const Facet& facet : topology.boundary_facets()) {
        const std::vector<Index> its = topology.facet_nodes(facet);
        if (std::any_of(its.begin(), its.end(),
                        [&](Index node) { return before[static_cast<std::size_t>(node)] != 0; }))
            for (Index node : its) after[static_cast<std::size_t>(node)] = 1;
    }
    return from_flags(after);
}

/// Nodes of the cells that are wholly among the nodes and touch none that is not.
template <class NodesOf>
IndexSet kept_cells(const MeshTopology& topology, const IndexSet& nodes, std::size_t count, const NodesOf& nodes_of) {
    const std::vector<char> selected = to_flags(nodes, topology.node_count());
    std::vector<char> at_the_rim(selected.size(), 0), kept(selected.size(), 0), is_whole(count, 1);
    for (std::size_t i = 0; i < count; ++i) {
        const auto& its = nodes_of(i);
        for (Index node : its) is_whole[i] = is_whole[i] && selected[static_cast<std::size_t>(node)];
        if (!is_whole[i])
            for (Index node : its) at_the_rim[static_cast<std::size_t>(node)] = 1;
    }
    for (std::size_t i = 0; i < count; ++i) {
        const auto& its = nodes_of(i);
        const bool stays = is_whole[i] && std::none_of(its.begin(), its.end(), [&](Index node) {
                               return at_the_rim[static_cast<std::size_t>(node)] != 0;
                           });
        if (stays)
            for (Index node : its) kept[static_cast<std::size_t>(node)] = 1;
    }
    return from_flags(kept);
}

}  // namespace

IndexSet united(const IndexSet& a, const IndexSet& b) {
    IndexSet result;
    std::set_union(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(result));
    return result;
}

IndexSet without(const IndexSet& a, const IndexSet& b) {
    IndexSet result;
    std::set_difference(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(result));
    return result;
}

IndexSet toggled(const IndexSet& a, const IndexSet& b) {
    IndexSet result;
    std::set_symmetric_difference(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(result));
    return result;
}

IndexSet nodes_of_elements(const MeshTopology& topology, const IndexSet& elements) {
    std::vector<char> flags(static_cast<std::size_t>(topology.node_count()), 0);
    for (Index element : elements)
        for (Index node : topology.element_nodes(element)) flags[static_cast<std::size_t>(node)] = 1;
    return from_flags(flags);
}

IndexSet elements_with_any(const MeshTopology& topology, const IndexSet& nodes) {
    const std::vector<char> flags = to_flags(nodes, topology.node_count());
    IndexSet elements;
    for (Index element = 0; element < topology.element_count(); ++element) {
        const auto its = topology.element_nodes(element);
        if (std::any_of(its.begin(), its.end(), [&](Index node) { return flags[static_cast<std::size_t>(node)] != 0; }))
            elements.push_back(element);
    }
    return elements;
}

IndexSet elements_with_all_corners(const MeshTopology& topology, const IndexSet& nodes) {
    const std::vector<char> flags = to_flags(nodes, topology.node_count());
    IndexSet elements;
    for (Index element = 0; element < topology.element_count(); ++element) {
        const auto corners = topology.element_nodes(element).first(
            static_cast<std::size_t>(corner_count(topology.element_type(element).shape)));
        if (std::all_of(corners.begin(), corners.end(),
                        [&](Index node) { return flags[static_cast<std::size_t>(node)] != 0; }))
            elements.push_back(element);
    }
    return elements;
}

IndexSet grown_elements(const MeshTopology& topology, const NodeElements& node_elements, const IndexSet& elements) {
    std::vector<char> flags = to_flags(elements, topology.element_count());
    for (Index node : nodes_of_elements(topology, elements))
        for (Index element : node_elements.of(node)) flags[static_cast<std::size_t>(element)] = 1;
    return from_flags(flags);
}

IndexSet grown_nodes(const MeshTopology& topology, const NodeElements& node_elements, const IndexSet& nodes) {
    if (is_on_boundary(topology, nodes)) return grown_on_boundary(topology, nodes);
    std::vector<char> flags = to_flags(nodes, topology.node_count());
    for (Index node : nodes)
        for (Index element : node_elements.of(node))
            for (Index other : topology.element_nodes(element)) flags[static_cast<std::size_t>(other)] = 1;
    return from_flags(flags);
}

IndexSet inverted_elements(const MeshTopology& topology, const IndexSet& elements) {
    std::vector<char> flags = to_flags(elements, topology.element_count());
    for (char& flag : flags) flag = !flag;
    return from_flags(flags);
}

IndexSet inverted_nodes(const MeshTopology& topology, const IndexSet& nodes) {
    const IndexSet& boundary = topology.boundary_nodes();
    if (is_on_boundary(topology, nodes)) return without(boundary, nodes);
    return without(united(boundary, topology.interior_nodes()), nodes);
}

IndexSet shrunk_elements(const MeshTopology& topology, const NodeElements& node_elements, const IndexSet& elements) {
    return without(elements, grown_elements(topology, node_elements, inverted_elements(topology, elements)));
}

IndexSet shrunk_nodes(const MeshTopology& topology, const IndexSet& nodes) {
    if (is_on_boundary(topology, nodes)) {
        const auto& facets = topology.boundary_facets();
        return kept_cells(topology, nodes, facets.size(),
                          [&](std::size_t i) { return topology.facet_nodes(facets[i]); });
    }
    return kept_cells(topology, nodes, static_cast<std::size_t>(topology.element_count()),
                      [&](std::size_t i) { return topology.element_nodes(static_cast<Index>(i)); });
}

IndexSet elements_in_range(const QualityReport& report, double lower, double upper) {
    IndexSet set;
    for (std::size_t i = 0; i < report.elements.size(); ++i)
        if (report.elements[i].scaled_jacobian >= lower && report.elements[i].scaled_jacobian <= upper)
            set.push_back(static_cast<Index>(i));
    return set;
}

}  // namespace curvewright
