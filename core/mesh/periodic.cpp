#include "core/mesh/periodic.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <set>
#include <unordered_map>

#include <fmt/format.h>

#include "core/basis/lagrange.h"
#include "core/mesh/mesh_topology.h"

namespace curvewright {
namespace {

/// The place of a node among corners: those with a weight that is not zero, ascending, and the weights as integers in
/// lowest terms.
using NodePlace = std::vector<std::pair<Index, long>>;

/// Multilinear weights of a cell's corners at its nodes, nodes × corners, times order^dimension.
Eigen::MatrixXd integer_weights(ElementType type) {
    if (type.shape == Shape::vertex) return Eigen::MatrixXd::Ones(1, 1);
    const double scale = std::pow(type.order, dimension(type.shape));
    return lagrange_basis({type.shape, 1}, reference_nodes(type)).values * scale;
}

void reduce(NodePlace& place) {
    std::sort(place.begin(), place.end());
    long divisor = 0;
    for (const auto& [corner, weight] : place) divisor = std::gcd(divisor, weight);
    for (auto& [corner, weight] : place) weight /= std::max(divisor, 1L);
}

/// Tags of an entity and of its parts in a partitioned mesh.
std::set<int> tags_of(const MeshData& data, int dim, int tag) {
    std::set<int> tags = {tag};
    for (const Entity& entity : data.entities)
        if (entity.dimension == dim && entity.is_partition() && entity.parent_dimension == dim &&
            entity.parent_tag == tag)
            tags.insert(entity.tag);
    return tags;
}

/// Calls visit(node, place) for every node of the cells on an entity.
template <class Visit>
void visit_places(const MeshData& data, int dim, int tag, const Visit& visit) {
    const std::set<int> tags = tags_of(data, dim, tag);
    for (const ElementBlock& block : data.blocks) {
        if (dimension(block.type.shape) != dim || !tags.contains(block.entity_tag) || block.size() == 0) continue;
        if (block.type.shape == Shape::pyramid) continue;  // no boundary cell
        const Eigen::MatrixXd weights = integer_weights(block.type);
        for (Index cell = 0; cell < block.size(); ++cell) {
            const Index* nodes = block.nodes.data() + static_cast<std::ptrdiff_t>(cell) * weights.rows();
            for (Eigen::Index i = 0; i < weights.rows(); ++i) {
                NodePlace place;
                for (Eigen::Index corner = 0; corner < weights.cols(); ++corner)
                    if (const long weight = std::lround(weights(i, corner)); weight != 0)
                        place.emplace_back(nodes[corner], weight);
                reduce(place);
                visit(nodes[i], place);
            }
        }
    }
}

/// Nodes of the cells on an entity, ascending.
std::set<Index> nodes_on(const MeshData& data, int dim, int tag) {
    std::set<Index> nodes;
    const std::set<int> tags = tags_of(data, dim, tag);
    for (const ElementBlock& block : data.blocks)
        if (dimension(block.type.shape) == dim && tags.contains(block.entity_tag))
            nodes.insert(block.nodes.begin(), block.nodes.end());
    return nodes;
}

}  // namespace

void renumber_periodic(std::vector<PeriodicLink>& links, const std::vector<Index>& new_index) {
    for (PeriodicLink& link : links) {
        std::vector<std::pair<Index, Index>> kept;
        std::set<std::pair<Index, Index>> seen;
        for (const auto& [node, master] : link.nodes) {
            const std::pair<Index, Index> pair{new_index[static_cast<std::size_t>(node)],
                                               new_index[static_cast<std::size_t>(master)]};
            if (pair.first >= 0 && pair.second >= 0 && seen.insert(pair).second) kept.push_back(pair);
        }
        link.nodes = std::move(kept);
    }
}

std::vector<PeriodicLink> periodic_of_new_order(const MeshTopology& old, const MeshData& data) {
    std::vector<PeriodicLink> links = old.data().periodic;
    if (links.empty()) return links;
    // Corners, and nodes of no cell, are those that stay; the tag of another node may stand for a new one.
    std::vector<char> goes(static_cast<std::size_t>(old.node_count()), 0), stays = goes;
    for (const ElementBlock& block : old.blocks()) {
        const auto per_cell = static_cast<std::size_t>(node_count(block.type));
        const auto corners = static_cast<std::size_t>(corner_count(block.type.shape));
        for (std::size_t i = 0; i < block.nodes.size(); ++i)
            (i % per_cell < corners ? stays : goes)[static_cast<std::size_t>(block.nodes[i])] = 1;
    }
    std::unordered_map<NodeTag, Index> node_of_tag;
    for (std::size_t node = 0; node < data.node_tags.size(); ++node)
        node_of_tag.emplace(data.node_tags[node], static_cast<Index>(node));
    std::vector<Index> new_index(static_cast<std::size_t>(old.node_count()), -1);
    for (std::size_t node = 0; node < new_index.size(); ++node) {
        if (goes[node] != 0 && stays[node] == 0) continue;
        const auto found = node_of_tag.find(old.data().node_tags[node]);
        if (found != node_of_tag.end()) new_index[node] = found->second;
    }
    renumber_periodic(links, new_index);

    for (PeriodicLink& link : links) {
        if (link.dimension == 0) continue;
        std::map<Index, Index> master_of(link.nodes.begin(), link.nodes.end());
        std::map<NodePlace, Index> on_master;
        visit_places(data, link.dimension, link.master_tag,
                     [&](Index node, const NodePlace& place) { on_master.emplace(place, node); });
        std::map<Index, Index> added;
        visit_places(data, link.dimension, link.tag, [&](Index node, NodePlace place) {
            if (place.size() < 2) return;
            for (auto& [corner, weight] : place) {
                const auto master = master_of.find(corner);
                if (master == master_of.end()) return;
                corner = master->second;
            }
            std::sort(place.begin(), place.end());
            if (const auto found = on_master.find(place); found != on_master.end()) added.emplace(node, found->second);
        });
        link.nodes.insert(link.nodes.end(), added.begin(), added.end());
    }
    return links;
}

std::vector<std::string> periodic_gaps(const MeshTopology& topology) {
    std::vector<std::string> gaps;
    for (const PeriodicLink& link : topology.data().periodic) {
        std::set<Index> left = nodes_on(topology.data(), link.dimension, link.tag);
        const bool has_cells = !left.empty() || link.dimension == 0;
        for (const auto& [node, master] : link.nodes) left.erase(node);
        if (has_cells && left.empty()) continue;
        gaps.push_back(has_cells
                           ? fmt::format("{} nodes of periodic entity {} of dimension {} have no counterpart on "
                                         "entity {} (the first is node {}).",
                                         left.size(), link.tag, link.dimension, link.master_tag,
                                         topology.node_tag(*left.begin()).value)
                           : fmt::format("Periodic entity {} of dimension {} has no cells of its own, so that only "
                                         "corners are known to have counterparts on entity {}.",
                                         link.tag, link.dimension, link.master_tag));
    }
    return gaps;
}

}  // namespace curvewright
