#include <algorithm>
#include <cstdlib>
#include <iterator>
#include <set>

#include <fmt/format.h>

#include "core/base/error.h"
#include "core/basis/node_ordering.h"
#include "core/io/mesh_entities.h"
#include "core/io/msh_io.h"
#include "core/io/msh_links.h"
#include "core/io/msh_types.h"

namespace curvewright {
namespace {

/// Text that grows; numbers are written in the shortest form that reads back as the same number (at most 17 digits).
class Text {
  public:
    template <class... Arguments>
    void add(fmt::format_string<Arguments...> format, Arguments&&... arguments) {
        fmt::format_to(std::back_inserter(buffer_), format, std::forward<Arguments>(arguments)...);
    }
    std::string str() const { return fmt::to_string(buffer_); }

  private:
    fmt::memory_buffer buffer_;
};

/// Highest tag that entities, cells and nodes of each dimension use.
std::array<int, 4> highest_entity_tags(const MeshData& data) {
    std::array<int, 4> highest{};
    for (const Entity& entity : data.entities)
        highest[entity.dimension] = std::max(highest[entity.dimension], entity.tag);
    for (const ElementBlock& block : data.blocks) {
        int& tag = highest[dimension(block.type.shape)];
        tag = std::max(tag, block.entity_tag);
    }
    for (const NodeEntity& entity : data.node_entities)
        if (entity.dimension >= 0) highest[entity.dimension] = std::max(highest[entity.dimension], entity.tag);
    return highest;
}

/// Puts the cells that lie on no entity on a new one of their dimension: MSH has no cells without entity.
void place_cells(MeshData& data) {
    auto highest = highest_entity_tags(data);
    std::array<int, 4> invented{};
    for (ElementBlock& block : data.blocks) {
        if (block.entity_tag != 0 || block.size() == 0) continue;
        const int dim = dimension(block.type.shape);
        if (invented[dim] == 0) invented[dim] = ++highest[dim];
        block.entity_tag = invented[dim];
    }
}

/// Puts the nodes that lie on no entity on that of the lowest-dimensional cell that holds them; nodes of no cell on the
/// first entity of the highest dimension.
void place_nodes(MeshData& data) {
    data.node_entities.resize(data.node_tags.size());
    std::vector<NodeEntity> found(data.node_tags.size());
    NodeEntity fallback{0, 1};
    for (int dim = 0; dim < 4; ++dim) {
        const auto entity = std::find_if(data.entities.begin(), data.entities.end(),
                                         [&](const Entity& candidate) { return candidate.dimension == dim; });
        if (entity != data.entities.end()) fallback = {dim, entity->tag};
        for (const ElementBlock& block : data.blocks) {
            if (dimension(block.type.shape) != dim) continue;
            for (const Index node : block.nodes)
                if (found[node].dimension < 0) found[node] = {dim, block.entity_tag};
        }
    }
    for (std::size_t node = 0; node < found.size(); ++node) {
        NodeEntity& entity = data.node_entities[node];
        if (entity.dimension < 0 || entity.tag == 0) entity = found[node].dimension >= 0 ? found[node] : fallback;
    }
}

/// Gives the entities of periodic links a place: Gmsh reads no link of an entity that the file does not have, and
/// MSH 2.2 has only those with elements.
void place_periodic_entities(MeshData& data, const Coordinates& coordinates) {
    std::set<EntityKey> known;
    for (const Entity& entity : data.entities) known.emplace(entity.dimension, entity.tag);
    for (const PeriodicLink& link : data.periodic)
        for (const bool is_master : {false, true}) {
            const int tag = is_master ? link.master_tag : link.tag;
            if (tag <= 0 || !known.emplace(link.dimension, tag).second) continue;
            GrowingBox box;
            for (const auto& [node, master] : link.nodes) box.add(coordinates, is_master ? master : node);
            data.entities.push_back({link.dimension, tag, {}, {}, {}});
            if (!box.is_empty()) data.entities.back().bounding_box = box.bounds;
        }
}

void check_types(const MeshData& data) {
    for (const ElementBlock& block : data.blocks)
        if (block.size() > 0 && !msh_type_of(block.type))
            throw Unsupported(
                fmt::format("MSH has no {}: the mesh cannot be written in this format.", name(block.type)));
}

void add_physical_names(Text& text, const MeshData& data) {
    std::vector<const PhysicalGroup*> named;
    for (const PhysicalGroup& group : data.groups) {
        if (group.name.find_first_of("\"\r\n") != group.name.npos)
            throw Unsupported(
                fmt::format("MSH cannot hold the name of physical group {} of dimension {}: it has a "
                            "quotation mark or a line break in it.",
                            group.tag, group.dimension));
        if (!group.name.empty()) named.push_back(&group);
    }
    if (named.empty()) return;
    text.add("$PhysicalNames\n{}\n", named.size());
    for (const PhysicalGroup* group : named) text.add("{} {} \"{}\"\n", group->dimension, group->tag, group->name);
    text.add("$EndPhysicalNames\n");
}

void add_entity(Text& text, const Entity& entity, const std::set<EntityKey>& known) {
    const int dim = entity.dimension;
    text.add("{}", entity.tag);
    if (entity.is_partition()) {
        text.add(" {} {} {}", entity.parent_dimension, entity.parent_tag, entity.partitions.size());
        for (const int partition : entity.partitions) text.add(" {}", partition);
    }
    for (int d = 0; d < (dim == 0 ? 3 : 6); ++d) text.add(" {}", entity.bounding_box[d]);
    text.add(" {}", entity.physical_tags.size());
    for (const int tag : entity.physical_tags) text.add(" {}", tag);
    if (dim > 0) {
        std::vector<int> bounding;
        for (const int tag : entity.bounding_entities)
            if (known.contains({dim - 1, tag}) || known.contains({dim - 1, -tag})) bounding.push_back(tag);
        text.add(" {}", bounding.size());
        for (const int tag : bounding) text.add(" {}", tag);
    }
    text.add("\n");
}

/// $Entities, and $PartitionedEntities where the mesh has parts of entities.
void add_entities(Text& text, const MeshData& data) {
    std::set<EntityKey> known;
    for (const Entity& entity : data.entities) known.emplace(entity.dimension, entity.tag);
    const bool is_partitioned = data.partitioning.count > 0 || !data.partitioning.ghost_entities.empty() ||
                                std::any_of(data.entities.begin(), data.entities.end(),
                                            [](const Entity& entity) { return entity.is_partition(); });
    for (const bool are_parts : {false, true}) {
        if (are_parts && !is_partitioned) return;
        const char* section = are_parts ? "PartitionedEntities" : "Entities";
        std::array<std::size_t, 4> counts{};
        for (const Entity& entity : data.entities) counts[entity.dimension] += entity.is_partition() == are_parts;
        text.add("${}\n", section);
        if (are_parts) text.add("{}", partition_head_text(data.partitioning));
        text.add("{} {} {} {}\n", counts[0], counts[1], counts[2], counts[3]);
        for (int dim = 0; dim < 4; ++dim)
            for (const Entity& entity : data.entities)
                if (entity.dimension == dim && entity.is_partition() == are_parts) add_entity(text, entity, known);
        text.add("$End{}\n", section);
    }
}

/// The nodes in runs of the same entity, so that their order stays.
void add_node_blocks(Text& text, const MeshData& data, const Coordinates& coordinates) {
    std::vector<std::size_t> starts;
    for (std::size_t node = 0; node < data.node_tags.size(); ++node)
        if (node == 0 || data.node_entities[node] != data.node_entities[node - 1]) starts.push_back(node);
    const auto [lowest, highest] = std::minmax_element(data.node_tags.begin(), data.node_tags.end());
    const bool is_empty = data.node_tags.empty();
    text.add("$Nodes\n{} {} {} {}\n", starts.size(), data.node_tags.size(), is_empty ? 0 : lowest->value,
             is_empty ? 0 : highest->value);
    for (std::size_t run = 0; run < starts.size(); ++run) {
        const std::size_t begin = starts[run];
        const std::size_t end = run + 1 < starts.size() ? starts[run + 1] : data.node_tags.size();
        const NodeEntity& entity = data.node_entities[begin];
        text.add("{} {} 0 {}\n", entity.dimension, entity.tag, end - begin);
        for (std::size_t node = begin; node < end; ++node) text.add("{}\n", data.node_tags[node].value);
        for (std::size_t node = begin; node < end; ++node) {
            const auto x = coordinates.row(static_cast<Index>(node));
            text.add("{} {} {}\n", x(0), x(1), x(2));
        }
    }
    text.add("$EndNodes\n");
}

/// The node tags of one element in Gmsh's order, each behind a blank.
void add_element_nodes(Text& text, const MeshData& data, const ElementBlock& block, std::size_t element,
                       std::vector<std::int64_t>& in_gmsh_order) {
    const auto& permutation = gmsh_permutation(block.type);
    in_gmsh_order.resize(permutation.size());
    for (std::size_t i = 0; i < permutation.size(); ++i)
        in_gmsh_order[static_cast<std::size_t>(permutation[i])] =
            data.node_tags[block.nodes[element * permutation.size() + i]].value;
    for (const std::int64_t tag : in_gmsh_order) text.add(" {}", tag);
    text.add("\n");
}

void add_element_blocks(Text& text, const MeshData& data) {
    std::size_t blocks = 0, elements = 0;
    ElementTag lowest, highest;
    for (const ElementBlock& block : data.blocks) {
        if (block.size() == 0) continue;
        const auto [low, high] = std::minmax_element(block.tags.begin(), block.tags.end());
        lowest = blocks == 0 ? *low : std::min(lowest, *low);
        highest = blocks == 0 ? *high : std::max(highest, *high);
        elements += block.tags.size();
        ++blocks;
    }
    text.add("$Elements\n{} {} {} {}\n", blocks, elements, lowest.value, highest.value);
    std::vector<std::int64_t> scratch;
    for (const ElementBlock& block : data.blocks) {
        if (block.size() == 0) continue;
        text.add("{} {} {} {}\n", dimension(block.type.shape), block.entity_tag, *msh_type_of(block.type),
                 block.tags.size());
        for (std::size_t i = 0; i < block.tags.size(); ++i) {
            text.add("{}", block.tags[i].value);
            add_element_nodes(text, data, block, i, scratch);
        }
    }
    text.add("$EndElements\n");
}

void add_format(Text& text, const char* version, const Provenance* provenance) {
    text.add("$MeshFormat\n{} 0 8\n$EndMeshFormat\n", version);
    if (provenance != nullptr) text.add("$Comments\n{}$EndComments\n", provenance_text(*provenance));
}

/// The mesh's data with every cell on an entity, and every entity and group complete.
MeshData prepared(const CurvedMesh& mesh, bool with_nodes) {
    MeshData data = mesh.topology().data();
    check_types(data);
    place_cells(data);
    complete_entities(data, mesh.coordinates());
    if (with_nodes) {
        place_periodic_entities(data, mesh.coordinates());
        if (!data.partitioning.element_partitions.empty()) {
            make_partition_entities(data);
            complete_entities(data, mesh.coordinates());
        }
        place_nodes(data);
        complete_entities(data, mesh.coordinates());
    }
    complete_groups(data);
    return data;
}

}  // namespace

std::string msh4_text(const CurvedMesh& mesh, const Provenance* provenance) {
    const MeshData data = prepared(mesh, true);
    Text text;
    add_format(text, "4.1", provenance);
    add_physical_names(text, data);
    add_entities(text, data);
    add_node_blocks(text, data, mesh.coordinates());
    add_element_blocks(text, data);
    text.add("{}", periodic_text(data, true));
    text.add("{}", ghost_elements_text(data.partitioning));
    return text.str();
}

std::string msh2_text(const CurvedMesh& mesh, const Provenance* provenance) {
    const MeshData data = prepared(mesh, false);
    std::map<EntityKey, std::vector<int>> physicals_on;
    for (const Entity& entity : data.entities) {
        auto& tags = physicals_on[{entity.dimension, entity.tag}];
        tags = entity.physical_tags;
        if (tags.empty()) tags.push_back(0);
    }
    Text text;
    add_format(text, "2.2", provenance);
    add_physical_names(text, data);
    text.add("$Nodes\n{}\n", data.node_tags.size());
    for (Index node = 0; node < mesh.topology().node_count(); ++node) {
        const auto x = mesh.coordinates().row(node);
        text.add("{} {} {} {}\n", data.node_tags[node].value, x(0), x(1), x(2));
    }
    std::size_t lines = 0;
    for (const ElementBlock& block : data.blocks)
        if (block.size() > 0)
            lines += block.tags.size() * physicals_on.at({dimension(block.type.shape), block.entity_tag}).size();
    text.add("$EndNodes\n$Elements\n{}\n", lines);
    const PartitionsByElement parts(data);
    std::vector<std::int64_t> scratch;
    for (const ElementBlock& block : data.blocks) {
        if (block.size() == 0) continue;
        const auto& physicals = physicals_on.at({dimension(block.type.shape), block.entity_tag});
        const int elementary = parts.elementary(block);
        for (std::size_t i = 0; i < block.tags.size(); ++i) {
            const std::string partitions = parts.text(block, i);
            const auto tags = 2 + std::count(partitions.begin(), partitions.end(), ' ');
            for (const int physical : physicals) {
                text.add("{} {} {} {} {}{}", block.tags[i].value, *msh_type_of(block.type), tags, physical, elementary,
                         partitions);
                add_element_nodes(text, data, block, i, scratch);
            }
        }
    }
    text.add("$EndElements\n{}", periodic_text(data, false));
    return text.str();
}

}  // namespace curvewright
