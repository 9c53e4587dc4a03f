#include "core/warp/neighbours.h"

#include <algorithm>

#include "core/base/parallel.h"

namespace curvewright {

NeighbourSets find_neighbours(const MeshTopology& topology, std::vector<Index> centers, const TaskContext& context) {
    // Elements of each node, compressed by rows.
    std::vector<std::size_t> first(static_cast<std::size_t>(topology.node_count()) + 1, 0);
    for (Index element = 0; element < topology.element_count(); ++element)
        for (Index node : topology.element_nodes(element)) ++first[node + 1];
    for (std::size_t i = 1; i < first.size(); ++i) first[i] += first[i - 1];
    std::vector<Index> elements(first.back());
    std::vector<std::size_t> next(first.begin(), first.end() - 1);
    for (Index element = 0; element < topology.element_count(); ++element)
        for (Index node : topology.element_nodes(element)) elements[next[node]++] = element;

    NeighbourSets sets;
    sets.centers = std::move(centers);
    const auto& nodes = sets.centers;
    constexpr std::size_t grain = 512;
    std::vector<std::vector<Index>> piece_nodes((nodes.size() + grain - 1) / grain);
    sets.offsets.assign(nodes.size() + 1, 0);
    parallel_for(nodes.size(), grain, context, "Finding neighbours", [&](std::size_t begin, std::size_t end) {
        std::vector<Index>& out = piece_nodes[begin / grain];
        std::vector<Index> set;
        for (std::size_t i = begin; i < end; ++i) {
            set.clear();
            for (std::size_t k = first[nodes[i]]; k < first[nodes[i] + 1]; ++k)
                for (Index node : topology.element_nodes(elements[k]))
                    if (node != nodes[i]) set.push_back(node);
            std::sort(set.begin(), set.end());
            set.erase(std::unique(set.begin(), set.end()), set.end());
            sets.offsets[i + 1] = set.size();
            out.insert(out.end(), set.begin(), set.end());
        }
    });
    for (std::size_t i = 1; i < sets.offsets.size(); ++i) sets.offsets[i] += sets.offsets[i - 1];
    sets.nodes.reserve(sets.offsets.back());
    for (const auto& piece : piece_nodes) sets.nodes.insert(sets.nodes.end(), piece.begin(), piece.end());
    return sets;
}

}  // namespace curvewright
