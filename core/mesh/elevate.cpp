#include "core/mesh/elevate.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include <fmt/format.h>

#include "core/base/error.h"
#include "core/basis/lagrange.h"
#include "core/basis/reference_element.h"

namespace curvewright {
namespace {

/// Identity of a new node: the corners (positions in the old mesh, ascending) with a non-zero multilinear weight, and
/// those weights as integers (weight × order^dimension). Neighbours compute the same key for the same node.
using NodeKey = std::vector<std::pair<Index, long>>;

/// Integer multilinear weights of the corners at every lattice point: nodes × corners, scaled by order^dimension.
Eigen::MatrixXd corner_weights(ElementType type) {
    if (type.shape == Shape::vertex) return Eigen::MatrixXd::Ones(1, 1);
    return lagrange_basis({type.shape, 1}, reference_nodes(type)).values;
}

}  // namespace

CurvedMesh elevate(const CurvedMesh& mesh, int order, const TaskContext& context) {
    if (order < 1 || order > max_order)
        throw Unsupported(fmt::format("Order {} is not supported; orders 1 to {} are.", order, max_order));
    const MeshTopology& old = mesh.topology();
    MeshData data;
    data.entities = old.entities();
    data.groups = old.groups();

    // Old nodes that stay: corners of cells, and nodes of no cell.
    std::vector<bool> in_cell(static_cast<std::size_t>(old.node_count()), false), is_corner = in_cell;
    for (const ElementBlock& block : old.blocks()) {
        const int per_cell = node_count(block.type), corners = corner_count(block.type.shape);
        for (std::size_t i = 0; i < block.nodes.size(); ++i) {
            in_cell[block.nodes[i]] = true;
            if (static_cast<int>(i % per_cell) < corners) is_corner[block.nodes[i]] = true;
        }
    }
    const bool has_entities = !old.data().node_entities.empty();
    std::vector<Index> new_index(static_cast<std::size_t>(old.node_count()), -1);
    std::vector<Eigen::RowVector3d> positions;
    std::int64_t next_tag = 0;
    for (Index node = 0; node < old.node_count(); ++node) {
        if (in_cell[node] && !is_corner[node]) continue;
        new_index[node] = static_cast<Index>(data.node_tags.size());
        data.node_tags.push_back(old.node_tag(node));
        if (has_entities) data.node_entities.push_back(old.data().node_entities[node]);
        positions.emplace_back(mesh.coordinates().row(node));
        next_tag = std::max(next_tag, old.node_tag(node).value);
    }

    // Cells of low dimension first, so that a new node is classified on the lowest entity it lies on.
    std::vector<std::size_t> by_dimension(old.blocks().size());
    for (std::size_t b = 0; b < by_dimension.size(); ++b) by_dimension[b] = b;
    std::stable_sort(by_dimension.begin(), by_dimension.end(), [&](std::size_t a, std::size_t b) {
        return dimension(old.blocks()[a].type.shape) < dimension(old.blocks()[b].type.shape);
    });
    data.blocks.resize(old.blocks().size());
    std::map<NodeKey, Index> created;
    for (std::size_t b : by_dimension) {
        const ElementBlock& source = old.blocks()[b];
        ElementBlock& target = data.blocks[b];
        const Shape shape = source.type.shape;
        target.type = {shape, shape == Shape::vertex ? 1 : order};
        target.entity_tag = source.entity_tag;
        target.tags = source.tags;
        if (shape == Shape::pyramid && order > 1) throw Unsupported("Pyramids cannot be raised above order 1.");
        const int corners = corner_count(shape), old_count = node_count(source.type);
        const Eigen::MatrixXd weights =
            shape == Shape::pyramid ? Eigen::MatrixXd(Eigen::MatrixXd::Identity(5, 5)) : corner_weights(target.type);
        double scale = 1.0;
        for (int d = 0; d < dimension(shape); ++d) scale *= order;
        NodeKey key;
        for (Index cell = 0; cell < source.size(); ++cell) {
            if (cell % 1024 == 0) context.report("Raising the order", static_cast<double>(cell) / source.size());
            const Index* old_nodes = source.nodes.data() + static_cast<std::size_t>(cell) * old_count;
            for (Eigen::Index i = 0; i < weights.rows(); ++i) {
                key.clear();
                Eigen::RowVector3d position = Eigen::RowVector3d::Zero();
                long divisor = 0;
                for (int c = 0; c < corners; ++c) {
                    const long weight = std::lround(weights(i, c) * scale);
                    if (weight == 0) continue;
                    key.emplace_back(old_nodes[c], weight);
                }
                std::sort(key.begin(), key.end());
                if (key.size() == 1) {
                    target.nodes.push_back(new_index[key.front().first]);
                    continue;
                }
                // The scale differs between dimensions (an edge's node seen from a face): reduce to lowest terms.
                for (const auto& [corner, weight] : key) divisor = std::gcd(divisor, weight);
                for (auto& [corner, weight] : key) weight /= divisor;
                auto [entry, is_new] = created.try_emplace(key, static_cast<Index>(data.node_tags.size()));
                if (is_new) {
                    double total = 0.0;
                    for (const auto& [corner, weight] : key) total += static_cast<double>(weight);
                    for (const auto& [corner, weight] : key)
                        position += static_cast<double>(weight) / total * mesh.coordinates().row(corner);
                    positions.push_back(position);
                    data.node_tags.push_back({++next_tag});
                    if (has_entities) data.node_entities.push_back({dimension(shape), source.entity_tag});
                }
                target.nodes.push_back(entry->second);
            }
        }
    }

    data.periodic = periodic_of_new_order(old, data);
    data.partitioning = old.data().partitioning;
    Coordinates coordinates(static_cast<Eigen::Index>(positions.size()), 3);
    for (std::size_t i = 0; i < positions.size(); ++i) coordinates.row(static_cast<Eigen::Index>(i)) = positions[i];
    return {std::make_shared<const MeshTopology>(std::move(data)), std::move(coordinates)};
}

}  // namespace curvewright
