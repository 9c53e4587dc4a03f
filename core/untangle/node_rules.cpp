#include "core/untangle/node_rules.h"

#include <fmt/format.h>

#include "core/base/error.h"

namespace curvewright {

KeptNodes::KeptNodes(const NodeRules& rules, const MeshTopology& topology) {
    if (rules.is_empty()) return;
    is_kept_.assign(static_cast<std::size_t>(topology.node_count()), 0);
    for (const NodeTag tag : rules.fixed_nodes) {
        const auto node = topology.find_node(tag);
        if (!node) throw InvalidInput(fmt::format("The mesh has no node {}, which is to stay where it is.", tag.value));
        is_kept_[*node] = 1;
    }
    for (const std::string& group : rules.fixed_groups) {
        const auto nodes = topology.find_group_nodes(group);
        if (!nodes)
            throw InvalidInput(
                fmt::format("The mesh has no group \"{}\", whose nodes are to stay where they are.", group));
        for (const Index node : *nodes) is_kept_[node] = 1;
    }
    if (!rules.keeps_vertices) return;
    for (Index element = 0; element < topology.element_count(); ++element) {
        const auto nodes = topology.element_nodes(element);
        const int corners = corner_count(topology.element_type(element).shape);
        for (int c = 0; c < corners; ++c) is_kept_[nodes[static_cast<std::size_t>(c)]] = 1;
    }
}

std::vector<Index> KeptNodes::nodes() const {
    std::vector<Index> result;
    for (std::size_t node = 0; node < is_kept_.size(); ++node)
        if (is_kept_[node] != 0) result.push_back(static_cast<Index>(node));
    return result;
}

}  // namespace curvewright
