#include "core/warp/neighbours.h"

#include <algorithm>
#include <cstdlib>
#include <limits>
#include <map>

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/basis/reference_element.h"
#include "core/mesh/node_elements.h"

namespace curvewright {
namespace {

/// Per node of an element: which nodes of the element are its neighbours.
using LocalNeighbours = std::vector<std::vector<int>>;

bool is_one_step(Shape shape, const LatticePoint& a, const LatticePoint& b) {
    int distance = 0, sum = 0, flat_distance = 0, flat_sum = 0;
    for (std::size_t d = 0; d < 3; ++d) {
        const int step = b[d] - a[d];
        if (std::abs(step) > 1) return false;
        distance += std::abs(step);
        sum += step;
        if (d == 1) {
            flat_distance = distance;
            flat_sum = sum;
        }
    }
    // On a simplex a step takes one from one barycentric coordinate and gives it to another.
    if (is_simplex(shape)) return distance == 1 || (distance == 2 && sum == 0);
    if (shape == Shape::prism) return distance == 1 || (distance == 2 && flat_distance == 2 && flat_sum == 0);
    if (shape == Shape::pyramid) return true;  // no lattice of products: all nodes
    return distance == 1;
}

LocalNeighbours local_neighbours(ElementType type, NeighbourKind kind) {
    const ReferenceElement& reference = reference_element(type);
    const auto count = static_cast<std::size_t>(reference.node_count());
    LocalNeighbours result(count);
    for (std::size_t i = 0; i < count; ++i)
        for (std::size_t j = 0; j < count; ++j) {
            if (i == j) continue;
            const bool is_corner = static_cast<int>(j) < corner_count(type.shape);
            const bool counts = kind == NeighbourKind::high_order ? !is_corner
                                : kind == NeighbourKind::edge_connected
                                    ? is_one_step(type.shape, reference.lattice[i], reference.lattice[j])
                                    : true;
            if (counts) result[i].push_back(static_cast<int>(j));
        }
    return result;
}

}  // namespace

NeighbourSets find_neighbours(const MeshTopology& topology, std::vector<Index> centers, NeighbourKind kind,
                              const TaskContext& context) {
    if (kind == NeighbourKind::high_order && topology.order() < 2)
        throw Unsupported("High-order neighbours need a mesh of order 2 or more.");
    context.report("Finding neighbours", 0.0);
    const NodeElements node_elements = elements_of_nodes(topology);
    std::map<ElementType, LocalNeighbours> tables;
    if (kind != NeighbourKind::all)
        for (const ElementBlock& block : topology.blocks())
            if (!tables.contains(block.type)) tables[block.type] = local_neighbours(block.type, kind);

    NeighbourSets sets;
    sets.centers = std::move(centers);
    const auto& nodes = sets.centers;
    // Few pieces, because each marks the nodes that it has seen in an array of its own.
    const std::size_t grain = std::max<std::size_t>(512, nodes.size() / 48 + 1);
    struct Piece {
        std::vector<Index> nodes;
        std::vector<std::uint16_t> shared;
    };
    std::vector<Piece> pieces((nodes.size() + grain - 1) / grain);
    sets.offsets.assign(nodes.size() + 1, 0);
    parallel_for(nodes.size(), grain, context, "Finding neighbours", [&](std::size_t begin, std::size_t end) {
        Piece& out = pieces[begin / grain];
        std::vector<Index> seen_by(static_cast<std::size_t>(topology.node_count()), -1);
        std::vector<std::size_t> place(seen_by.size());
        for (std::size_t i = begin; i < end; ++i) {
            if (i % 1024 == 0) context.check();
            const std::size_t first = out.nodes.size();
            const Index center = nodes[i];
            const auto add = [&](Index node) {
                if (node == center) return;
                if (seen_by[node] == center) {
                    std::uint16_t& shared = out.shared[place[node]];
                    if (shared < std::numeric_limits<std::uint16_t>::max()) ++shared;
                    return;
                }
                seen_by[node] = center;
                place[node] = out.nodes.size();
                out.nodes.push_back(node);
                out.shared.push_back(1);
            };
            for (const Index element : node_elements.of(center)) {
                const auto element_nodes = topology.element_nodes(element);
                if (kind == NeighbourKind::all) {
                    for (const Index node : element_nodes) add(node);
                    continue;
                }
                const auto local = std::find(element_nodes.begin(), element_nodes.end(), center);
                for (const int j :
                     tables.at(topology.element_type(element))[static_cast<std::size_t>(local - element_nodes.begin())])
                    add(element_nodes[static_cast<std::size_t>(j)]);
            }
            sets.offsets[i + 1] = out.nodes.size() - first;
        }
    });
    for (std::size_t i = 1; i < sets.offsets.size(); ++i) sets.offsets[i] += sets.offsets[i - 1];
    sets.nodes.resize(sets.offsets.back());
    sets.shared_elements.resize(sets.offsets.back());
    parallel_for(pieces.size(), 1, context, {}, [&](std::size_t begin, std::size_t end) {
        for (std::size_t piece = begin; piece < end; ++piece) {
            const auto target = static_cast<std::ptrdiff_t>(sets.offsets[piece * grain]);
            std::copy(pieces[piece].nodes.begin(), pieces[piece].nodes.end(), sets.nodes.begin() + target);
            std::copy(pieces[piece].shared.begin(), pieces[piece].shared.end(), sets.shared_elements.begin() + target);
            pieces[piece] = {};
        }
    });
    return sets;
}

}  // namespace curvewright
