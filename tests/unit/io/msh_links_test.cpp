#include <fmt/format.h>

#include "core/base/error.h"
#include "core/io/atomic_file.h"
#include "core/io/msh_io.h"
#include "core/mesh/elevate.h"
#include "tests/unit/io/io_helpers.h"

namespace curvewright {
namespace {

const std::string partitioned_41 = "square_periodic_partitioned.msh";
const std::string partitioned_22 = "square_periodic_partitioned_2.2.msh";

/// Links with their pairs by tag.
auto links_of(const CurvedMesh& mesh) {
    std::vector<std::tuple<int, int, int, std::optional<std::array<double, 16>>,
                           std::vector<std::pair<std::int64_t, std::int64_t>>>>
        result;
    const MeshData& data = mesh.topology().data();
    for (const PeriodicLink& link : data.periodic) {
        std::vector<std::pair<std::int64_t, std::int64_t>> tags;
        for (const auto& [node, master] : link.nodes)
            tags.emplace_back(data.node_tags[node].value, data.node_tags[master].value);
        result.emplace_back(link.dimension, link.tag, link.master_tag, link.affine, tags);
    }
    return result;
}

/// By dimension and tag: parent and partitions of the parts of entities.
auto parts_of(const CurvedMesh& mesh) {
    std::map<std::pair<int, int>, std::tuple<int, int, std::vector<int>>> result;
    for (const Entity& entity : mesh.topology().entities())
        if (entity.is_partition())
            result[{entity.dimension, entity.tag}] = {entity.parent_dimension, entity.parent_tag, entity.partitions};
    return result;
}

/// Everything else that is kept of partitions, comparable.
auto partitioning_of(const CurvedMesh& mesh) {
    const Partitioning& partitioning = mesh.topology().data().partitioning;
    std::vector<std::tuple<std::int64_t, int, std::vector<int>>> ghosts, elements;
    for (const GhostElement& ghost : partitioning.ghost_elements)
        ghosts.emplace_back(ghost.tag.value, ghost.partition, ghost.ghost_partitions);
    for (const ElementPartitions& element : partitioning.element_partitions)
        elements.emplace_back(element.tag.value, element.dimension, element.partitions);
    return std::tuple(partitioning.count, partitioning.ghost_entities, ghosts, elements);
}

ReadResult rewritten(const TemporaryFolder& folder, const CurvedMesh& mesh, MeshFormat format, bool is_binary = false) {
    WriteOptions options;
    options.format = format;
    if (is_binary) options.binary = true;
    const bool is_msh = format == MeshFormat::msh2 || format == MeshFormat::msh4;
    const auto file = folder / (is_msh ? "again.msh" : format == MeshFormat::vtu ? "again.vtu" : "again.vtk");
    write_mesh(file, mesh, options);
    ReadResult result = read_mesh(file);
    EXPECT_TRUE(result.notes.empty()) << result.notes.front();
    return result;
}

const std::string nodes_and_elements_22 =
    "$Nodes\n4\n1 0 0 0\n2 1 0 0\n3 1 1 0\n4 0 1 0\n$EndNodes\n"
    "$Elements\n4\n1 1 2 0 1 2 3\n2 1 2 0 2 1 4\n3 2 2 0 3 1 2 3\n4 2 2 0 3 1 3 4\n$EndElements\n";
const std::string nodes_and_elements_4 =
    "$Nodes\n1 4 1 4\n2 3 0 4\n1\n2\n3\n4\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n$EndNodes\n"
    "$Elements\n3 4 1 4\n1 1 1 1\n1 2 3\n1 2 1 1\n2 1 4\n2 3 2 2\n3 1 2 3\n4 1 3 4\n$EndElements\n";
const std::string head_22 = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n",
                  head_41 = "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n";

TEST(Periodic, is_read_in_the_words_of_every_version) {
    const TemporaryFolder folder;
    const std::string numbers = "1 0 0 1 0 1 0 0 0 0 1 0 0 0 0 1";
    const std::array<double, 16> map = {1, 0, 0, 1, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    const std::string pairs = "2\n2 1\n3 4\n";
    for (const auto& [head, body, link, has_map] :
         {std::tuple{head_22, nodes_and_elements_22, "1 1 2\n" + pairs, false},
          std::tuple{head_22, nodes_and_elements_22, "1 1 2\nAffine " + numbers + "\n" + pairs, true},
          std::tuple{head_41, nodes_and_elements_4, "1 1 2\n0\n" + pairs, false},
          std::tuple{head_41, nodes_and_elements_4, "1 1 2\n16 " + numbers + "\n" + pairs, true}})
        for (const bool is_first : {false, true}) {
            const std::string section = "$Periodic\n1\n" + link + "$EndPeriodic\n";
            const ReadResult result =
                read_mesh(folder.write("a.msh", head + (is_first ? section + body : body + section)));
            EXPECT_TRUE(result.notes.empty());
            const auto links = links_of(result.mesh);
            ASSERT_EQ(links.size(), 1u);
            EXPECT_EQ(links.front(), std::tuple(1, 1, 2, has_map ? std::optional(map) : std::nullopt,
                                                std::vector<std::pair<std::int64_t, std::int64_t>>{{2, 1}, {3, 4}}));
        }
}

TEST(Periodic, is_kept_by_every_format) {
    const TemporaryFolder folder;
    for (const std::string& name : {partitioned_41, partitioned_22}) {
        const CurvedMesh mesh = read_mesh(test_data(name)).mesh;
        ASSERT_FALSE(links_of(mesh).empty());
        EXPECT_EQ(
            links_of(mesh).back(),
            std::tuple(1, 2, 4, std::optional(std::array<double, 16>{1, 0, 0, 1, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}),
                       std::get<4>(links_of(mesh).back())));
        EXPECT_EQ(std::get<4>(links_of(mesh).back()).size(), 3u);
        for (const MeshFormat format : {MeshFormat::msh2, MeshFormat::msh4, MeshFormat::vtu, MeshFormat::vtk})
            EXPECT_EQ(links_of(mesh), links_of(rewritten(folder, mesh, format).mesh)) << to_string(format);
        EXPECT_EQ(links_of(mesh), links_of(rewritten(folder, mesh, MeshFormat::vtk, true).mesh));
    }
}

TEST(Periodic, entities_that_22_does_not_have_stand_in_41) {
    const TemporaryFolder folder;
    const CurvedMesh mesh = read_mesh(folder.write("a.msh", head_22 + nodes_and_elements_22 +
                                                                "$Periodic\n1\n0 8 9\n1\n2 1\n$EndPeriodic\n"))
                                .mesh;
    const CurvedMesh in_41 = rewritten(folder, mesh, MeshFormat::msh4).mesh;
    const auto entities = entities_of(in_41);
    ASSERT_TRUE(entities.contains({0, 8}) && entities.contains({0, 9}));
    EXPECT_EQ(std::get<1>(entities.at({0, 8})), (std::array<double, 6>{1, 0, 0, 1, 0, 0}));  // node 2
    EXPECT_EQ(links_of(in_41), links_of(mesh));
}

TEST(Periodic, pairs_of_strangers_are_passed_over_with_a_note) {
    const TemporaryFolder folder;
    const ReadResult result = read_mesh(folder.write(
        "a.msh", head_22 + nodes_and_elements_22 + "$Periodic\n1\n1 1 2\n3\n2 1\n3 9\n8 4\n$EndPeriodic\n"));
    EXPECT_EQ(
        result.notes,
        (std::vector<std::string>{"$Periodic pairs 2 nodes that the file does not have; they were passed over."}));
    EXPECT_EQ(std::get<4>(links_of(result.mesh).front()).size(), 1u);
}

TEST(Periodic, follows_a_change_of_order) {
    for (const std::string& name : {partitioned_41, partitioned_22}) {
        const CurvedMesh linear = read_mesh(test_data(name)).mesh;
        CurvedMesh mesh = linear;
        for (const int order : {3, 2, 4, 1}) {
            mesh = elevate(mesh, order);
            const MeshData& data = mesh.topology().data();
            ASSERT_EQ(data.periodic.size(), linear.topology().data().periodic.size());
            for (const PeriodicLink& link : data.periodic) {
                // In 4.1 the cells lie on parts of the periodic curve, in 2.2 on the curve itself.
                EXPECT_EQ(link.nodes.size(), link.dimension == 0 ? 1u : 2u * static_cast<unsigned>(order) + 1u) << name;
                for (const auto& [node, master] : link.nodes) {
                    const Eigen::RowVector3d shift = mesh.coordinates().row(node) - mesh.coordinates().row(master);
                    EXPECT_LT((shift - Eigen::RowVector3d(1, 0, 0)).norm(), 1e-11) << name << " " << order;
                }
            }
            EXPECT_TRUE(periodic_gaps(mesh.topology()).empty());
        }
        expect_same_mesh(linear, mesh, name);
    }
}

TEST(Periodic, nodes_without_counterpart_are_told) {
    const CurvedMesh mesh = read_mesh(test_data(partitioned_22)).mesh;
    MeshData data = mesh.topology().data();
    data.periodic.front().nodes.pop_back();
    ASSERT_EQ(periodic_gaps(MeshTopology(data)).size(), 1u);
    EXPECT_NE(periodic_gaps(MeshTopology(data)).front().find("1 nodes of periodic entity 2 of dimension 1"),
              std::string::npos);
    data.periodic.front().tag = 77;
    EXPECT_NE(periodic_gaps(MeshTopology(data)).front().find("has no cells of its own"), std::string::npos);
    data.periodic.front().nodes.emplace_back(0, 12345);
    EXPECT_THROW(MeshTopology{data}, InvalidInput);
}

TEST(Periodic, follows_new_numbers_of_nodes) {
    std::vector<PeriodicLink> links(1);
    links.front().nodes = {{0, 4}, {1, 5}, {2, 6}, {3, 7}};
    renumber_periodic(links, {0, 1, 1, -1, 2, 3, 3, 4});
    EXPECT_EQ(links.front().nodes, (std::vector<std::pair<Index, Index>>{{0, 2}, {1, 3}}));
}

TEST(Partitions, are_kept_in_41) {
    const TemporaryFolder folder;
    const ReadResult read = read_mesh(test_data(partitioned_41));
    EXPECT_TRUE(read.notes.empty());
    const auto parts = parts_of(read.mesh);
    EXPECT_EQ(parts.size(), 15u);
    EXPECT_EQ(parts.at({2, 2}), std::tuple(2, 1, std::vector<int>{2}));
    EXPECT_EQ(parts.at({1, 11}), std::tuple(2, 1, std::vector<int>{1, 2}));  // the border between the two
    const auto& [count, ghost_entities, ghosts, elements] = partitioning_of(read.mesh);
    EXPECT_EQ(count, 2);
    EXPECT_EQ(ghost_entities, (std::vector<std::pair<int, int>>{{4, 1}, {5, 2}}));
    EXPECT_EQ(ghosts.size(), 12u);
    EXPECT_EQ(ghosts.front(), std::tuple(std::int64_t{17}, 1, std::vector<int>{2}));
    for (const auto& [format, is_binary] :
         {std::pair{MeshFormat::msh4, false}, std::pair{MeshFormat::vtu, true}, std::pair{MeshFormat::vtu, false},
          std::pair{MeshFormat::vtk, true}, std::pair{MeshFormat::vtk, false}}) {
        const CurvedMesh again = format == MeshFormat::msh4 ? rewritten(folder, read.mesh, format).mesh
                                                            : rewritten(folder, read.mesh, format, is_binary).mesh;
        expect_same_model(read.mesh, again, to_string(format));
        EXPECT_EQ(parts, parts_of(again)) << to_string(format);
        EXPECT_EQ(partitioning_of(read.mesh), partitioning_of(again)) << to_string(format);
    }
}

TEST(Partitions, borders_are_no_geometry) {
    const CurvedMesh mesh = read_mesh(test_data(partitioned_41)).mesh;
    EXPECT_TRUE(mesh.topology().interface_facets().empty());
    EXPECT_TRUE(mesh.topology().interface_nodes().empty());
}

TEST(Partitions, are_kept_in_22_and_go_between_the_versions) {
    const TemporaryFolder folder;
    const ReadResult read = read_mesh(test_data(partitioned_22));
    EXPECT_TRUE(read.notes.empty());
    const auto elements = std::get<3>(partitioning_of(read.mesh));
    ASSERT_EQ(elements.size(), 22u);
    EXPECT_EQ(std::get<0>(partitioning_of(read.mesh)), 2);
    EXPECT_EQ(elements[8], std::tuple(std::int64_t{9}, 2, std::vector<int>{2, -1}));
    EXPECT_EQ(partitioning_of(read.mesh), partitioning_of(rewritten(folder, read.mesh, MeshFormat::msh2).mesh));
    EXPECT_EQ(partitioning_of(read.mesh), partitioning_of(rewritten(folder, read.mesh, MeshFormat::vtu).mesh));

    const CurvedMesh in_41 = rewritten(folder, read.mesh, MeshFormat::msh4).mesh;
    EXPECT_EQ(in_41.topology().data().node_tags, read.mesh.topology().data().node_tags);
    std::map<std::int64_t, std::vector<int>> by_element;
    for (const auto& [tag, dim, partitions] : elements) by_element[tag] = partitions;
    const auto parts = parts_of(in_41);
    EXPECT_EQ(parts.size(), 8u);  // two sides of four cross the border, and the square: 2 + 2 * 2 + 2
    std::size_t ghosts = 0;
    for (const ElementBlock& block : in_41.topology().blocks()) {
        const auto& [parent_dimension, parent, partitions] = parts.at({dimension(block.type.shape), block.entity_tag});
        EXPECT_EQ(parent_dimension, dimension(block.type.shape));
        for (const ElementTag tag : block.tags) {
            EXPECT_EQ(by_element.at(tag.value).front(), partitions.front());
            ghosts += by_element.at(tag.value).size() - 1;
        }
    }
    EXPECT_EQ(in_41.topology().data().partitioning.ghost_elements.size(), ghosts);
    // Back to 2.2 it is the file that it was.
    EXPECT_EQ(msh2_text(in_41), msh2_text(read.mesh));
}

TEST(Partitions, of_41_become_tags_of_elements_in_22) {
    const TemporaryFolder folder;
    const CurvedMesh mesh = read_mesh(test_data(partitioned_41)).mesh;
    const CurvedMesh in_22 = rewritten(folder, mesh, MeshFormat::msh2).mesh;
    const auto parts = parts_of(mesh);
    std::map<std::pair<int, std::int64_t>, std::vector<int>> by_element;
    for (const ElementPartitions& element : in_22.topology().data().partitioning.element_partitions)
        by_element[{element.dimension, element.tag.value}] = element.partitions;
    for (const ElementBlock& block : mesh.topology().blocks())
        for (const ElementTag tag : block.tags) {
            const int dim = dimension(block.type.shape);
            const auto found = by_element.find({dim, tag.value});
            ASSERT_NE(found, by_element.end()) << tag.value;
            const auto& partitions = std::get<2>(parts.at({dim, block.entity_tag}));
            EXPECT_TRUE(std::equal(partitions.begin(), partitions.end(), found->second.begin()));
        }
    EXPECT_EQ(by_element.at({2, 17}), (std::vector<int>{1, -2}));
}

struct Broken {
    std::string text, expected;
};

TEST(HostileLinks, are_told_with_line_and_reason) {
    const TemporaryFolder folder;
    const std::string all_22 = head_22 + nodes_and_elements_22, all_41 = head_41 + nodes_and_elements_4;
    const std::vector<Broken> table = {
        {all_22 + "$Periodic\n-1\n$EndPeriodic\n", "the number of periodic entities is -1"},
        {all_22 + "$Periodic\n999999999\n$EndPeriodic\n", "999999999 periodic entities are announced"},
        {all_22 + "$Periodic\n1\n4 1 2\n0\n$EndPeriodic\n", "a periodic entity has dimension 4"},
        {all_22 + "$Periodic\n1\n1 one 2\n0\n$EndPeriodic\n", "\"one\" stands where the tag of a periodic entity"},
        {all_22 + "$Periodic\n1\n1 1 2\n88888888\n2 1\n$EndPeriodic\n", "88888888 pairs of periodic nodes"},
        {all_22 + "$Periodic\n1\n1 1 2\n2\n2 1\n$EndPeriodic\n", "\"$EndPeriodic\" stands where a periodic node"},
        {all_22 + "$Periodic\n1\n1 1 2\nAffine 1 2 3\n0\n$EndPeriodic\n",
         "\"$EndPeriodic\" stands where a number of an affine map"},
        {all_22 + "$Periodic\n1\n1 1 2\nAffine 1 0 0 nan 0 0 0 0 0 0 0 0 0 0 0 0\n0\n$EndPeriodic\n", "\"nan\""},
        {all_41 + "$Periodic\n1\n1 1 2\n9 1 2 3 4 5 6 7 8 9\n0\n$EndPeriodic\n",
         "an affine map has 9 numbers; 16 or none"},
        {all_41 + "$Periodic\n1\n1 1 2\n0\n1\n2 1\n3 4\n$EndPeriodic\n", "\"3\" stands where $EndPeriodic"},
        {all_41 + "$Periodic\n1\n1 1 2\n", "the file ends where the number of numbers of an affine map"},
        {all_41 + "$GhostElements\n-2\n$EndGhostElements\n", "the number of ghost elements is -2"},
        {all_41 + "$GhostElements\n1\n3 1 777777\n$EndGhostElements\n", "777777 partitions that know a ghost element"},
        {all_41 + "$GhostElements\n1\n3 1 1 -2147483648\n$EndGhostElements\n", "-2147483648 is out of range"},
        {head_41 + "$PartitionedEntities\n-3\n0\n0 0 0 0\n$EndPartitionedEntities\n", "the number of partitions is -3"},
        {head_41 + "$PartitionedEntities\n2\n55555555\n", "55555555 ghost entities are announced"},
        {head_41 + "$PartitionedEntities\n2\n0\n1 0 0 0\n5 0 1 66666666 1\n", "66666666 partitions are announced"},
        {head_41 +
             "$PartitionedEntities\n2\n0\n2 0 0 0\n5 0 1 1 1 0 0 0 0\n5 0 1 1 1 0 0 0 0\n$EndPartitionedEntities\n",
         "entity 5 of dimension 0 occurs twice"},
        {head_22 + "$Nodes\n2\n1 0 0 0\n2 1 0 0\n$EndNodes\n$Elements\n1\n1 1 5 0 1 2 1 x 1 2\n$EndElements\n",
         "\"x\" stands where a tag of the element"},
    };
    for (const Broken& broken : table) {
        const auto file = folder.write("bad.msh", broken.text);
        const std::string message = message_of<InvalidInput>([&] { read_mesh(file); });
        EXPECT_NE(message.find("bad.msh:"), std::string::npos) << broken.text << "\n" << message;
        EXPECT_NE(message.find(broken.expected), std::string::npos) << broken.expected << "\n" << message;
    }
}

TEST(HostileLinks, tags_that_are_no_partitions_are_none) {
    const TemporaryFolder folder;
    const std::string nodes = "$Nodes\n2\n1 0 0 0\n2 1 0 0\n$EndNodes\n";
    for (const char* tags : {"3 0 1 1", "4 0 1 3 1", "3 0 1 0", "4 0 1 -1 5"}) {
        const auto file = folder.write("a.msh", head_22 + nodes + "$Elements\n1\n1 1 " + tags + " 1 2\n$EndElements\n");
        EXPECT_TRUE(read_mesh(file).mesh.topology().data().partitioning.is_empty()) << tags;
    }
}

TEST(HostileLinks, damaged_arrays_of_vtk_files_are_told_and_passed_over) {
    const TemporaryFolder folder;
    const CurvedMesh mesh = read_mesh(test_data(partitioned_41)).mesh;
    WriteOptions options;
    options.binary = false;
    write_mesh(folder / "a.vtu", mesh, options);
    const std::string text = read_text_file(folder / "a.vtu");
    for (const char* array : {"CurvewrightPeriodic", "CurvewrightPartitions", "CurvewrightEntities"})
        for (const char* value : {"-1", "99999999999", "2147483648", "-9223372036854775808", "7"}) {
            // Each of the first numbers in turn.
            for (int place = 0; place < 12; ++place) {
                std::string damaged = text;
                std::size_t at = damaged.find('>', damaged.find(std::string("Name=\"") + array + "\"")) + 1;
                for (int skipped = 0; skipped <= place; ++skipped) {
                    at = damaged.find_first_not_of(" \n", at);
                    if (skipped < place) at = damaged.find_first_of(" \n", at);
                }
                damaged.replace(at, damaged.find_first_of(" \n", at) - at, value);
                try {
                    const ReadResult result = read_mesh(folder.write("bad.vtu", damaged));
                    EXPECT_EQ(result.mesh.topology().element_count(), 14);
                } catch (const Error& error) {
                    EXPECT_NE(std::string(error.what()).find("bad.vtu"), std::string::npos);
                }
            }
        }
}

}  // namespace
}  // namespace curvewright
