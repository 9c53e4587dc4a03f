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

using EntityKey = std::pair<int, int>;  // dimension and tag

BoundaryMode stricter(BoundaryMode a, BoundaryMode b) {
    return std::min(a, b);  // the enumeration begins with the strictest
}

std::vector<Index> sorted(std::vector<Index> nodes) {
    std::sort(nodes.begin(), nodes.end());
    return nodes;
}

/// Entities of every group of a name, by dimension; none if there is no such group.
std::optional<std::set<EntityKey>> entities_of_group(const MeshTopology& topology, std::string_view name) {
    std::set<EntityKey> entities;
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

std::vector<Facet> geometry_facets(const MeshTopology& topology) {
    std::vector<Facet> facets = topology.boundary_facets();
    facets.insert(facets.end(), topology.interface_facets().begin(), topology.interface_facets().end());
    return facets;
}

namespace {

/// Per geometry facet: the entity of the cell that lies on it; 0 = none.
std::vector<int> entities_of_facets(const MeshTopology& topology, const std::vector<Facet>& facets) {
    std::vector<int> entities(facets.size(), 0);
    std::map<std::vector<Index>, std::size_t> facet_of;
    for (std::size_t f = 0; f < facets.size(); ++f) facet_of.emplace(sorted(topology.facet_nodes(facets[f])), f);
    for (const ElementBlock& block : topology.blocks()) {
        if (dimension(block.type.shape) != topology.dimension() - 1) continue;
        const auto size = static_cast<std::ptrdiff_t>(node_count(block.type));
        for (auto first = block.nodes.begin(); first != block.nodes.end(); first += size) {
            const auto found = facet_of.find(sorted(std::vector<Index>(first, first + size)));
            if (found != facet_of.end()) entities[found->second] = block.entity_tag;
        }
    }
    return entities;
}

}  // namespace

const char* const all_interfaces_name = "interfaces";

std::map<Index, std::set<std::string>> names_of_interface_nodes(const MeshTopology& topology) {
    std::map<EntityKey, std::set<std::string>> names_of;
    for (const Entity& entity : topology.entities())
        for (const PhysicalGroup& group : topology.groups())
            if (group.dimension == entity.dimension && entity.dimension < topology.dimension() &&
                std::count(entity.physical_tags.begin(), entity.physical_tags.end(), group.tag) > 0)
                names_of[{entity.dimension, entity.tag}].insert(MeshTopology::display_name(group));
    std::map<Index, std::set<std::string>> names;
    for (const ElementBlock& block : topology.blocks()) {
        const auto found = names_of.find({dimension(block.type.shape), block.entity_tag});
        if (found == names_of.end()) continue;
        for (const Index node : block.nodes)
            if (topology.is_interface_node(node)) names[node].insert(found->second.begin(), found->second.end());
    }
    for (const Index node : topology.interface_nodes()) {
        std::set<std::string>& of_node = names[node];
        if (of_node.empty()) of_node.insert(all_interfaces_name);
    }
    return names;
}

BoundaryModes resolve(const BoundaryRules& rules, const MeshTopology& topology) {
    if (!(rules.feature_angle > 0.0 && rules.feature_angle < 180.0))
        throw InvalidInput(
            fmt::format("The feature angle is {} degrees; it must be above 0 and below 180.", rules.feature_angle));
    const int facet_dimension = topology.dimension() - 1;
    const std::vector<Facet> facets = geometry_facets(topology);
    const std::size_t on_boundary = topology.boundary_facets().size();
    BoundaryModes modes;
    modes.facet_entities = entities_of_facets(topology, facets);

    std::vector<std::optional<BoundaryMode>> named(facets.size());
    std::vector<std::optional<BoundaryMode>> named_nodes(static_cast<std::size_t>(topology.node_count()));
    for (const BoundaryRules::Rule& rule : rules.groups) {
        const auto name = [&](std::optional<BoundaryMode>& mode) {
            mode = mode ? stricter(*mode, rule.mode) : rule.mode;
        };
        const auto entities = entities_of_group(topology, rule.group);
        if (!entities && rule.group == all_interfaces_name) {
            std::for_each(named.begin() + static_cast<std::ptrdiff_t>(on_boundary), named.end(), name);
            for (const Index node : topology.interface_nodes()) name(named_nodes[node]);
            continue;
        }
        if (!entities)
            throw InvalidInput(
                fmt::format("There is no group '{}' for the boundary; {}.", rule.group, known_groups(topology)));
        const auto has_element = [&](Index element) {
            return entities->contains({facet_dimension + 1, topology.element_entity(element)});
        };
        for (std::size_t f = 0; f < facets.size(); ++f)
            if (entities->contains({facet_dimension, modes.facet_entities[f]}) || has_element(facets[f].element) ||
                (f >= on_boundary && has_element(topology.interface_neighbours()[f - on_boundary])))
                name(named[f]);
        for (const ElementBlock& block : topology.blocks())
            if (dimension(block.type.shape) < facet_dimension &&
                entities->contains({dimension(block.type.shape), block.entity_tag}))
                for (const Index node : block.nodes) name(named_nodes[node]);
    }
    // Nodes of curves and points inside the domain that are on no interface facet stay unless their group is named.
    std::vector<char> is_on_facet(static_cast<std::size_t>(topology.node_count()), 0);
    modes.nodes.assign(static_cast<std::size_t>(topology.node_count()), BoundaryMode::free);
    for (std::size_t f = 0; f < facets.size(); ++f) {
        modes.facets.push_back(named[f].value_or(f < on_boundary ? rules.otherwise : BoundaryMode::fixed));
        for (const Index node : topology.facet_nodes(facets[f])) {
            is_on_facet[node] = 1;
            modes.nodes[node] = stricter(modes.nodes[node], modes.facets[f]);
        }
    }
    for (Index node = 0; node < topology.node_count(); ++node) {
        const bool is_geometry = topology.is_boundary_node(node) || topology.is_interface_node(node);
        if (named_nodes[node] && is_geometry) modes.nodes[node] = stricter(modes.nodes[node], *named_nodes[node]);
        if (topology.is_interface_node(node) && is_on_facet[node] == 0 && !named_nodes[node])
            modes.nodes[node] = BoundaryMode::fixed;
    }
    return modes;
}

}  // namespace curvewright
