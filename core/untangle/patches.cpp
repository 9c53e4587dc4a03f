#include "core/untangle/patches.h"

#include <algorithm>

namespace curvewright {

std::vector<FreePatch> make_patches(const MeshTopology& topology, const NodeElements& node_elements,
                                    const std::vector<Index>& seeds, int layers,
                                    const std::function<bool(Index node)>& may_move,
                                    const std::function<bool(Index element)>& is_blocked) {
    constexpr int none = -1, some = 0, blocked = -2;
    std::vector<int> patch_of(static_cast<std::size_t>(topology.element_count()), none);
    if (is_blocked)
        for (Index element = 0; element < topology.element_count(); ++element)
            if (is_blocked(element)) patch_of[element] = blocked;
    std::vector<Index> front = seeds;
    for (const Index element : seeds) patch_of[element] = some;
    for (int layer = 0; layer < layers; ++layer) {
        std::vector<Index> next;
        for (const Index element : front)
            for (const Index node : topology.element_nodes(element))
                for (const Index other : node_elements.of(node))
                    if (patch_of[other] == none) {
                        patch_of[other] = some;
                        next.push_back(other);
                    }
        front = std::move(next);
    }
    // Connected parts, numbered from 1.
    std::vector<FreePatch> patches;
    std::vector<Index> stack;
    for (Index first = 0; first < topology.element_count(); ++first) {
        if (patch_of[first] != some) continue;
        const int number = static_cast<int>(patches.size()) + 1;
        FreePatch& patch = patches.emplace_back();
        patch_of[first] = number;
        stack.assign(1, first);
        while (!stack.empty()) {
            const Index element = stack.back();
            stack.pop_back();
            patch.elements.push_back(element);
            for (const Index node : topology.element_nodes(element))
                for (const Index other : node_elements.of(node))
                    if (patch_of[other] == some) {
                        patch_of[other] = number;
                        stack.push_back(other);
                    }
        }
        std::sort(patch.elements.begin(), patch.elements.end());
        for (const Index element : patch.elements)
            for (const Index node : topology.element_nodes(element)) {
                const auto around = node_elements.of(node);
                if (may_move(node) &&
                    std::all_of(around.begin(), around.end(), [&](Index e) { return patch_of[e] == number; }))
                    patch.nodes.push_back(node);
            }
        std::sort(patch.nodes.begin(), patch.nodes.end());
        patch.nodes.erase(std::unique(patch.nodes.begin(), patch.nodes.end()), patch.nodes.end());
    }
    std::erase_if(patches, [](const FreePatch& patch) { return patch.nodes.empty(); });
    return patches;
}

}  // namespace curvewright
