#include <zlib.h>

#include "core/io/atomic_file.h"
#include "tests/unit/io/io_helpers.h"

namespace curvewright {
namespace {

std::vector<int> physicals(const CurvedMesh& mesh, int dim, int tag) {
    return std::get<0>(entities_of(mesh).at({dim, tag}));
}

/// Names and node sets of the groups of one dimension.
std::map<std::string, std::size_t> group_sizes(const CurvedMesh& mesh) {
    std::map<std::string, std::size_t> sizes;
    for (const PhysicalGroup& group : mesh.topology().groups()) {
        const std::string name = MeshTopology::display_name(group);
        sizes[name] = mesh.topology().find_group_nodes(name)->size();
    }
    return sizes;
}

const char* const head_41 = "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n";
const char* const head_22 = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n";

TEST(Msh, versions_of_one_mesh_agree) {
    const CurvedMesh a = read_mesh(test_data("annulus.msh")).mesh, b = read_mesh(test_data("annulus_2.2.msh")).mesh;
    EXPECT_EQ(read_mesh(test_data("annulus.msh")).format, MeshFormat::msh4);
    EXPECT_EQ(read_mesh(test_data("annulus_2.2.msh")).format, MeshFormat::msh2);
    EXPECT_EQ(groups_of(a), groups_of(b));
    EXPECT_EQ(group_sizes(a), group_sizes(b));
    ASSERT_EQ(a.topology().element_count(), b.topology().element_count());
    for (Index e = 0; e < a.topology().element_count(); ++e)
        EXPECT_EQ(a.element_coordinates(e), b.element_coordinates(e)) << e;
    const auto names = groups_of(a);
    EXPECT_TRUE(names.contains({1, 1, "outer"}) && names.contains({1, 2, "inner"}) && names.contains({2, 1, "domain"}));
}

TEST(Msh, entities_in_several_groups) {
    const CurvedMesh v4 = read_mesh(test_data("square_4.0.msh")).mesh, v2 = read_mesh(test_data("square_2.2.msh")).mesh;
    for (const CurvedMesh* mesh : {&v4, &v2}) {
        EXPECT_EQ(mesh->topology().element_count(), 4);  // not 8: copies per group are one element
        EXPECT_EQ(mesh->topology().boundary_nodes().size(), 4u);
        EXPECT_EQ(physicals(*mesh, 1, 1), (std::vector<int>{5, 6}));
        EXPECT_EQ(physicals(*mesh, 1, 3), (std::vector<int>{6}));
        EXPECT_EQ(physicals(*mesh, 2, 1), (std::vector<int>{7, 8}));
        EXPECT_EQ(group_sizes(*mesh),
                  (std::map<std::string, std::size_t>{{"a b", 3}, {"six", 4}, {"2:7", 5}, {"2:8", 5}}));
    }
}

TEST(Msh, partitions_and_parametric_nodes_are_no_obstacle) {
    const ReadResult partitioned = read_mesh(test_data("square_partitioned.msh"));
    EXPECT_EQ(partitioned.mesh.topology().element_count(), 4);
    EXPECT_EQ(group_sizes(partitioned.mesh).at("six"), 4u);
    EXPECT_EQ(group_sizes(partitioned.mesh).at("2:8"), 5u);
    for (const std::string& note : partitioned.notes) EXPECT_EQ(note.find("partition"), std::string::npos) << note;
    EXPECT_EQ(partitioned.mesh.topology().data().partitioning.count, 2);
    const CurvedMesh parametric = read_mesh(test_data("square_parametric.msh")).mesh;
    EXPECT_EQ(parametric.coordinates().row(*parametric.topology().find_node({5})), Eigen::RowVector3d(0.5, 0.5, 0.0));
}

TEST(Msh, skips_what_it_does_not_know_with_a_note) {
    const TemporaryFolder folder;
    const std::string mesh = read_text_file(test_data("annulus.msh"));
    const std::string extra =
        "$Comments\nanything $Nodes\n$EndComments\n$Parametrizations\n0 0\n$EndParametrizations\n"
        "$ElementNodeData\n1\n\"a\"\n$EndElementNodeData\n";
    const ReadResult result = read_mesh(folder.write("a.msh", mesh + extra));
    EXPECT_EQ(result.mesh.topology().element_count(), 30);
    EXPECT_EQ(result.notes, (std::vector<std::string>{"Section $Parametrizations was skipped.",
                                                      "Section $ElementNodeData was skipped."}));
}

TEST(Msh, reads_41_without_entities) {
    const TemporaryFolder folder;
    const auto mesh =
        read_mesh(folder.write("a.msh", std::string(head_41) +
                                            "$Nodes\n1 3 1 9\n2 1 0 3\n1\n2\n9\n0 0 0\n1 0 0\n0 2 0\n$EndNodes\n"
                                            "$Elements\n1 1 1 1\n2 1 2 1\n1 1 2 9\n$EndElements\n"))
            .mesh;
    EXPECT_EQ(mesh.topology().element_count(), 1);
    EXPECT_EQ(std::get<1>(entities_of(mesh).at({2, 1})), (std::array<double, 6>{0, 0, 0, 1, 2, 0}));
}

TEST(Msh, reads_22_without_groups_and_with_any_number_of_tags) {
    const TemporaryFolder folder;
    const auto mesh =
        read_mesh(folder.write("a.msh", std::string(head_22) +
                                            "$Nodes\n4\r\n1 0 0 0\r\n2 1 0 0\n3 0 1 0\n4 1 1 0\n$EndNodes\n"
                                            "$Elements\n3\n1 2 0 1 2 3\n2 2 1 0 2 4 3\n3 1 4 0 0 1 1 1 2\n"
                                            "$EndElements\n"))
            .mesh;
    EXPECT_EQ(mesh.topology().element_count(), 2);
    EXPECT_TRUE(mesh.topology().groups().empty());
    EXPECT_TRUE(mesh.topology().entities().empty());
}

TEST(Msh, splits_elementary_entities_whose_elements_differ_in_group) {
    const TemporaryFolder folder;
    const ReadResult result = read_mesh(folder.write(
        "a.msh", std::string(head_22) + "$Nodes\n4\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 1 1 0\n$EndNodes\n"
                                        "$Elements\n2\n1 2 2 10 3 1 2 3\n2 2 2 11 3 2 4 3\n$EndElements\n"));
    EXPECT_EQ(physicals(result.mesh, 2, 3), std::vector<int>{10});
    EXPECT_EQ(physicals(result.mesh, 2, 4), std::vector<int>{11});
    ASSERT_EQ(result.notes.size(), 1u);
    EXPECT_EQ(result.mesh.topology().find_group_nodes("2:10")->size(), 3u);
}

TEST(Msh, joins_an_element_that_stands_there_once_per_group) {
    const TemporaryFolder folder;
    const auto mesh =
        read_mesh(folder.write("a.msh", std::string(head_22) +
                                            "$Nodes\n3\n1 0 0 0\n2 1 0 0\n3 0 1 0\n$EndNodes\n"
                                            "$Elements\n2\n1 2 2 10 3 1 2 3\n1 2 2 11 3 1 2 3\n$EndElements\n"))
            .mesh;
    EXPECT_EQ(mesh.topology().element_count(), 1);
    EXPECT_EQ(physicals(mesh, 2, 3), (std::vector<int>{10, 11}));
}

TEST(Msh, reads_compressed_files_and_says_when_they_are_damaged) {
    const TemporaryFolder folder;
    const std::string text = read_text_file(test_data("annulus.msh"));
    const std::string path = (folder / "a.msh.gz").string();
    gzFile stream = gzopen(path.c_str(), "wb");
    ASSERT_EQ(gzwrite(stream, text.data(), static_cast<unsigned>(text.size())), static_cast<int>(text.size()));
    gzclose(stream);
    expect_same_model(read_mesh(test_data("annulus.msh")).mesh, read_mesh(path).mesh, "compressed");
    std::filesystem::resize_file(path, std::filesystem::file_size(path) / 2);
    EXPECT_NE(message_of<InvalidInput>([&] { read_mesh(path); }).find("damaged"), std::string::npos);
    EXPECT_NE(message_of<InvalidInput>([&] {
                  write_mesh(path, one_element_mesh({Shape::line, 1}));
              }).find(".gz"),
              std::string::npos);
}

TEST(Msh, stops_when_asked) {
    std::stop_source source;
    source.request_stop();
    EXPECT_THROW(read_mesh(test_data("annulus.msh"), {source.get_token(), {}}), Cancelled);
}

TEST(MeshIo, suffix_tells_the_format) {
    EXPECT_EQ(format_of_suffix("a.msh"), MeshFormat::msh4);
    EXPECT_EQ(format_of_suffix("a.MSH"), MeshFormat::msh4);
    EXPECT_EQ(format_of_suffix("a.msh.gz"), MeshFormat::msh4);
    EXPECT_EQ(format_of_suffix("a.vtu"), MeshFormat::vtu);
    EXPECT_EQ(format_of_suffix("a.vtk"), MeshFormat::vtk);
    EXPECT_FALSE(format_of_suffix("a.gz"));
    EXPECT_FALSE(format_of_suffix("a.stl"));
    EXPECT_FALSE(format_of_suffix("msh"));
}

TEST(MeshIo, unusable_files_are_told_apart) {
    const TemporaryFolder folder;
    std::filesystem::create_directory(folder / "folder.msh");
    const auto message = [&](const std::filesystem::path& file) {
        return message_of<InvalidInput>([&] { read_mesh(file); });
    };
    EXPECT_NE(message(folder / "missing.msh").find("missing.msh: there is no such file"), std::string::npos);
    EXPECT_NE(message(folder / "missing.stl").find("no such file"), std::string::npos);
    EXPECT_NE(message(folder / "folder.msh").find("folder"), std::string::npos);
    EXPECT_NE(message(folder.write("a.stl", "x")).find("unknown suffix \".stl\""), std::string::npos);
    for (const char* empty : {"e.msh", "e.vtu", "e.vtk"})
        EXPECT_NE(message(folder.write(empty, "")).find("empty"), std::string::npos) << empty;
    const CurvedMesh mesh = one_element_mesh({Shape::triangle, 1});
    EXPECT_NE(message_of<InvalidInput>([&] { write_mesh(folder / "a.obj", mesh); }).find(".obj"), std::string::npos);
    EXPECT_NE(message_of<InvalidInput>([&] { write_mesh(folder / "no/a.vtu", mesh); }).find("no/a.vtu"),
              std::string::npos);
    EXPECT_NE(message_of<InvalidInput>([&] { write_mesh(folder / "no/a.msh", mesh); }).find("no/a.msh"),
              std::string::npos);
    WriteOptions binary;
    binary.binary = true;
    EXPECT_THROW(write_mesh(folder / "a.msh", mesh, binary), Unsupported);
}

}  // namespace
}  // namespace curvewright
