#pragma once

#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <memory>
#include <string>
#include <utility>

#include "core/base/error.h"
#include "core/mesh/curved_mesh.h"

namespace curvewright {

/// Dimension and tag: what names an entity in a file.
using EntityKey = std::pair<int, int>;

/// A box (min x, y, z, max x, y, z) that grows with the points put into it.
struct GrowingBox {
    static constexpr double infinity = std::numeric_limits<double>::infinity();
    std::array<double, 6> bounds = {infinity, infinity, infinity, -infinity, -infinity, -infinity};

    bool is_empty() const { return bounds[0] > bounds[3]; }
    void add(const Coordinates& coordinates, Index node) {
        for (int d = 0; d < 3; ++d) {
            bounds[d] = std::min(bounds[d], coordinates(node, d));
            bounds[d + 3] = std::max(bounds[d + 3], coordinates(node, d));
        }
    }
    bool is_inside(const std::array<double, 6>& other) const {
        double slack = 0.0;
        for (int d = 0; d < 3; ++d) slack = std::max(slack, 1e-6 * (other[d + 3] - other[d]));
        for (int d = 0; d < 3; ++d)
            if (bounds[d] < other[d] - slack || bounds[d + 3] > other[d + 3] + slack) return false;
        return true;
    }
};

/// Gives every entity that blocks or nodes refer to (tag 0 = none) a place in data.entities, with the box of its cells'
/// nodes. Entities that are already there keep theirs unless nodes have left it (a deformation moved them). Sorts them
/// by dimension, as MSH has them.
inline void complete_entities(MeshData& data, const Coordinates& coordinates) {
    std::map<EntityKey, GrowingBox> boxes;
    for (const ElementBlock& block : data.blocks) {
        if (block.entity_tag == 0) continue;
        GrowingBox& box = boxes[{dimension(block.type.shape), block.entity_tag}];
        for (const Index node : block.nodes) box.add(coordinates, node);
    }
    for (std::size_t node = 0; node < data.node_entities.size(); ++node)
        if (const NodeEntity& on = data.node_entities[node]; on.dimension >= 0 && on.tag != 0)
            boxes[{on.dimension, on.tag}].add(coordinates, static_cast<Index>(node));
    for (Entity& entity : data.entities) {
        const auto found = boxes.find({entity.dimension, entity.tag});
        if (found == boxes.end()) continue;
        if (!found->second.is_empty() && !found->second.is_inside(entity.bounding_box))
            entity.bounding_box = found->second.bounds;
        boxes.erase(found);
    }
    for (const auto& [key, box] : boxes)
        data.entities.push_back({key.first, key.second, {}, box.is_empty() ? std::array<double, 6>{} : box.bounds, {}});
    std::stable_sort(data.entities.begin(), data.entities.end(),
                     [](const Entity& a, const Entity& b) { return a.dimension < b.dimension; });
}

/// Gives every physical tag that entities mention a group (without a name, if there is none yet) and sorts the groups
/// by dimension and tag.
inline void complete_groups(MeshData& data) {
    std::map<EntityKey, std::string> groups;
    for (const PhysicalGroup& group : data.groups) groups.try_emplace({group.dimension, group.tag}, group.name);
    for (const Entity& entity : data.entities)
        for (const int tag : entity.physical_tags) groups.try_emplace({entity.dimension, tag});
    data.groups.clear();
    for (const auto& [key, name] : groups) data.groups.push_back({key.first, key.second, name});
}

/// Puts an element behind the last block if it is of the same type and entity, else into a block of its own.
inline ElementBlock& block_for(std::vector<ElementBlock>& blocks, ElementType type, int entity_tag) {
    if (blocks.empty() || blocks.back().type != type || blocks.back().entity_tag != entity_tag)
        blocks.push_back({type, entity_tag, {}, {}});
    return blocks.back();
}

/// Builds the mesh; what its constructors complain of is told with the file's name.
inline CurvedMesh assemble_mesh(MeshData data, Coordinates coordinates, const std::string& file) {
    try {
        return {std::make_shared<MeshTopology>(std::move(data)), std::move(coordinates)};
    } catch (const InvalidInput& error) {
        throw InvalidInput(file, 0, error.what());
    } catch (const Unsupported& error) {
        throw Unsupported(file + ": " + error.what());
    }
}

}  // namespace curvewright
