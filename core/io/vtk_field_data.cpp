#include "core/io/vtk_field_data.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <string_view>

#include <fmt/format.h>
#include <vtkDoubleArray.h>
#include <vtkIntArray.h>
#include <vtkNew.h>
#include <vtkStringArray.h>
#include <vtkTypeInt64Array.h>
#include <vtkUnsignedCharArray.h>

#include "core/io/mesh_entities.h"

namespace curvewright {
namespace {

// Names of the arrays, and what stands in them. Entities are runs of dimension, tag, number of physical tags, physical
// tags, number of bounding entities, bounding entities; their boxes are 6 numbers each; groups are dimension and tag,
// with their names, each ended by a zero byte; per node stand dimension and tag of its entity, -1 for none.
constexpr const char* version_name = "CurvewrightFormat";
constexpr const char *entities_name = "CurvewrightEntities", *boxes_name = "CurvewrightEntityBoxes";
constexpr const char *groups_name = "CurvewrightGroups", *group_names_name = "CurvewrightGroupNameBytes";
constexpr const char* node_entities_name = "CurvewrightNodeEntities";
// Periodic links are runs of dimension, tag, tag of the master, 1 with an affine map or 0 without one, number of pairs,
// pairs of node positions; the maps are 16 numbers each.
constexpr const char *periodic_name = "CurvewrightPeriodic", *maps_name = "CurvewrightPeriodicMaps";
// Partitions: their number; then, each with its count before it: ghost entities (tag, partition); parts of entities
// (dimension, tag, parent's dimension and tag, partitions); ghost elements (tag, partition, partitions that know it);
// elements (dimension, tag, partitions). A list within one of these has its own count before it.
constexpr const char* partitions_name = "CurvewrightPartitions";
constexpr const char* provenance_name = "CurvewrightProvenance";
constexpr const char* old_group_names_name = "CurvewrightGroupNames";  ///< version 1: an array of strings

constexpr int present_version = 2;

template <class Array, class Value>
void add_array(vtkFieldData& field, const char* name, int components, const std::vector<Value>& values) {
    if (values.empty()) return;
    auto array = new_array<Array>(name, components, static_cast<vtkIdType>(values.size()) / components);
    std::copy(values.begin(), values.end(), array->GetPointer(0));
    field.AddArray(array);
}

void add_bytes(vtkFieldData& field, const char* name, std::string_view text) {
    add_array<vtkUnsignedCharArray>(field, name, 1, std::vector<unsigned char>(text.begin(), text.end()));
}

void add_entities(vtkFieldData& field, const MeshData& data) {
    std::vector<int> runs;
    std::vector<double> boxes;
    for (const Entity& entity : data.entities) {
        runs.insert(runs.end(), {entity.dimension, entity.tag, static_cast<int>(entity.physical_tags.size())});
        runs.insert(runs.end(), entity.physical_tags.begin(), entity.physical_tags.end());
        runs.push_back(static_cast<int>(entity.bounding_entities.size()));
        runs.insert(runs.end(), entity.bounding_entities.begin(), entity.bounding_entities.end());
        boxes.insert(boxes.end(), entity.bounding_box.begin(), entity.bounding_box.end());
    }
    add_array<vtkIntArray>(field, entities_name, 1, runs);
    add_array<vtkDoubleArray>(field, boxes_name, 6, boxes);
}

void add_groups(vtkFieldData& field, const MeshData& data) {
    std::vector<int> groups;
    std::string names;
    for (const PhysicalGroup& group : data.groups) {
        groups.insert(groups.end(), {group.dimension, group.tag});
        names.append(group.name.c_str(), group.name.size() + 1);
    }
    add_array<vtkIntArray>(field, groups_name, 2, groups);
    add_bytes(field, group_names_name, names);
}

void add_periodic(vtkFieldData& field, const MeshData& data) {
    std::vector<std::int64_t> runs;
    std::vector<double> maps;
    for (const PeriodicLink& link : data.periodic) {
        runs.insert(runs.end(), {link.dimension, link.tag, link.master_tag, link.affine ? 1 : 0,
                                 static_cast<std::int64_t>(link.nodes.size())});
        for (const auto& [node, master] : link.nodes) runs.insert(runs.end(), {node, master});
        if (link.affine) maps.insert(maps.end(), link.affine->begin(), link.affine->end());
    }
    add_array<vtkTypeInt64Array>(field, periodic_name, 1, runs);
    add_array<vtkDoubleArray>(field, maps_name, 16, maps);
}

void add_partitions(vtkFieldData& field, const MeshData& data) {
    const Partitioning& partitioning = data.partitioning;
    const auto parts = std::count_if(data.entities.begin(), data.entities.end(),
                                     [](const Entity& entity) { return entity.is_partition(); });
    if (partitioning.is_empty() && parts == 0) return;
    std::vector<std::int64_t> values = {partitioning.count};
    const auto add_count = [&](std::size_t count) { values.push_back(static_cast<std::int64_t>(count)); };
    const auto add_list = [&](const std::vector<int>& list) {
        add_count(list.size());
        values.insert(values.end(), list.begin(), list.end());
    };
    add_count(partitioning.ghost_entities.size());
    for (const auto& [tag, partition] : partitioning.ghost_entities) values.insert(values.end(), {tag, partition});
    add_count(static_cast<std::size_t>(parts));
    for (const Entity& entity : data.entities) {
        if (!entity.is_partition()) continue;
        values.insert(values.end(), {entity.dimension, entity.tag, entity.parent_dimension, entity.parent_tag});
        add_list(entity.partitions);
    }
    add_count(partitioning.ghost_elements.size());
    for (const GhostElement& ghost : partitioning.ghost_elements) {
        values.insert(values.end(), {ghost.tag.value, ghost.partition});
        add_list(ghost.ghost_partitions);
    }
    add_count(partitioning.element_partitions.size());
    for (const ElementPartitions& element : partitioning.element_partitions) {
        values.insert(values.end(), {element.dimension, element.tag.value});
        add_list(element.partitions);
    }
    add_array<vtkTypeInt64Array>(field, partitions_name, 1, values);
}

/// Takes numbers out of an array one by one; what is not there or out of range makes it fail, and is 0.
class Cursor {
  public:
    explicit Cursor(const std::vector<std::int64_t>& values) : values_(values) {}

    bool is_good() const { return is_good_; }
    bool is_at_end() const { return next_ >= values_.size(); }
    std::int64_t wide() {
        is_good_ = is_good_ && next_ < values_.size();
        return is_good_ ? values_[next_++] : 0;
    }
    int number() {
        const std::int64_t value = wide();
        is_good_ = is_good_ && std::abs(value) <= std::numeric_limits<int>::max();
        return is_good_ ? static_cast<int>(value) : 0;
    }
    /// A number of things that follow, each of so many numbers at least.
    std::size_t count(std::size_t numbers_each = 1) {
        const std::int64_t value = wide();
        is_good_ = is_good_ && value >= 0 && static_cast<std::size_t>(value) <= (values_.size() - next_) / numbers_each;
        return is_good_ ? static_cast<std::size_t>(value) : 0;
    }
    std::vector<int> list() {
        std::vector<int> numbers(count());
        for (int& value : numbers) value = number();
        return numbers;
    }

  private:
    const std::vector<std::int64_t>& values_;
    std::size_t next_ = 0;
    bool is_good_ = true;
};

/// Each of these takes one kind of array and tells whether it was whole.
bool read_entities(vtkFieldData& field, MeshData& data) {
    const auto runs = integer_values(field, entities_name, 1, std::nullopt);
    if (!runs) return field.GetAbstractArray(entities_name) == nullptr;
    vtkDataArray* boxes = field.GetArray(boxes_name);
    std::set<EntityKey> seen;
    std::vector<Entity> entities;
    for (Cursor cursor(*runs); !cursor.is_at_end();) {
        Entity entity;
        entity.dimension = cursor.number();
        entity.tag = cursor.number();
        entity.physical_tags = cursor.list();
        entity.bounding_entities = cursor.list();
        const bool is_known_dimension = entity.dimension >= 0 && entity.dimension <= 3;
        if (!cursor.is_good() || !is_known_dimension || !seen.emplace(entity.dimension, entity.tag).second)
            return false;
        const auto place = static_cast<vtkIdType>(entities.size());
        if (boxes != nullptr && boxes->GetNumberOfComponents() == 6 && place < boxes->GetNumberOfTuples())
            boxes->GetTuple(place, entity.bounding_box.data());
        entities.push_back(std::move(entity));
    }
    data.entities = std::move(entities);
    return true;
}

/// Names in the order of the groups, as bytes or, in old files, as strings.
std::vector<std::string> read_names(vtkFieldData& field) {
    std::vector<std::string> names;
    if (const auto bytes = integer_values(field, group_names_name, 1, std::nullopt)) {
        std::string name;
        for (const std::int64_t byte : *bytes) {
            if (byte != 0) {
                name += static_cast<char>(byte);
                continue;
            }
            names.push_back(name);
            name.clear();
        }
        return names;
    }
    if (auto* strings = vtkStringArray::SafeDownCast(field.GetAbstractArray(old_group_names_name)))
        for (vtkIdType i = 0; i < strings->GetNumberOfValues(); ++i) names.push_back(strings->GetValue(i));
    return names;
}

bool read_groups(vtkFieldData& field, MeshData& data) {
    const auto groups = integer_values(field, groups_name, 2, std::nullopt);
    if (!groups) return field.GetAbstractArray(groups_name) == nullptr;
    const std::vector<std::string> names = read_names(field);
    bool is_whole = true;
    for (std::size_t i = 0; 2 * i < groups->size(); ++i) {
        const auto dim = (*groups)[2 * i], tag = (*groups)[2 * i + 1];
        if (dim < 0 || dim > 3 || tag < 0 || tag > std::numeric_limits<int>::max()) {
            is_whole = false;
            continue;
        }
        is_whole = is_whole && i < names.size();
        data.groups.push_back(
            {static_cast<int>(dim), static_cast<int>(tag), i < names.size() ? names[i] : std::string()});
    }
    return is_whole;
}

bool read_node_entities(vtkFieldData& field, MeshData& data) {
    const auto nodes = static_cast<vtkIdType>(data.node_tags.size());
    const auto on = integer_values(field, node_entities_name, 2, nodes);
    if (!on) return field.GetAbstractArray(node_entities_name) == nullptr;
    for (std::size_t i = 0; 2 * i < on->size(); ++i) {
        const auto dim = (*on)[2 * i], tag = (*on)[2 * i + 1];
        const bool is_known = dim >= 0 && dim <= 3 && std::abs(tag) <= std::numeric_limits<int>::max();
        data.node_entities.push_back(is_known ? NodeEntity{static_cast<int>(dim), static_cast<int>(tag)}
                                              : NodeEntity{});
    }
    return true;
}

bool read_periodic(vtkFieldData& field, MeshData& data) {
    const auto runs = integer_values(field, periodic_name, 1, std::nullopt);
    if (!runs) return field.GetAbstractArray(periodic_name) == nullptr;
    vtkDataArray* maps = field.GetArray(maps_name);
    if (maps != nullptr && maps->GetNumberOfComponents() != 16) return false;
    const auto nodes = static_cast<int>(data.node_tags.size());
    std::vector<PeriodicLink> links;
    vtkIdType next_map = 0;
    for (Cursor cursor(*runs); !cursor.is_at_end();) {
        PeriodicLink link;
        link.dimension = cursor.number();
        link.tag = cursor.number();
        link.master_tag = cursor.number();
        if (cursor.number() != 0) {
            if (maps == nullptr || next_map >= maps->GetNumberOfTuples()) return false;
            maps->GetTuple(next_map++, link.affine.emplace().data());
        }
        const std::size_t pairs = cursor.count(2);
        for (std::size_t i = 0; i < pairs; ++i) {
            const int node = cursor.number(), master = cursor.number();
            if (std::min(node, master) < 0 || std::max(node, master) >= nodes) return false;
            link.nodes.emplace_back(node, master);
        }
        if (!cursor.is_good() || link.dimension < 0 || link.dimension > 3) return false;
        links.push_back(std::move(link));
    }
    data.periodic = std::move(links);
    return true;
}

bool read_partitions(vtkFieldData& field, MeshData& data) {
    const auto values = integer_values(field, partitions_name, 1, std::nullopt);
    if (!values) return field.GetAbstractArray(partitions_name) == nullptr;
    Cursor cursor(*values);
    Partitioning partitioning;
    partitioning.count = cursor.number();
    for (std::size_t left = cursor.count(2); left > 0; --left) {
        const int tag = cursor.number();
        partitioning.ghost_entities.emplace_back(tag, cursor.number());
    }
    std::vector<Entity> parts(cursor.count(5));
    for (Entity& part : parts) {
        part.dimension = cursor.number();
        part.tag = cursor.number();
        part.parent_dimension = cursor.number();
        part.parent_tag = cursor.number();
        part.partitions = cursor.list();
    }
    partitioning.ghost_elements.resize(cursor.count(3));
    for (GhostElement& ghost : partitioning.ghost_elements) {
        ghost.tag = {cursor.wide()};
        ghost.partition = cursor.number();
        ghost.ghost_partitions = cursor.list();
    }
    partitioning.element_partitions.resize(cursor.count(3));
    for (ElementPartitions& element : partitioning.element_partitions) {
        element.dimension = cursor.number();
        element.tag = {cursor.wide()};
        element.partitions = cursor.list();
    }
    if (!cursor.is_good() || partitioning.count < 0) return false;
    std::map<EntityKey, Entity*> entities;
    for (Entity& entity : data.entities) entities.emplace(EntityKey(entity.dimension, entity.tag), &entity);
    for (Entity& part : parts) {
        const auto entity = entities.find({part.dimension, part.tag});
        if (entity == entities.end()) return false;
        entity->second->partitions = std::move(part.partitions);
        entity->second->parent_dimension = part.parent_dimension;
        entity->second->parent_tag = part.parent_tag;
    }
    data.partitioning = std::move(partitioning);
    return true;
}

}  // namespace

std::optional<std::vector<std::int64_t>> integer_values(vtkFieldData& data, const char* name, int components,
                                                        std::optional<vtkIdType> tuples) {
    vtkDataArray* array = data.GetArray(name);
    if (array == nullptr || array->GetNumberOfComponents() != components ||
        (tuples && array->GetNumberOfTuples() != *tuples))
        return std::nullopt;
    std::vector<std::int64_t> values(static_cast<std::size_t>(array->GetNumberOfValues()));
    const auto* wide = vtkTypeInt64Array::SafeDownCast(array);
    for (std::size_t i = 0; i < values.size(); ++i) {
        const auto id = static_cast<vtkIdType>(i);
        if (wide != nullptr) {
            values[i] = wide->GetValue(id);
            continue;
        }
        const double value = array->GetComponent(id / components, static_cast<int>(id % components));
        if (!(std::abs(value) < 9e15) || value != std::floor(value)) return std::nullopt;
        values[i] = static_cast<std::int64_t>(value);
    }
    return values;
}

void fill_field_data(vtkFieldData& field, const MeshData& data, const Provenance* provenance) {
    add_array<vtkIntArray>(field, version_name, 1, std::vector<int>{present_version});
    if (provenance != nullptr) add_bytes(field, provenance_name, provenance_text(*provenance));
    add_entities(field, data);
    add_groups(field, data);
    std::vector<int> node_entities;
    for (const NodeEntity& entity : data.node_entities)
        node_entities.insert(node_entities.end(), {entity.dimension, entity.tag});
    add_array<vtkIntArray>(field, node_entities_name, 2, node_entities);
    add_periodic(field, data);
    add_partitions(field, data);
}

std::optional<int> field_data_version(vtkFieldData& field) {
    const auto values = integer_values(field, version_name, 1, 1);
    const bool is_version = values && values->front() >= 1 && values->front() <= std::numeric_limits<int>::max();
    return is_version ? std::optional(static_cast<int>(values->front())) : std::nullopt;
}

void read_field_data(vtkFieldData& field, MeshData& data, std::vector<std::string>& notes) {
    bool is_whole = true;
    for (const auto read : {read_entities, read_groups, read_node_entities, read_periodic, read_partitions})
        is_whole = read(field, data) && is_whole;
    if (const auto version = field_data_version(field); version && *version > present_version)
        notes.push_back(
            fmt::format("The file was written by a later version of this program (its arrays are of version {}, and "
                        "{} is known here); what is new in it was passed over.",
                        *version, present_version));
    if (!is_whole)
        notes.push_back(
            "The arrays that tell entities, groups, periodic nodes and partitions (Curvewright...) do not fit the "
            "mesh; what could be understood of them was kept.");
}

}  // namespace curvewright
