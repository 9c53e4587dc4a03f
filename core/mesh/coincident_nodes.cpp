#include "core/mesh/coincident_nodes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>

#include <fmt/format.h>

#include "core/base/error.h"
#include "core/basis/reference_element.h"

namespace curvewright {
namespace {

/// Sets of nodes; the lowest node of a set stands for it.
class NodeSets {
  public:
    explicit NodeSets(Index count) : parent_(static_cast<std::size_t>(count)) {
        std::iota(parent_.begin(), parent_.end(), 0);
    }
    Index find(Index node) {
        while (parent_[node] != node) node = parent_[node] = parent_[parent_[node]];
        return node;
    }
    void unite(Index a, Index b) {
        a = find(a);
        b = find(b);
        parent_[std::max(a, b)] = std::min(a, b);
    }

  private:
    std::vector<Index> parent_;
};

/// Nodes of unmatched facets and of cells of lower dimension, ascending.
std::vector<Index> candidates(const MeshTopology& topology) {
    std::vector<bool> is_candidate(static_cast<std::size_t>(topology.node_count()), false);
    for (const Index node : topology.boundary_nodes()) is_candidate[node] = true;
    for (const ElementBlock& block : topology.blocks())
        if (dimension(block.type.shape) < topology.dimension())
            for (const Index node : block.nodes)
                if (!topology.is_interior_node(node)) is_candidate[node] = true;
    std::vector<Index> nodes;
    for (Index node = 0; node < topology.node_count(); ++node)
        if (is_candidate[node]) nodes.push_back(node);
    return nodes;
}

/// Pairs of nodes of a cell that are next to each other on its lattice.
std::vector<std::pair<int, int>> lattice_neighbours(ElementType type) {
    std::vector<std::pair<int, int>> pairs;
    if (type.shape == Shape::vertex) return pairs;
    const std::vector<LatticePoint>& lattice = reference_element(type).lattice;
    for (int a = 0; a < static_cast<int>(lattice.size()); ++a)
        for (int b = a + 1; b < static_cast<int>(lattice.size()); ++b) {
            int farthest = 0;
            for (int d = 0; d < 3; ++d) farthest = std::max(farthest, std::abs(lattice[a][d] - lattice[b][d]));
            if (farthest <= 1) pairs.emplace_back(a, b);
        }
    return pairs;
}

/// Per node: the distance to the nearest of its neighbours in its elements; infinite for nodes of no element.
std::vector<double> spacings(const CurvedMesh& mesh) {
    const MeshTopology& topology = mesh.topology();
    std::vector<double> result(static_cast<std::size_t>(topology.node_count()),
                               std::numeric_limits<double>::infinity());
    std::map<ElementType, std::vector<std::pair<int, int>>> pairs_of;
    for (const ElementBlock& block : topology.blocks()) {
        if (dimension(block.type.shape) != topology.dimension()) continue;
        const auto [entry, is_new] = pairs_of.try_emplace(block.type);
        if (is_new) entry->second = lattice_neighbours(block.type);
        const auto per_cell = static_cast<std::size_t>(node_count(block.type));
        for (std::size_t first = 0; first < block.nodes.size(); first += per_cell)
            for (const auto& [i, j] : entry->second) {
                const Index a = block.nodes[first + i], b = block.nodes[first + j];
                const double distance = (mesh.coordinates().row(a) - mesh.coordinates().row(b)).norm();
                // A cell that is collapsed there already tells nothing.
                if (distance == 0.0) continue;
                result[a] = std::min(result[a], distance);
                result[b] = std::min(result[b], distance);
            }
    }
    return result;
}

using GridCell = std::array<std::int64_t, 3>;

/// Nodes in the cells of a grid whose sides are four times the search distance: most nodes need to be compared with
/// those of their own cell only.
class NodeGrid {
  public:
    NodeGrid(const Coordinates& x, const std::vector<Index>& nodes, const Eigen::RowVector3d& low, double distance)
        : x_(x), low_(low), distance_(distance), side_(4.0 * distance) {
        entries_.reserve(nodes.size());
        for (const Index node : nodes) entries_.emplace_back(cell_of(x_.row(node)), node);
        std::sort(entries_.begin(), entries_.end());
    }

    /// Calls found(node) for the nodes after `node` in the order of the grid that may be within the distance.
    template <class Found>
    void for_candidates(std::size_t position, const Found& found) const {
        const auto& [cell, node] = entries_[position];
        for (std::size_t k = position + 1; k < entries_.size() && entries_[k].first == cell; ++k)
            found(entries_[k].second);
        GridCell low = cell_of(x_.row(node).array() - distance_), high = cell_of(x_.row(node).array() + distance_);
        if (low == cell && high == cell) return;
        GridCell at{};
        for (at[0] = low[0]; at[0] <= high[0]; ++at[0])
            for (at[1] = low[1]; at[1] <= high[1]; ++at[1])
                for (at[2] = low[2]; at[2] <= high[2]; ++at[2]) {
                    if (at <= cell) continue;
                    auto entry = std::lower_bound(entries_.begin(), entries_.end(), std::pair(at, Index{0}));
                    for (; entry != entries_.end() && entry->first == at; ++entry) found(entry->second);
                }
    }
    std::size_t size() const { return entries_.size(); }
    Index node(std::size_t position) const { return entries_[position].second; }

  private:
    GridCell cell_of(const Eigen::RowVector3d& x) const {
        GridCell cell{};
        for (int d = 0; d < 3; ++d) cell[d] = static_cast<std::int64_t>(std::floor((x[d] - low_[d]) / side_));
        return cell;
    }

    const Coordinates& x_;
    Eigen::RowVector3d low_;
    double distance_, side_;
    std::vector<std::pair<GridCell, Index>> entries_;
};

/// Unites nodes with the same coordinates; returns one node of each place, ascending.
std::vector<Index> unite_equal(const Coordinates& x, std::vector<Index> nodes, NodeSets& sets) {
    const auto place = [&](Index node) { return std::tuple(x(node, 0), x(node, 1), x(node, 2)); };
    std::sort(nodes.begin(), nodes.end(),
              [&](Index a, Index b) { return std::pair(place(a), a) < std::pair(place(b), b); });
    std::vector<Index> distinct;
    for (const Index node : nodes) {
        if (!distinct.empty() && place(distinct.back()) == place(node))
            sets.unite(distinct.back(), node);
        else
            distinct.push_back(node);
    }
    std::sort(distinct.begin(), distinct.end());
    return distinct;
}

}  // namespace

Index CoincidentNodes::surplus() const {
    std::size_t count = 0;
    for (const std::vector<Index>& group : groups) count += group.size() - 1;
    return static_cast<Index>(count);
}

CoincidentNodes find_coincident_nodes(const CurvedMesh& mesh, const CoincidenceOptions& options,
                                      const TaskContext& context) {
    if (!(options.tolerance >= 0.0 && options.tolerance < 1.0))
        throw InvalidInput(
            fmt::format("Nodes cannot be merged within {} of the mesh's size; a tolerance is at least 0 "
                        "and less than 1.",
                        options.tolerance));
    const MeshTopology& topology = mesh.topology();
    const Coordinates& x = mesh.coordinates();
    NodeSets sets(topology.node_count());
    const std::vector<Index> all = candidates(topology);
    const std::vector<Index> distinct = unite_equal(x, all, sets);
    const auto box = bounding_box(mesh);
    const double distance = options.tolerance * (box.row(1) - box.row(0)).norm();
    // Below that the cells of the grid could not be numbered, and no coordinates differ by so little.
    if (options.tolerance >= 1e-17 && distance > 0.0) {
        std::vector<double> spacing;
        const NodeGrid grid(x, distinct, box.row(0), distance);
        for (std::size_t i = 0; i < grid.size(); ++i) {
            if (i % 4096 == 0) context.check();
            const Index node = grid.node(i);
            grid.for_candidates(i, [&](Index other) {
                const double apart = (x.row(node) - x.row(other)).norm();
                if (apart > distance || sets.find(node) == sets.find(other)) return;
                if (std::isfinite(options.spacing_share)) {
                    if (spacing.empty()) spacing = spacings(mesh);
                    // Two nodes of no element do not know how thin the elements between them are.
                    const double nearest = std::min(spacing[node], spacing[other]);
                    if (!std::isfinite(nearest) || apart > options.spacing_share * nearest) return;
                }
                sets.unite(node, other);
            });
        }
    }
    std::vector<Index> group_of(static_cast<std::size_t>(topology.node_count()), -1);
    std::vector<std::vector<Index>> groups;
    for (const Index node : all) {
        Index& group = group_of[sets.find(node)];
        if (group < 0) {
            group = static_cast<Index>(groups.size());
            groups.emplace_back();
        }
        groups[group].push_back(node);
    }
    std::erase_if(groups, [](const std::vector<Index>& group) { return group.size() < 2; });
    return {std::move(groups)};
}

bool has_separate_elements(const MeshTopology& topology) {
    std::vector<bool> is_used(static_cast<std::size_t>(topology.node_count()), false);
    for (Index element = 0; element < topology.element_count(); ++element)
        for (const Index node : topology.element_nodes(element)) {
            if (is_used[node]) return false;
            is_used[node] = true;
        }
    return topology.element_count() > 1;
}

CoincidentNodes without_collapsing(const MeshTopology& topology, const CoincidentNodes& nodes) {
    std::vector<Index> group_of(static_cast<std::size_t>(topology.node_count()), -1);
    for (std::size_t g = 0; g < nodes.groups.size(); ++g)
        for (const Index node : nodes.groups[g]) group_of[node] = static_cast<Index>(g);
    std::vector<bool> collapses(nodes.groups.size(), false);
    std::vector<Index> groups;
    for (const ElementBlock& block : topology.blocks()) {
        const auto per_cell = static_cast<std::size_t>(node_count(block.type));
        for (std::size_t first = 0; first < block.nodes.size(); first += per_cell) {
            groups.clear();
            for (std::size_t i = 0; i < per_cell; ++i)
                if (const Index group = group_of[block.nodes[first + i]]; group >= 0) groups.push_back(group);
            std::sort(groups.begin(), groups.end());
            for (std::size_t i = 1; i < groups.size(); ++i)
                if (groups[i] == groups[i - 1]) collapses[groups[i]] = true;
        }
    }
    CoincidentNodes result;
    for (std::size_t g = 0; g < nodes.groups.size(); ++g)
        if (!collapses[g]) result.groups.push_back(nodes.groups[g]);
    return result;
}

MergedMesh merge_nodes(const CurvedMesh& mesh, const CoincidentNodes& nodes) {
    const MeshTopology& topology = mesh.topology();
    MeshData data = topology.data();
    std::vector<Index> first_of(data.node_tags.size());
    std::iota(first_of.begin(), first_of.end(), 0);
    for (const std::vector<Index>& group : nodes.groups)
        for (const Index node : group) {
            first_of[node] = group.front();
            if (data.node_entities.empty() || data.node_entities[node].dimension < 0) continue;
            NodeEntity& kept = data.node_entities[group.front()];
            if (kept.dimension < 0 || data.node_entities[node].dimension < kept.dimension)
                kept = data.node_entities[node];
        }
    std::vector<Index> new_index(first_of.size(), -1);
    Index count = 0;
    for (std::size_t node = 0; node < first_of.size(); ++node) {
        // The first of a group stands before the others.
        if (first_of[node] != static_cast<Index>(node)) {
            new_index[node] = new_index[first_of[node]];
            continue;
        }
        data.node_tags[count] = data.node_tags[node];
        if (!data.node_entities.empty()) data.node_entities[count] = data.node_entities[node];
        new_index[node] = count++;
    }
    data.node_tags.resize(count);
    if (!data.node_entities.empty()) data.node_entities.resize(count);
    std::vector<std::pair<Index, Index>> of_cell;
    for (ElementBlock& block : data.blocks) {
        const auto per_cell = static_cast<std::size_t>(node_count(block.type));
        for (std::size_t i = 0; i < block.nodes.size(); ++i) {
            const Index old = block.nodes[i];
            block.nodes[i] = new_index[old];
            of_cell.emplace_back(new_index[old], old);
            if (of_cell.size() < per_cell) continue;
            std::sort(of_cell.begin(), of_cell.end());
            for (std::size_t k = 1; k < of_cell.size(); ++k) {
                if (of_cell[k].first != of_cell[k - 1].first) continue;
                const Index a = of_cell[k - 1].second, b = of_cell[k].second;
                throw InvalidInput(fmt::format(
                    "Nodes {} and {} of element {} would become one, as they are only {:.3g} apart; nodes can be "
                    "merged within a smaller tolerance only.",
                    topology.node_tag(a).value, topology.node_tag(b).value, block.tags[i / per_cell].value,
                    (mesh.coordinates().row(a) - mesh.coordinates().row(b)).norm()));
            }
            of_cell.clear();
        }
    }
    renumber_periodic(data.periodic, new_index);
    Coordinates x(count, 3);
    for (std::size_t node = first_of.size(); node-- > 0;)
        if (first_of[node] == static_cast<Index>(node))
            x.row(new_index[node]) = mesh.coordinates().row(static_cast<Eigen::Index>(node));
    return {{std::make_shared<const MeshTopology>(std::move(data)), std::move(x)}, std::move(new_index)};
}

std::vector<FieldArray> merged_fields(const std::vector<FieldArray>& fields, const MergedMesh& merged,
                                      std::vector<std::string>& notes) {
    std::vector<FieldArray> result;
    for (const FieldArray& field : fields) {
        result.push_back(field);
        if (field.place != FieldArray::Place::nodes) continue;
        const auto width = static_cast<std::size_t>(field.components);
        std::vector<double>& values = result.back().values;
        values.assign(static_cast<std::size_t>(merged.mesh.topology().node_count()) * width, 0.0);
        std::vector<bool> is_set(values.size() / width, false);
        Index differing = 0;
        for (std::size_t old = 0; old < merged.new_index.size(); ++old) {
            const auto node = static_cast<std::size_t>(merged.new_index[old]);
            const double* from = field.values.data() + old * width;
            double* to = values.data() + node * width;
            bool differs = false;
            for (std::size_t c = 0; c < width; ++c) {
                if (!is_set[node]) to[c] = from[c];
                differs = differs || !(to[c] == from[c] || (std::isnan(to[c]) && std::isnan(from[c])));
            }
            is_set[node] = true;
            differing += differs ? 1 : 0;
        }
        if (differing > 0)
            notes.push_back(
                fmt::format("Array {} has other values at {} of the merged nodes than at the nodes that they were "
                            "merged with; the values of the first of each were kept.",
                            field.name, differing));
    }
    return result;
}

}  // namespace curvewright
