#pragma once

#include <cstring>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <string>
#include <tuple>

#include <gtest/gtest.h>
#include <unistd.h>

#include "core/basis/reference_element.h"
#include "core/io/mesh_io.h"

namespace curvewright {

/// A folder of its own for every test, removed with everything in it.
class TemporaryFolder {
  public:
    TemporaryFolder() {
        const auto* test = ::testing::UnitTest::GetInstance()->current_test_info();
        path_ = std::filesystem::temp_directory_path() /
                ("curvewright-" + std::to_string(::getpid()) + "-" + test->test_suite_name() + "-" + test->name());
        std::filesystem::create_directories(path_);
    }
    ~TemporaryFolder() {
        std::error_code ignored;
        std::filesystem::remove_all(path_, ignored);
    }
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;

    std::filesystem::path operator/(const std::string& name) const { return path_ / name; }
    const std::filesystem::path& path() const { return path_; }
    std::filesystem::path write(const std::string& name, const std::string& text) const {
        std::ofstream(path_ / name, std::ios::binary) << text;
        return path_ / name;
    }

  private:
    std::filesystem::path path_;
};

inline std::string test_data(const std::string& name) {
    return CURVEWRIGHT_TEST_DATA "/io/" + name;
}

/// What an error says; empty if nothing (of that kind) is thrown.
template <class Kind, class Function>
std::string message_of(Function&& function) {
    try {
        function();
    } catch (const Kind& error) {
        return error.what();
    }
    return {};
}

/// One element of the type, its facets as cells of their own and one corner, on tagged, named and classified entities.
/// Coordinates are the lattice, bent, with digits down to the last; tags have gaps.
inline CurvedMesh one_element_mesh(ElementType type) {
    const ReferenceElement& element = reference_element(type);
    MeshData data;
    Coordinates coordinates(element.node_count(), 3);
    const int dim = element.dimension;
    std::vector<Index> nodes;
    for (int node = 0; node < element.node_count(); ++node) {
        data.node_tags.push_back({7 * ((node * 5) % element.node_count()) + 3 + (node % 5 == 0 ? 10000 : 0)});
        data.node_entities.push_back({dim, 4});
        nodes.push_back(node);
        for (int d = 0; d < 3; ++d) {
            const double x = static_cast<double>(element.lattice[node][d]) / type.order;
            const double bent = d < dim ? x + 0.01 * std::sin(3.0 * x + node) : 0.0;
            coordinates(node, d) = bent / 3.0;
        }
    }
    for (int node = 0, n = element.node_count(); node < n; ++node)  // tags must be unique for every number of nodes
        if (n % 5 == 0) data.node_tags[static_cast<std::size_t>(node)] = {3 * node + 2};
    std::int64_t tag = 20;
    int entity = 11;
    for (const SubElement& facet : element.facets) {
        if (dim == 1) break;
        const bool is_reversed = entity % 2 == 0;
        data.entities.push_back({dim - 1, entity, {entity % 3 + 1}, {-1, -1, -1, 1, 2, 3.0 / 7.0 * entity}, {}});
        data.blocks.push_back({facet.type, entity, {facet.nodes.begin(), facet.nodes.end()}, {{tag}}});
        for (const int node : facet.nodes) data.node_entities[static_cast<std::size_t>(node)] = {dim - 1, entity};
        tag += is_reversed ? 3 : 2;
        ++entity;
    }
    data.blocks.push_back({{Shape::vertex, 1}, 2, {0}, {{900}}});
    data.node_entities[0] = {0, 2};
    const auto corner = coordinates.row(0);
    data.entities.push_back({0, 2, {5, 6}, {corner(0), corner(1), corner(2), corner(0), corner(1), corner(2)}, {}});
    Entity body{dim, 4, {1}, {-1, -1, -1, 1.0 / 3.0 + 1, 2, 2}, {}};
    for (int bounding = 11; bounding < entity; ++bounding)
        body.bounding_entities.push_back(bounding % 2 == 0 ? bounding : -bounding);
    data.entities.push_back(body);
    data.blocks.push_back({type, 4, nodes, {{1}}});
    data.groups = {{0, 5, "corner"}, {0, 6, ""}, {dim, 1, "the body; 100% of it"}};
    for (int group = 1; group <= 3 && dim > 1; ++group)
        data.groups.push_back({dim - 1, group, group == 2 ? "" : "side " + std::to_string(group)});
    return {std::make_shared<MeshTopology>(std::move(data)), coordinates};
}

/// Element tag (per dimension) to type, entity and node tags.
inline auto elements_of(const CurvedMesh& mesh) {
    std::map<std::pair<int, std::int64_t>, std::tuple<ElementType, int, std::vector<std::int64_t>>> result;
    const MeshData& data = mesh.topology().data();
    for (const ElementBlock& block : data.blocks) {
        const auto count = static_cast<std::size_t>(node_count(block.type));
        for (std::size_t i = 0; i < block.tags.size(); ++i) {
            std::vector<std::int64_t> nodes;
            for (std::size_t k = 0; k < count; ++k)
                nodes.push_back(data.node_tags[static_cast<std::size_t>(block.nodes[i * count + k])].value);
            result[{dimension(block.type.shape), block.tags[i].value}] = {block.type, block.entity_tag, nodes};
        }
    }
    return result;
}

inline auto groups_of(const CurvedMesh& mesh) {
    std::set<std::tuple<int, int, std::string>> result;
    for (const PhysicalGroup& group : mesh.topology().groups()) result.emplace(group.dimension, group.tag, group.name);
    return result;
}

/// Entities by dimension and tag: physical tags, box, bounding entities.
inline auto entities_of(const CurvedMesh& mesh) {
    std::map<std::pair<int, int>, std::tuple<std::vector<int>, std::array<double, 6>, std::vector<int>>> result;
    for (const Entity& entity : mesh.topology().entities())
        result[{entity.dimension, entity.tag}] = {entity.physical_tags, entity.bounding_box, entity.bounding_entities};
    return result;
}

inline bool same_bits(const Coordinates& a, const Coordinates& b) {
    return a.rows() == b.rows() &&
           std::memcmp(a.data(), b.data(), sizeof(double) * static_cast<std::size_t>(a.size())) == 0;
}

/// Everything that every format keeps: node tags and positions (bit for bit, in order), elements by tag with type,
/// entity and nodes, groups with names and nodes.
inline void expect_same_mesh(const CurvedMesh& a, const CurvedMesh& b, const std::string& what) {
    EXPECT_EQ(a.topology().data().node_tags, b.topology().data().node_tags) << what;
    EXPECT_TRUE(same_bits(a.coordinates(), b.coordinates())) << what;
    EXPECT_EQ(elements_of(a), elements_of(b)) << what;
    EXPECT_EQ(groups_of(a), groups_of(b)) << what;
    for (const PhysicalGroup& group : a.topology().groups()) {
        const std::string name = MeshTopology::display_name(group);
        EXPECT_EQ(a.topology().find_group_nodes(name), b.topology().find_group_nodes(name)) << what << " " << name;
    }
}

/// That, and what MSH 2.2 cannot hold: entities with their boxes and boundaries, and where the nodes lie.
inline void expect_same_model(const CurvedMesh& a, const CurvedMesh& b, const std::string& what) {
    expect_same_mesh(a, b, what);
    EXPECT_EQ(entities_of(a), entities_of(b)) << what;
    EXPECT_EQ(a.topology().data().node_entities, b.topology().data().node_entities) << what;
}

}  // namespace curvewright
