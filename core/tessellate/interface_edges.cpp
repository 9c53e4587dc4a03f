#include "core/tessellate/interface_edges.h"

#include <algorithm>

#include "core/basis/reference_element.h"

namespace curvewright {

std::vector<std::array<Index, 2>> interface_edges(const MeshTopology& topology) {
    std::vector<std::array<Index, 2>> edges;
    for (const Facet& facet : topology.interface_facets()) {
        const std::vector<Index> nodes = topology.facet_nodes(facet);
        const SubElement& side = reference_element(topology.element_type(facet.element)).facets[facet.local];
        for (const SubElement& edge : reference_element(side.type).edges) {
            const Index a = nodes[edge.nodes[0]], b = nodes[edge.nodes[1]];
            edges.push_back({std::min(a, b), std::max(a, b)});
        }
    }
    std::sort(edges.begin(), edges.end());
    return edges;
}

}  // namespace curvewright
