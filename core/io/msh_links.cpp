#include "core/io/msh_links.h"

#include <algorithm>
#include <iterator>
#include <limits>
#include <map>
#include <set>

#include <fmt/format.h>

#include "core/io/mesh_entities.h"

namespace curvewright {
namespace {

std::array<double, 16> read_map(MshScanner& in) {
    std::array<double, 16> map{};
    for (double& value : map) value = in.real("a number of an affine map");
    return map;
}

/// A number of a partition that can be written with a sign.
int read_partition(MshScanner& in, std::string_view what) {
    const int partition = in.integer<int>(what);
    if (partition == std::numeric_limits<int>::min()) in.fail(fmt::format("{} is out of range.", partition));
    return partition;
}

template <class... Arguments>
void add(std::string& text, fmt::format_string<Arguments...> format, Arguments&&... arguments) {
    fmt::format_to(std::back_inserter(text), format, std::forward<Arguments>(arguments)...);
}

}  // namespace

// ---------------------------------------------------------------------------------------------------- reading

void MshPeriodic::read(MshScanner& in, double version, const TaskContext& context) {
    const std::size_t count = in.count("periodic entities", 8);
    for (std::size_t i = 0; i < count; ++i) {
        Section section;
        PeriodicLink& link = section.link;
        link.dimension = in.integer<int>("the dimension of a periodic entity");
        if (link.dimension < 0 || link.dimension > 3)
            in.fail(fmt::format("a periodic entity has dimension {}; 0 to 3 were expected.", link.dimension));
        link.tag = in.integer<int>("the tag of a periodic entity");
        link.master_tag = in.integer<int>("the tag of the entity that a periodic one is a copy of");
        if (version > 4.0) {
            const std::size_t numbers = in.count("numbers of an affine map");
            if (numbers != 0 && numbers != 16)
                in.fail(fmt::format("an affine map has {} numbers; 16 or none were expected.", numbers));
            if (numbers == 16) link.affine = read_map(in);
        } else if (in.peek() == "Affine") {
            in.word("Affine");
            link.affine = read_map(in);
        }
        const std::size_t pairs = in.count("pairs of periodic nodes", 4);
        section.tags.reserve(pairs);
        for (std::size_t k = 0; k < pairs; ++k) {
            const auto node = in.integer<std::int64_t>("a periodic node");
            section.tags.emplace_back(node, in.integer<std::int64_t>("the node that a periodic one is a copy of"));
            if (k % 4096 == 0) context.check();
        }
        sections_.push_back(std::move(section));
    }
}

void MshPeriodic::attach(MeshData& data, const std::function<Index(std::int64_t)>& find,
                         std::vector<std::string>& notes) {
    std::size_t strangers = 0;
    for (Section& section : sections_) {
        for (const auto& [tag, master_tag] : section.tags) {
            const Index node = find(tag), master = find(master_tag);
            if (node < 0 || master < 0)
                ++strangers;
            else
                section.link.nodes.emplace_back(node, master);
        }
        data.periodic.push_back(std::move(section.link));
    }
    if (strangers > 0)
        notes.push_back(
            fmt::format("$Periodic pairs {} nodes that the file does not have; they were passed over.", strangers));
    sections_.clear();
}

void read_partition_head(MshScanner& in, Partitioning& partitioning) {
    partitioning.count = in.integer<int>("the number of partitions");
    if (partitioning.count < 0)
        in.fail(fmt::format("the number of partitions is {}; it cannot be negative.", partitioning.count));
    const std::size_t ghosts = in.count("ghost entities", 4);
    for (std::size_t i = 0; i < ghosts; ++i) {
        const int tag = in.integer<int>("the tag of a ghost entity");
        partitioning.ghost_entities.emplace_back(tag, in.integer<int>("the partition of a ghost entity"));
    }
}

void read_entity_parent(MshScanner& in, Entity& entity) {
    entity.parent_dimension = in.integer<int>("the dimension of the parent entity");
    entity.parent_tag = in.integer<int>("the tag of the parent entity");
    const std::size_t partitions = in.count("partitions");
    for (std::size_t i = 0; i < partitions; ++i) entity.partitions.push_back(read_partition(in, "a partition"));
}

void read_ghost_elements(MshScanner& in, Partitioning& partitioning, const TaskContext& context) {
    const std::size_t count = in.count("ghost elements", 6);
    for (std::size_t i = 0; i < count; ++i) {
        GhostElement ghost;
        ghost.tag = {in.integer<std::int64_t>("the tag of a ghost element")};
        ghost.partition = in.integer<int>("the partition of a ghost element");
        const std::size_t partitions = in.count("partitions that know a ghost element");
        for (std::size_t k = 0; k < partitions; ++k)
            ghost.ghost_partitions.push_back(read_partition(in, "a partition that knows a ghost element"));
        partitioning.ghost_elements.push_back(std::move(ghost));
        if (i % 4096 == 0) context.check();
    }
}

std::vector<int> read_element_partitions(MshScanner& in, std::size_t count) {
    std::vector<int> tags;
    for (std::size_t i = 0; i < count; ++i) tags.push_back(read_partition(in, "a tag of the element"));
    // Where the first of them is not the number of those that follow, they are something else (versions before 2.1 had
    // one partition there, without a number).
    if (tags.empty() || tags.front() < 1 || static_cast<std::size_t>(tags.front()) + 1 != tags.size()) return {};
    tags.erase(tags.begin());
    return tags;
}

// ---------------------------------------------------------------------------------------------------- between versions

void make_partition_entities(MeshData& data) {
    Partitioning& partitioning = data.partitioning;
    std::map<std::pair<int, std::int64_t>, const ElementPartitions*> told;
    for (const ElementPartitions& element : partitioning.element_partitions)
        told.emplace(std::pair(element.dimension, element.tag.value), &element);
    std::array<int, 4> highest{};
    std::map<EntityKey, std::size_t> places;
    for (std::size_t i = 0; i < data.entities.size(); ++i) {
        const Entity& entity = data.entities[i];
        places.emplace(EntityKey(entity.dimension, entity.tag), i);
        highest[entity.dimension] = std::max(highest[entity.dimension], entity.tag);
    }
    int mesh_dimension = 0;
    for (const ElementBlock& block : data.blocks)
        mesh_dimension = std::max(mesh_dimension, dimension(block.type.shape));
    std::map<std::pair<EntityKey, std::vector<int>>, int> parts;
    std::set<int> ghost_partitions;
    std::vector<ElementBlock> blocks;
    for (const ElementBlock& block : data.blocks) {
        const int dim = dimension(block.type.shape);
        const auto per_element = static_cast<std::ptrdiff_t>(node_count(block.type));
        for (std::size_t i = 0; i < block.tags.size(); ++i) {
            int entity_tag = block.entity_tag;
            const auto found = told.find({dim, block.tags[i].value});
            std::vector<int> own, ghosts;
            if (found != told.end())
                for (const int partition : found->second->partitions)
                    (partition > 0 ? own : ghosts).push_back(std::abs(partition));
            if (!own.empty()) {
                const EntityKey parent(dim, block.entity_tag);
                const auto [part, is_new] = parts.try_emplace({parent, own}, 0);
                if (is_new) {
                    part->second = ++highest[dim];
                    const Entity& whole = data.entities[places.at(parent)];
                    data.entities.push_back({dim, part->second, whole.physical_tags, {}, {}, own, dim, parent.second});
                    places.emplace(EntityKey(dim, part->second), data.entities.size() - 1);
                }
                entity_tag = part->second;
                partitioning.count = std::max(partitioning.count, *std::max_element(own.begin(), own.end()));
                if (!ghosts.empty() && dim == mesh_dimension) {
                    partitioning.ghost_elements.push_back({block.tags[i], own.front(), ghosts});
                    ghost_partitions.insert(ghosts.begin(), ghosts.end());
                }
            }
            ElementBlock& target = block_for(blocks, block.type, entity_tag);
            target.tags.push_back(block.tags[i]);
            const auto first = block.nodes.begin() + static_cast<std::ptrdiff_t>(i) * per_element;
            target.nodes.insert(target.nodes.end(), first, first + per_element);
        }
    }
    data.blocks = std::move(blocks);
    for (const int partition : ghost_partitions) {
        partitioning.ghost_entities.emplace_back(++highest[mesh_dimension], partition);
        partitioning.count = std::max(partitioning.count, partition);
    }
    partitioning.element_partitions.clear();
}

PartitionsByElement::PartitionsByElement(const MeshData& data) {
    for (const Entity& entity : data.entities)
        if (entity.is_partition()) parts_.emplace(std::pair(entity.dimension, entity.tag), &entity);
    for (const ElementPartitions& element : data.partitioning.element_partitions)
        by_element_.emplace_back(std::pair(element.dimension, element.tag.value), &element);
    for (const GhostElement& ghost : data.partitioning.ghost_elements) ghosts_.emplace_back(ghost.tag.value, &ghost);
    std::sort(by_element_.begin(), by_element_.end());
    std::sort(ghosts_.begin(), ghosts_.end());
    for (const ElementBlock& block : data.blocks)
        if (block.size() > 0) dimension_ = std::max(dimension_, dimension(block.type.shape));
}

std::string PartitionsByElement::text(const ElementBlock& block, std::size_t element) const {
    const int dim = dimension(block.type.shape);
    const std::int64_t tag = block.tags[element].value;
    std::vector<int> partitions;
    const auto told =
        std::lower_bound(by_element_.begin(), by_element_.end(), std::pair(dim, tag),
                         [](const auto& entry, const std::pair<int, std::int64_t>& key) { return entry.first < key; });
    if (told != by_element_.end() && told->first == std::pair(dim, tag)) {
        partitions = told->second->partitions;
    } else if (const auto part = parts_.find({dim, block.entity_tag}); part != parts_.end()) {
        partitions = part->second->partitions;
        auto ghost = std::lower_bound(ghosts_.begin(), ghosts_.end(), tag,
                                      [](const auto& entry, std::int64_t key) { return entry.first < key; });
        for (; dim == dimension_ && ghost != ghosts_.end() && ghost->first == tag; ++ghost)
            for (const int partition : ghost->second->ghost_partitions) partitions.push_back(-partition);
    }
    if (partitions.empty()) return {};
    std::string text = fmt::format(" {}", partitions.size());
    for (const int partition : partitions) add(text, " {}", partition);
    return text;
}

int PartitionsByElement::elementary(const ElementBlock& block) const {
    const int dim = dimension(block.type.shape);
    const auto part = parts_.find({dim, block.entity_tag});
    const bool has_parent =
        part != parts_.end() && part->second->parent_dimension == dim && part->second->parent_tag > 0;
    return has_parent ? part->second->parent_tag : block.entity_tag;
}

// ---------------------------------------------------------------------------------------------------- writing

std::string partition_head_text(const Partitioning& partitioning) {
    std::string text = fmt::format("{}\n{}\n", partitioning.count, partitioning.ghost_entities.size());
    for (const auto& [tag, partition] : partitioning.ghost_entities) add(text, "{} {}\n", tag, partition);
    return text;
}

std::string ghost_elements_text(const Partitioning& partitioning) {
    if (partitioning.ghost_elements.empty()) return {};
    std::string text = fmt::format("$GhostElements\n{}\n", partitioning.ghost_elements.size());
    for (const GhostElement& ghost : partitioning.ghost_elements) {
        add(text, "{} {} {}", ghost.tag.value, ghost.partition, ghost.ghost_partitions.size());
        for (const int partition : ghost.ghost_partitions) add(text, " {}", partition);
        text += '\n';
    }
    return text + "$EndGhostElements\n";
}

std::string periodic_text(const MeshData& data, bool is_version_4) {
    if (data.periodic.empty()) return {};
    std::string text = fmt::format("$Periodic\n{}\n", data.periodic.size());
    for (const PeriodicLink& link : data.periodic) {
        add(text, "{} {} {}\n", link.dimension, link.tag, link.master_tag);
        if (is_version_4) text += link.affine ? "16" : "0\n";
        if (link.affine) {
            if (!is_version_4) text += "Affine";
            for (const double value : *link.affine) add(text, " {}", value);
            text += '\n';
        }
        add(text, "{}\n", link.nodes.size());
        for (const auto& [node, master] : link.nodes)
            add(text, "{} {}\n", data.node_tags[node].value, data.node_tags[master].value);
    }
    return text + "$EndPeriodic\n";
}

}  // namespace curvewright
