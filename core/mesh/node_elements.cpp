#include "core/mesh/node_elements.h"

namespace curvewright {

NodeElements elements_of_nodes(const MeshTopology& topology) {
    NodeElements result;
    std::vector<std::size_t>& offsets = result.offsets;
    offsets.assign(static_cast<std::size_t>(topology.node_count()) + 1, 0);
    for (Index element = 0; element < topology.element_count(); ++element)
        for (Index node : topology.element_nodes(element)) ++offsets[static_cast<std::size_t>(node) + 1];
    for (std::size_t i = 1; i < offsets.size(); ++i) offsets[i] += offsets[i - 1];
    result.elements.resize(offsets.back());
    std::vector<std::size_t> next(offsets.begin(), offsets.end() - 1);
    for (Index element = 0; element < topology.element_count(); ++element)
        for (Index node : topology.element_nodes(element)) result.elements[next[node]++] = element;
    return result;
}

}  // namespace curvewright
