#include "core/boundary/boundary_rules.h"

#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/base/error.h"

namespace curvewright {
namespace {

constexpr std::array<std::pair<std::string_view, BoundaryMode>, 3> mode_names = {
    {{"fixed", BoundaryMode::fixed}, {"slide", BoundaryMode::slide}, {"free", BoundaryMode::free}}};

BoundaryMode stricter(BoundaryMode a, BoundaryMode b) {
    return std::min(a, b);  // the enumeration begins with the strictest
}

std::vector<Index> sorted(std::vector<Index> nodes) {
    std::sort(nodes.begin(), nodes.end());
    return nodes;
}

/// Entities of every group of a name, by dimension; none if there is no such group.
std::optional<std::set<std::pair<int, int>>> entities_of_group(const MeshTopology& topology, std::string_view name) {
    std::set<std::pair<int, int>> entities;
    bool is_known = false;
    for (const PhysicalGroup& group : topology.groups()) {
        if (MeshTopology::display_name(group) != name) continue;
        is_known = true;
        for (const Entity& entity : topology.entities())
            if (entity.dimension == group.dimension &&
                std::count(entity.physical_tags.begin(), entity.physical_tags.end(), group.tag) > 0)
                entities.emplace(entity.dimension, entity.tag);
    }
    if (!is_known) return std::nullopt;
    return entities;
}

std::string known_groups(const MeshTopology& topology) {
    std::set<std::string> names;
    for (const PhysicalGroup& group : topology.groups()) names.insert(MeshTopology::display_name(group));
    return names.empty() ? "the mesh has no groups" : fmt::format("the mesh has {}", fmt::join(names, ", "));
}

}  // namespace

bool BoundaryRules::is_all_fixed() const {
    return otherwise == BoundaryMode::fixed &&
           std::all_of(groups.begin(), groups.end(), [](const Rule& rule) { return rule.mode == BoundaryMode::fixed; });
}

void BoundaryRules::add(std::string_view text) {
    const auto equals = text.rfind('=');
    const std::string_view word = equals == std::string_view::npos ? text : text.substr(equals + 1);
    const auto mode =
        std::find_if(mode_names.begin(), mode_names.end(), [&](const auto& m) { return m.first == word; });
    if (mode == mode_names.end() || equals == 0)
        throw InvalidInput(fmt::format(
            "The boundary rule '{}' is not understood; expected fixed, slide or free, or GROUP=fixed, GROUP=slide or "
            "GROUP=free.",
            text));
    if (equals == std::string_view::npos)
        otherwise = mode->second;
    else
        groups.push_back({std::string(text.substr(0, equals)), mode->second});
}

BoundaryModes resolve(const BoundaryRules& rules, const MeshTopology& topology) {
    if (!(rules.feature_angle > 0.0 && rules.feature_angle < 180.0))
        throw InvalidInput(
            fmt::format("The feature angle is {} degrees; it must be above 0 and below 180.", rules.feature_angle));
    const int facet_dimension = topology.dimension() - 1;
    const std::vector<Facet>& facets = topology.boundary_facets();
    BoundaryModes modes;
    modes.facet_entities.assign(facets.size(), 0);
    std::map<std::vector<Index>, std::size_t> facet_of;
    for (std::size_t f = 0; f < facets.size(); ++f) facet_of.emplace(sorted(topology.facet_nodes(facets[f])), f);
    for (const ElementBlock& block : topology.blocks()) {
        if (dimension(block.type.shape) != facet_dimension) continue;
        const auto size = static_cast<std::ptrdiff_t>(node_count(block.type));
        for (auto first = block.nodes.begin(); first != block.nodes.end(); first += size) {
            const auto found = facet_of.find(sorted(std::vector<Index>(first, first + size)));
            if (found != facet_of.end()) modes.facet_entities[found->second] = block.entity_tag;
        }
    }

    std::vector<std::optional<BoundaryMode>> named(facets.size());
    modes.nodes.assign(static_cast<std::size_t>(topology.node_count()), BoundaryMode::free);
    for (const BoundaryRules::Rule& rule : rules.groups) {
        const auto entities = entities_of_group(topology, rule.group);
        if (!entities)
            throw InvalidInput(
                fmt::format("There is no group '{}' for the boundary; {}.", rule.group, known_groups(topology)));
        for (std::size_t f = 0; f < facets.size(); ++f)
            if (entities->contains({facet_dimension, modes.facet_entities[f]}) ||
                entities->contains({facet_dimension + 1, topology.element_entity(facets[f].element)}))
                named[f] = named[f] ? stricter(*named[f], rule.mode) : rule.mode;
        for (const ElementBlock& block : topology.blocks())
            if (dimension(block.type.shape) < facet_dimension &&
                entities->contains({dimension(block.type.shape), block.entity_tag}))
                for (const Index node : block.nodes) modes.nodes[node] = stricter(modes.nodes[node], rule.mode);
    }
    for (std::size_t f = 0; f < facets.size(); ++f) {
        modes.facets.push_back(named[f].value_or(rules.otherwise));
        for (const Index node : topology.facet_nodes(facets[f]))
            modes.nodes[node] = stricter(modes.nodes[node], modes.facets[f]);
    }
    // Groups of points and curves speak of the boundary only.
    for (const Index node : topology.interior_nodes()) modes.nodes[node] = BoundaryMode::free;
    return modes;
}

}  // namespace curvewright
