#include "core/untangle/patch_state.h"

#include <algorithm>
#include <map>

#include "core/quality/shape_quality.h"

namespace curvewright {

Coordinates positions_of(const std::vector<Index>& nodes, const Coordinates& x) {
    Coordinates result(static_cast<Eigen::Index>(nodes.size()), 3);
    for (std::size_t i = 0; i < nodes.size(); ++i) result.row(static_cast<Eigen::Index>(i)) = x.row(nodes[i]);
    return result;
}

std::vector<Foot> feet_of(const std::vector<Index>& nodes, const std::vector<Foot>& feet) {
    std::vector<Foot> result;
    if (feet.empty()) return result;
    for (const Index node : nodes)
        if (feet[node].piece >= 0) result.push_back(feet[node]);
    return result;
}

namespace {

std::vector<ElementQuality> qualities_of(const std::vector<Index>& elements, const MeshState& state) {
    std::vector<ElementQuality> result;
    for (const Index element : elements) result.push_back(state.qualities[element]);
    return result;
}

}  // namespace

BestOfPatch::BestOfPatch(const FreePatch& patch, const MeshState& state)
    : patch_(&patch),
      qualities_(qualities_of(patch.elements, state)),
      standing_(qualities_),
      positions_(positions_of(patch.nodes, state.coordinates)),
      feet_(feet_of(patch.nodes, state.feet)) {}

bool BestOfPatch::offer(const Coordinates& x, const std::vector<Foot>& feet, std::vector<ElementQuality> qualities) {
    if (!Standing(qualities).is_better_than(standing_)) return false;
    take(x, feet, std::move(qualities));
    return true;
}

void BestOfPatch::take(const Coordinates& x, const std::vector<Foot>& feet, std::vector<ElementQuality> qualities) {
    standing_ = Standing(qualities);
    qualities_ = std::move(qualities);
    positions_ = positions_of(patch_->nodes, x);
    feet_ = feet;
}

void BestOfPatch::restore(MeshState& state) const {
    std::size_t next_foot = 0;
    for (std::size_t i = 0; i < patch_->nodes.size(); ++i) {
        const Index node = patch_->nodes[i];
        state.coordinates.row(node) = positions_.row(static_cast<Eigen::Index>(i));
        if (!state.feet.empty() && state.feet[node].piece >= 0) state.feet[node] = feet_[next_foot++];
    }
    for (std::size_t i = 0; i < patch_->elements.size(); ++i) state.qualities[patch_->elements[i]] = qualities_[i];
}

namespace {

/// Some elements as a mesh of their own; nodes receives the numbers its nodes have in the whole mesh.
CurvedMesh part_of_mesh(const MeshTopology& topology, const std::vector<Index>& elements, const Coordinates& x,
                        std::vector<Index>& nodes) {
    MeshData data;
    std::map<Index, Index> own;
    std::map<ElementType, ElementBlock> blocks;
    for (const Index element : elements) {
        ElementBlock& block = blocks[topology.element_type(element)];
        block.type = topology.element_type(element);
        block.tags.push_back(topology.element_tag(element));
        for (const Index node : topology.element_nodes(element)) {
            const auto [entry, is_new] = own.try_emplace(node, static_cast<Index>(nodes.size()));
            if (is_new) {
                nodes.push_back(node);
                data.node_tags.push_back(topology.node_tag(node));
            }
            block.nodes.push_back(entry->second);
        }
    }
    for (auto& [type, block] : blocks) data.blocks.push_back(std::move(block));
    return CurvedMesh(std::make_shared<const MeshTopology>(std::move(data)), positions_of(nodes, x));
}

}  // namespace

PatchShape::PatchShape(const MeshTopology& topology, const std::vector<Index>& elements, const Coordinates& ideal)
    : ideal_(part_of_mesh(topology, elements, ideal, nodes_)) {}

double PatchShape::worst(const Coordinates& x) const {
    return assess_shape(ideal_.with_coordinates(positions_of(nodes_, x)), ideal_.coordinates()).min;
}

}  // namespace curvewright
