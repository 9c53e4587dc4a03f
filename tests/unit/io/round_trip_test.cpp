#include "tests/unit/io/io_helpers.h"

namespace curvewright {
namespace {

constexpr Shape shapes[] = {Shape::line,       Shape::triangle, Shape::quadrilateral, Shape::tetrahedron,
                            Shape::hexahedron, Shape::prism,    Shape::pyramid};

int highest_msh_order(Shape shape) {
    return shape == Shape::hexahedron || shape == Shape::prism || shape == Shape::pyramid ? 9 : max_order;
}

struct Format {
    std::string file;
    MeshFormat format;
    std::optional<bool> binary;
};

void round_trip(const CurvedMesh& mesh, const TemporaryFolder& folder, const Format& how, const std::string& what) {
    WriteOptions options;
    options.format = how.format;
    options.binary = how.binary;
    write_mesh(folder / how.file, mesh, options);
    const ReadResult result = read_mesh(folder / how.file);
    EXPECT_EQ(result.format, how.format) << what;
    EXPECT_TRUE(result.notes.empty()) << what << ": " << result.notes.front();
    if (how.format == MeshFormat::msh2)
        expect_same_mesh(mesh, result.mesh, what);
    else
        expect_same_model(mesh, result.mesh, what);
}

TEST(RoundTrip, msh_keeps_every_shape_and_order) {
    const TemporaryFolder folder;
    for (const Shape shape : shapes)
        for (int order = 1; order <= highest_msh_order(shape); ++order) {
            const CurvedMesh mesh = one_element_mesh({shape, order});
            const std::string what = name(ElementType{shape, order});
            round_trip(mesh, folder, {"a.msh", MeshFormat::msh4, {}}, what + " msh4");
            round_trip(mesh, folder, {"b.msh", MeshFormat::msh2, {}}, what + " msh2");
        }
}

TEST(RoundTrip, vtk_formats_keep_every_shape_and_order) {
    const TemporaryFolder folder;
    for (const Shape shape : shapes)
        for (int order = 1; order <= (shape == Shape::pyramid ? 1 : max_order); ++order) {
            const CurvedMesh mesh = one_element_mesh({shape, order});
            const std::string what = name(ElementType{shape, order});
            round_trip(mesh, folder, {"a.vtu", MeshFormat::vtu, {}}, what + " vtu");
            round_trip(mesh, folder, {"b.vtu", MeshFormat::vtu, false}, what + " vtu, text");
            round_trip(mesh, folder, {"a.vtk", MeshFormat::vtk, {}}, what + " vtk");
            round_trip(mesh, folder, {"b.vtk", MeshFormat::vtk, true}, what + " vtk, binary");
        }
}

TEST(RoundTrip, keeps_a_mesh_of_gmsh) {
    const TemporaryFolder folder;
    const CurvedMesh mesh = read_mesh(test_data("annulus.msh")).mesh;
    EXPECT_EQ(mesh.topology().element_count(), 30);
    EXPECT_EQ(mesh.topology().order(), 3);
    round_trip(mesh, folder, {"a.msh", MeshFormat::msh4, {}}, "msh4");
    round_trip(mesh, folder, {"b.msh", MeshFormat::msh2, {}}, "msh2");
    round_trip(mesh, folder, {"a.vtu", MeshFormat::vtu, {}}, "vtu");
    round_trip(mesh, folder, {"a.vtk", MeshFormat::vtk, {}}, "vtk");
}

TEST(RoundTrip, keeps_the_last_digit_of_awkward_numbers) {
    const TemporaryFolder folder;
    CurvedMesh mesh = one_element_mesh({Shape::triangle, 3});
    Coordinates x = mesh.coordinates();
    const double awkward[] = {0.1,      1.0 / 3.0,           -2.0 / 7.0, 1e-300,      5e-324, 1.7976931348623157e308,
                              1e15 + 1, 123456789.123456789, 1e-17,      3.0 - 4e-16, 1e22,   -1.0};
    for (Eigen::Index i = 0; i < x.size(); ++i) x.data()[i] = awkward[i % 12];
    mesh = mesh.with_coordinates(x);
    for (const Format& how : {Format{"a.msh", MeshFormat::msh4, {}}, Format{"b.msh", MeshFormat::msh2, {}},
                              Format{"a.vtu", MeshFormat::vtu, {}}, Format{"a.vtk", MeshFormat::vtk, true}}) {
        WriteOptions options;
        options.format = how.format;
        options.binary = how.binary;
        write_mesh(folder / how.file, mesh, options);
        EXPECT_TRUE(same_bits(mesh.coordinates(), read_mesh(folder / how.file).mesh.coordinates())) << how.file;
    }
}

TEST(RoundTrip, msh4_invents_entities_where_there_are_none_and_then_keeps_them) {
    const TemporaryFolder folder;
    MeshData data = one_element_mesh({Shape::tetrahedron, 2}).topology().data();
    const Coordinates coordinates = one_element_mesh({Shape::tetrahedron, 2}).coordinates();
    for (ElementBlock& block : data.blocks) block.entity_tag = 0;
    data.entities.clear();
    data.groups.clear();
    data.node_entities.clear();
    const CurvedMesh bare(std::make_shared<MeshTopology>(data), coordinates);
    write_mesh(folder / "a.msh", bare);
    const CurvedMesh once = read_mesh(folder / "a.msh").mesh;
    EXPECT_EQ(once.topology().data().node_tags, data.node_tags);
    EXPECT_TRUE(same_bits(once.coordinates(), coordinates));
    EXPECT_EQ(entities_of(once).size(), 3u);  // a point, one for the four triangles, the body
    for (const ElementBlock& block : once.topology().blocks()) EXPECT_NE(block.entity_tag, 0);
    // Each node lies on the lowest-dimensional cell that holds it; a P2 tetrahedron has no other nodes.
    for (std::size_t node = 0; node < data.node_tags.size(); ++node)
        EXPECT_EQ(once.topology().data().node_entities[node].dimension, node == 0 ? 0 : 2);
    round_trip(once, folder, {"b.msh", MeshFormat::msh4, {}}, "second time");
}

TEST(RoundTrip, keeps_the_order_of_nodes_whose_entities_alternate) {
    const TemporaryFolder folder;
    const CurvedMesh mesh = one_element_mesh({Shape::quadrilateral, 4});
    const auto& entities = mesh.topology().data().node_entities;
    int changes = 0;
    for (std::size_t i = 1; i < entities.size(); ++i) changes += entities[i] != entities[i - 1];
    EXPECT_GT(changes, 5);
    round_trip(mesh, folder, {"a.msh", MeshFormat::msh4, {}}, "msh4");
}

TEST(RoundTrip, what_a_format_cannot_hold_is_refused_by_name) {
    const TemporaryFolder folder;
    const auto refusal = [&](ElementType type, const char* file) {
        return message_of<Unsupported>([&] { write_mesh(folder / file, one_element_mesh(type)); });
    };
    EXPECT_NE(refusal({Shape::hexahedron, 10}, "a.msh").find("P10 hexahedron"), std::string::npos);
    EXPECT_NE(refusal({Shape::pyramid, 2}, "a.vtu").find("P2 pyramid"), std::string::npos);
    MeshData data = one_element_mesh({Shape::triangle, 1}).topology().data();
    data.groups.front().name = "a \"quoted\" name";
    const CurvedMesh quoted(std::make_shared<MeshTopology>(data), one_element_mesh({Shape::triangle, 1}).coordinates());
    EXPECT_NE(message_of<Unsupported>([&] { write_mesh(folder / "a.msh", quoted); }).find("quotation mark"),
              std::string::npos);
    EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

TEST(RoundTrip, boxes_follow_the_nodes_that_leave_them) {
    const TemporaryFolder folder;
    const CurvedMesh mesh = read_mesh(test_data("annulus.msh")).mesh;
    const CurvedMesh moved = mesh.with_coordinates(mesh.coordinates().array() + 5.0);
    write_mesh(folder / "a.msh", moved);
    const auto entities = entities_of(read_mesh(folder / "a.msh").mesh);
    EXPECT_NEAR(std::get<1>(entities.at({2, 1}))[0], 4.0, 1e-12);
    EXPECT_NEAR(std::get<1>(entities.at({2, 1}))[3], 6.0, 1e-12);
}

}  // namespace
}  // namespace curvewright
