#include "core/report/group_statistics.h"

#include <algorithm>
#include <set>

#include "core/mesh/node_elements.h"
#include "core/quality/quality_sum.h"

namespace curvewright {
namespace {

std::set<int> entities_of(const MeshTopology& topology, const PhysicalGroup& group) {
    std::set<int> tags;
    for (const Entity& entity : topology.entities())
        if (entity.dimension == group.dimension && std::find(entity.physical_tags.begin(), entity.physical_tags.end(),
                                                             group.tag) != entity.physical_tags.end())
            tags.insert(entity.tag);
    return tags;
}

/// The elements that have all nodes of a cell.
void add_owners(const MeshTopology& topology, const NodeElements& node_elements, std::span<const Index> cell,
                std::vector<bool>& is_in) {
    for (const Index element : node_elements.of(cell.front())) {
        const auto nodes = topology.element_nodes(element);
        if (std::all_of(cell.begin(), cell.end(),
                        [&](Index node) { return std::find(nodes.begin(), nodes.end(), node) != nodes.end(); }))
            is_in[static_cast<std::size_t>(element)] = true;
    }
}

QualitySummary summarize(const QualityReport& report, const std::vector<bool>& is_in) {
    QualitySum sum;
    for (std::size_t i = 0; i < is_in.size(); ++i)
        if (is_in[i]) sum.add(report.elements[i]);
    return sum.result();
}

}  // namespace

std::vector<ReportGroup> group_statistics(const MeshTopology& topology, const QualityReport& before,
                                          const QualityReport& after) {
    std::vector<ReportGroup> result;
    const auto count = static_cast<std::size_t>(topology.element_count());
    const auto add = [&](std::string name, int dimension, const std::vector<bool>& is_in) {
        if (std::find(is_in.begin(), is_in.end(), true) != is_in.end())
            result.push_back({std::move(name), dimension, summarize(before, is_in), summarize(after, is_in)});
    };
    std::vector<bool> is_in_none(count, true);
    bool has_groups_of_elements = false;
    for (const PhysicalGroup& group : topology.groups()) {
        if (group.dimension != topology.dimension()) continue;
        has_groups_of_elements = true;
        const std::set<int> entities = entities_of(topology, group);
        std::vector<bool> is_in(count, false);
        for (Index element = 0; element < topology.element_count(); ++element) {
            if (!entities.contains(topology.element_entity(element))) continue;
            is_in[static_cast<std::size_t>(element)] = true;
            is_in_none[static_cast<std::size_t>(element)] = false;
        }
        add(MeshTopology::display_name(group), group.dimension, is_in);
    }
    if (has_groups_of_elements) add({}, topology.dimension(), is_in_none);
    const NodeElements node_elements = elements_of_nodes(topology);
    for (int dimension = topology.dimension() - 1; dimension >= 0; --dimension)
        for (const PhysicalGroup& group : topology.groups()) {
            if (group.dimension != dimension) continue;
            const std::set<int> entities = entities_of(topology, group);
            std::vector<bool> is_in(count, false);
            for (const ElementBlock& block : topology.blocks()) {
                if (curvewright::dimension(block.type.shape) != dimension || !entities.contains(block.entity_tag))
                    continue;
                const auto per_cell = static_cast<std::size_t>(node_count(block.type));
                for (std::size_t cell = 0; cell + per_cell <= block.nodes.size(); cell += per_cell)
                    add_owners(topology, node_elements, std::span(block.nodes).subspan(cell, per_cell), is_in);
            }
            add(MeshTopology::display_name(group), dimension, is_in);
        }
    return result;
}

std::vector<std::string> groups_of(const MeshTopology& topology, Index element) {
    std::vector<std::string> names;
    for (const PhysicalGroup& group : topology.groups())
        if (group.dimension == topology.dimension() &&
            entities_of(topology, group).contains(topology.element_entity(element)))
            names.push_back(MeshTopology::display_name(group));
    return names;
}

}  // namespace curvewright
