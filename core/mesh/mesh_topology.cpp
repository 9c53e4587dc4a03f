#include "core/mesh/mesh_topology.h"

#include <algorithm>
#include <limits>
#include <map>
#include <set>

#include <fmt/format.h>

#include "core/base/error.h"
#include "core/basis/reference_element.h"

namespace curvewright {
namespace {

std::vector<Index> sorted(std::vector<Index> nodes) {
    std::sort(nodes.begin(), nodes.end());
    return nodes;
}

using Corners = std::array<Index, 4>;

/// The first `count` of the nodes, sorted, as a key.
Corners corner_key(const Index* nodes, int count) {
    Corners corners{-1, -1, -1, -1};
    std::copy_n(nodes, count, corners.begin());
    std::sort(corners.begin(), corners.end());
    return corners;
}

bool is_before(const Facet& a, const Facet& b) {
    return std::pair(a.element, a.local) < std::pair(b.element, b.local);
}

/// Per block a number that blocks share if their entities are in the same physical groups (none is a set, too).
std::vector<int> regions_of_blocks(const MeshData& data) {
    std::map<std::pair<int, int>, std::vector<int>> groups_of;
    for (const Entity& entity : data.entities) {
        std::vector<int> tags = entity.physical_tags;
        std::sort(tags.begin(), tags.end());
        groups_of.emplace(std::pair(entity.dimension, entity.tag), std::move(tags));
    }
    std::map<std::vector<int>, int> numbers;
    std::vector<int> regions;
    for (const ElementBlock& block : data.blocks) {
        const auto found = groups_of.find({curvewright::dimension(block.type.shape), block.entity_tag});
        const std::vector<int>& groups = found == groups_of.end() ? std::vector<int>() : found->second;
        regions.push_back(numbers.try_emplace(groups, static_cast<int>(numbers.size())).first->second);
    }
    return regions;
}

}  // namespace

MeshTopology::MeshTopology(MeshData data) : data_(std::move(data)) {
    check_nodes_and_blocks();
    number_elements();
    const std::vector<FacetKey> keys = facet_keys();
    find_boundary(keys);
    find_interfaces(keys);
}

void MeshTopology::check_nodes_and_blocks() {
    constexpr auto most = static_cast<std::size_t>(std::numeric_limits<Index>::max());
    std::size_t cells = 0;
    for (const ElementBlock& block : data_.blocks) cells += block.tags.size();
    if (data_.node_tags.size() > most || cells > most)
        throw Unsupported(fmt::format("The mesh has {} nodes and {} cells; at most {} of each are supported.",
                                      data_.node_tags.size(), cells, most));
    node_of_tag_.reserve(data_.node_tags.size());
    for (Index node = 0; node < node_count(); ++node) {
        const NodeTag tag = data_.node_tags[node];
        if (!node_of_tag_.emplace(tag, node).second)
            throw InvalidInput(fmt::format("Node {} occurs twice; node tags must be unique.", tag.value));
    }
    if (!data_.node_entities.empty() && data_.node_entities.size() != data_.node_tags.size())
        throw InvalidInput("The entities of the nodes are as many as the nodes, or none.");
    std::set<std::pair<int, int>> entities;
    for (const Entity& entity : data_.entities)
        if (!entities.emplace(entity.dimension, entity.tag).second)
            throw InvalidInput(fmt::format("Entity {} of dimension {} occurs twice.", entity.tag, entity.dimension));
    for (const PeriodicLink& link : data_.periodic)
        for (const auto& [node, master] : link.nodes)
            if (std::min(node, master) < 0 || std::max(node, master) >= node_count())
                throw InvalidInput(
                    fmt::format("Periodic entity {} of dimension {} refers to a node that does not exist.", link.tag,
                                link.dimension));
    std::vector<Index> sorted;
    for (const ElementBlock& block : data_.blocks) {
        if (block.type.order < 1 || block.type.order > max_order)
            throw Unsupported(fmt::format("Element {} is of order {}; orders 1 to {} are supported.",
                                          block.tags.empty() ? 0 : block.tags.front().value, block.type.order,
                                          max_order));
        const std::size_t per_element = static_cast<std::size_t>(curvewright::node_count(block.type));
        if (block.nodes.size() != per_element * block.tags.size())
            throw InvalidInput(fmt::format("A block of {} elements of type {} has {} nodes instead of {}.",
                                           block.tags.size(), name(block.type), block.nodes.size(),
                                           per_element * block.tags.size()));
        for (std::size_t i = 0; i < block.tags.size(); ++i) {
            const auto first = block.nodes.begin() + static_cast<std::ptrdiff_t>(i * per_element);
            sorted.assign(first, first + static_cast<std::ptrdiff_t>(per_element));
            std::sort(sorted.begin(), sorted.end());
            if (sorted.front() < 0 || sorted.back() >= node_count())
                throw InvalidInput(
                    fmt::format("Element {} refers to a node that does not exist.", block.tags[i].value));
            const auto twin = std::adjacent_find(sorted.begin(), sorted.end());
            if (twin != sorted.end())
                throw InvalidInput(fmt::format("Element {} has node {} twice; its nodes must differ.",
                                               block.tags[i].value, data_.node_tags[*twin].value));
        }
    }
}

void MeshTopology::number_elements() {
    for (const ElementBlock& block : data_.blocks)
        if (block.size() > 0) dimension_ = std::max(dimension_, curvewright::dimension(block.type.shape));
    bool is_uniform = true;
    for (std::size_t b = 0; b < data_.blocks.size(); ++b) {
        const ElementBlock& block = data_.blocks[b];
        if (block.size() == 0 || curvewright::dimension(block.type.shape) != dimension_ || dimension_ == 0) continue;
        if (!uniform_type_) uniform_type_ = block.type;
        is_uniform = is_uniform && *uniform_type_ == block.type;
        order_ = std::max(order_, block.type.order);
        for (Index i = 0; i < block.size(); ++i) {
            element_block_.push_back(static_cast<Index>(b));
            element_in_block_.push_back(i);
        }
    }
    if (!is_uniform) uniform_type_.reset();
    element_of_tag_.reserve(element_block_.size());
    for (Index element = 0; element < element_count(); ++element)
        if (!element_of_tag_.emplace(element_tag(element), element).second)
            throw InvalidInput(
                fmt::format("Element {} occurs twice; element tags must be unique.", element_tag(element).value));
}

/// Whether the elements on the two sides of a facet number its corners in opposite senses, as they should; none if the
/// corners are not even in the same order around the facet.
std::optional<bool> MeshTopology::are_numbered_alike(Facet a, Facet b) const {
    const auto corners = [this](Facet facet, std::array<Index, 4>& of) {
        const SubElement& its = reference_element(element_type(facet.element)).facets[facet.local];
        const auto nodes = element_nodes(facet.element);
        const int count = corner_count(its.type.shape);
        for (int i = 0; i < count; ++i) of[i] = nodes[its.nodes[i]];
        return count;
    };
    std::array<Index, 4> first{}, second{};
    const int count = corners(a, first);
    corners(b, second);
    if (count == 1) return a.local != b.local;
    const auto start = std::find(second.begin(), second.begin() + count, first[0]) - second.begin();
    if (count == 2) return start != 0;
    if (second[(start + count - 1) % count] == first[1]) return true;
    if (second[(start + 1) % count] == first[1]) return false;
    return std::nullopt;
}

std::vector<MeshTopology::FacetKey> MeshTopology::facet_keys() const {
    std::vector<FacetKey> keys;
    for (Index element = 0; element < element_count(); ++element) {
        const auto nodes = element_nodes(element);
        const auto& facets = reference_element(element_type(element)).facets;
        for (std::size_t local = 0; local < facets.size(); ++local) {
            FacetKey key{{-1, -1, -1, -1}, {element, static_cast<int>(local)}};
            const int corners = corner_count(facets[local].type.shape);
            for (int i = 0; i < corners; ++i) key.corners[i] = nodes[facets[local].nodes[i]];
            std::sort(key.corners.begin(), key.corners.end());
            keys.push_back(key);
        }
    }
    std::sort(keys.begin(), keys.end(), [](const FacetKey& a, const FacetKey& b) { return a.corners < b.corners; });
    return keys;
}

void MeshTopology::find_boundary(const std::vector<FacetKey>& keys) {
    WindingFinder winding(element_count());
    for (std::size_t i = 0; i < keys.size();) {
        std::size_t end = i + 1;
        while (end < keys.size() && keys[end].corners == keys[i].corners) ++end;
        // Facets with the same corners but other nodes between them do not meet: each is on the boundary, so that
        // nothing pulls them apart further.
        bool meet = end > i + 1;
        if (meet && order_ > 1) {
            const std::vector<Index> nodes = sorted(facet_nodes(keys[i].facet));
            for (std::size_t k = i + 1; k < end && meet; ++k) meet = sorted(facet_nodes(keys[k].facet)) == nodes;
        }
        for (std::size_t k = i; k < end && !meet; ++k) boundary_facets_.push_back(keys[k].facet);
        if (meet && end == i + 2)
            if (const auto are_alike = are_numbered_alike(keys[i].facet, keys[i + 1].facet))
                winding.meet(keys[i].facet.element, keys[i + 1].facet.element, *are_alike);
        i = end;
    }
    winding_ = winding.find();
    std::sort(boundary_facets_.begin(), boundary_facets_.end(), is_before);

    role_.assign(static_cast<std::size_t>(node_count()), Role::unused);
    for (Index element = 0; element < element_count(); ++element)
        for (Index node : element_nodes(element)) role_[node] = Role::interior;
    for (const Facet& facet : boundary_facets_)
        for (Index node : facet_nodes(facet)) role_[node] = Role::boundary;
    for (Index node = 0; node < node_count(); ++node) {
        if (role_[node] == Role::boundary) boundary_nodes_.push_back(node);
        if (role_[node] == Role::interior) interior_nodes_.push_back(node);
    }
}

void MeshTopology::find_interfaces(const std::vector<FacetKey>& keys) {
    is_interface_node_.assign(static_cast<std::size_t>(node_count()), 0);
    const std::vector<int> regions = regions_of_blocks(data_);
    std::vector<Corners> stored;  // cells of the facets' dimension
    std::set<std::pair<int, int>> named, borders;
    for (const Entity& entity : data_.entities) {
        if (!entity.physical_tags.empty()) named.emplace(entity.dimension, entity.tag);
        if (entity.is_partition_border()) borders.emplace(entity.dimension, entity.tag);
    }
    for (const ElementBlock& block : data_.blocks) {
        const int dim = curvewright::dimension(block.type.shape);
        if (dim >= dimension_ || borders.contains({dim, block.entity_tag})) continue;
        const auto per_cell = static_cast<std::size_t>(curvewright::node_count(block.type));
        if (dim == dimension_ - 1) {
            for (std::size_t first = 0; first < block.nodes.size(); first += per_cell)
                stored.push_back(corner_key(block.nodes.data() + first, corner_count(block.type.shape)));
        } else if (named.contains({dim, block.entity_tag})) {
            for (const Index node : block.nodes) is_interface_node_[node] = 1;
        }
    }
    std::sort(stored.begin(), stored.end());

    struct Interface {
        Facet facet;
        Index neighbour;
    };
    std::vector<Interface> found;
    std::vector<Facet> meeting;
    auto cell = stored.begin();
    for (std::size_t i = 0; i < keys.size();) {
        std::size_t end = i + 1;
        while (end < keys.size() && keys[end].corners == keys[i].corners) ++end;
        while (cell != stored.end() && *cell < keys[i].corners) ++cell;
        const bool has_cell = cell != stored.end() && *cell == keys[i].corners;
        const auto region = [&](const FacetKey& key) { return regions[element_block_[key.facet.element]]; };
        const bool differ = std::any_of(keys.begin() + static_cast<std::ptrdiff_t>(i) + 1,
                                        keys.begin() + static_cast<std::ptrdiff_t>(end),
                                        [&](const FacetKey& key) { return region(key) != region(keys[i]); });
        const bool is_inside = end > i + 1 && !std::binary_search(boundary_facets_.begin(), boundary_facets_.end(),
                                                                  keys[i].facet, is_before);
        if (is_inside && (differ || has_cell)) {
            meeting.clear();
            for (; i < end; ++i) meeting.push_back(keys[i].facet);
            std::sort(meeting.begin(), meeting.end(), is_before);
            found.push_back({meeting[0], meeting[1].element});
        }
        i = end;
    }
    std::sort(found.begin(), found.end(),
              [](const Interface& a, const Interface& b) { return is_before(a.facet, b.facet); });
    for (const Interface& one : found) {
        interface_facets_.push_back(one.facet);
        interface_neighbours_.push_back(one.neighbour);
    }
    for (const Facet& facet : interface_facets_)
        for (const Index node : facet_nodes(facet)) is_interface_node_[node] = 1;
    for (Index node = 0; node < node_count(); ++node) {
        if (!is_interior_node(node)) is_interface_node_[node] = 0;
        if (is_interface_node_[node] != 0) interface_nodes_.push_back(node);
    }
}

std::optional<Index> MeshTopology::find_node(NodeTag tag) const {
    const auto found = node_of_tag_.find(tag);
    if (found == node_of_tag_.end()) return std::nullopt;
    return found->second;
}

std::optional<Index> MeshTopology::find_element(ElementTag tag) const {
    const auto found = element_of_tag_.find(tag);
    if (found == element_of_tag_.end()) return std::nullopt;
    return found->second;
}

ElementTag MeshTopology::element_tag(Index element) const {
    return data_.blocks[element_block_[element]].tags[element_in_block_[element]];
}

std::span<const Index> MeshTopology::element_nodes(Index element) const {
    const ElementBlock& block = data_.blocks[element_block_[element]];
    const auto count = static_cast<std::size_t>(curvewright::node_count(block.type));
    return std::span(block.nodes).subspan(static_cast<std::size_t>(element_in_block_[element]) * count, count);
}

std::vector<Index> MeshTopology::facet_nodes(Facet facet) const {
    const auto nodes = element_nodes(facet.element);
    std::vector<Index> result;
    for (int node : reference_element(element_type(facet.element)).facets[facet.local].nodes)
        result.push_back(nodes[node]);
    return result;
}

std::optional<std::vector<Index>> MeshTopology::find_group_nodes(std::string_view name) const {
    std::vector<bool> in_group(static_cast<std::size_t>(node_count()), false);
    bool found = false;
    for (const PhysicalGroup& group : data_.groups) {
        if (display_name(group) != name) continue;
        found = true;
        std::set<int> entities;
        for (const Entity& entity : data_.entities)
            if (entity.dimension == group.dimension &&
                std::find(entity.physical_tags.begin(), entity.physical_tags.end(), group.tag) !=
                    entity.physical_tags.end())
                entities.insert(entity.tag);
        for (const ElementBlock& block : data_.blocks)
            if (curvewright::dimension(block.type.shape) == group.dimension && entities.contains(block.entity_tag))
                for (Index node : block.nodes) in_group[node] = true;
    }
    if (!found) {
        if (name == "boundary" || name == "all_boundary") return boundary_nodes_;
        if (name != "all") return std::nullopt;
        in_group.assign(in_group.size(), true);
    }
    std::vector<Index> nodes;
    for (Index node = 0; node < node_count(); ++node)
        if (in_group[node]) nodes.push_back(node);
    return nodes;
}

std::string MeshTopology::display_name(const PhysicalGroup& group) {
    return group.name.empty() ? fmt::format("{}:{}", group.dimension, group.tag) : group.name;
}

}  // namespace curvewright
