#include "core/mesh/mesh_topology.h"

#include <functional>

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "tests/support/mesh_factory.h"

namespace curvewright {
namespace {

using testing::cube_mesh;
using testing::square_mesh;

TEST(MeshTopology, CountsOfASquare) {
    const CurvedMesh mesh = square_mesh(4, 3);
    const MeshTopology& topology = mesh.topology();
    EXPECT_EQ(topology.dimension(), 2);
    EXPECT_EQ(topology.order(), 3);
    EXPECT_EQ(topology.element_count(), 32);
    EXPECT_EQ(topology.node_count(), 13 * 13);
    EXPECT_EQ(topology.boundary_facets().size(), 16u);
    EXPECT_EQ(topology.boundary_nodes().size(), 48u);
    EXPECT_EQ(topology.interior_nodes().size(), 11u * 11u);
    EXPECT_EQ(topology.uniform_type(), (ElementType{Shape::triangle, 3}));
    for (Index node : topology.boundary_nodes()) {
        const auto x = mesh.coordinates().row(node);
        EXPECT_TRUE(x[0] == 0 || x[0] == 1 || x[1] == 0 || x[1] == 1);
    }
}

TEST(MeshTopology, CountsOfACube) {
    const CurvedMesh mesh = cube_mesh(2, 2);
    const MeshTopology& topology = mesh.topology();
    EXPECT_EQ(topology.element_count(), 48);
    EXPECT_EQ(topology.node_count(), 125);
    EXPECT_EQ(topology.boundary_facets().size(), 48u);
    EXPECT_EQ(topology.interior_nodes().size(), 27u);
}

TEST(MeshTopology, GroupsGiveTheNodesOfTheirCells) {
    const CurvedMesh mesh = square_mesh(3, 2);
    const auto left = mesh.topology().find_group_nodes("left");
    ASSERT_TRUE(left);
    EXPECT_EQ(left->size(), 7u);
    for (Index node : *left) EXPECT_EQ(mesh.coordinates()(node, 0), 0.0);
    EXPECT_EQ(mesh.topology().find_group_nodes("domain")->size(), 49u);
    EXPECT_EQ(*mesh.topology().find_group_nodes("boundary"), mesh.topology().boundary_nodes());
    EXPECT_EQ(*mesh.topology().find_group_nodes("all_boundary"), mesh.topology().boundary_nodes());
    EXPECT_EQ(mesh.topology().find_group_nodes("all")->size(), 49u);
    EXPECT_FALSE(mesh.topology().find_group_nodes("nowhere"));
}

TEST(MeshTopology, TagsLeadBackToPositions) {
    const CurvedMesh mesh = square_mesh(2, 3);
    const MeshTopology& topology = mesh.topology();
    for (Index node = 0; node < topology.node_count(); ++node)
        EXPECT_EQ(topology.find_node(topology.node_tag(node)), node);
    for (Index element = 0; element < topology.element_count(); ++element)
        EXPECT_EQ(topology.find_element(topology.element_tag(element)), element);
    EXPECT_FALSE(topology.find_node({-5}));
    EXPECT_FALSE(topology.find_element({-5}));
}

TEST(MeshTopology, BoundaryFacetsOfMixedShapesMeet) {
    // A square and a triangle that share a side.
    MeshData data;
    for (int i = 1; i <= 5; ++i) data.node_tags.push_back({i});
    data.blocks.push_back({{Shape::quadrilateral, 1}, 0, {0, 1, 2, 3}, {{1}}});
    data.blocks.push_back({{Shape::triangle, 1}, 0, {1, 4, 2}, {{2}}});
    const MeshTopology topology(data);
    EXPECT_EQ(topology.boundary_facets().size(), 5u);
    EXPECT_FALSE(topology.uniform_type());
}

TEST(MeshTopology, FacetsThatShareOnlyTheirCornersAreBoundary) {
    // Two P2 triangles on the same two corners, each with a middle node of its own there.
    MeshData data;
    for (int i = 1; i <= 10; ++i) data.node_tags.push_back({i});
    data.blocks.push_back({{Shape::triangle, 2}, 0, {0, 1, 2, 4, 5, 6, 1, 3, 2, 7, 8, 9}, {{1}, {2}}});
    const MeshTopology cracked(data);
    EXPECT_EQ(cracked.boundary_facets().size(), 6u);
    EXPECT_TRUE(cracked.interior_nodes().empty());
    data.blocks[0].nodes.back() = 5;
    data.node_tags.pop_back();
    EXPECT_EQ(MeshTopology(data).boundary_facets().size(), 4u);
}

TEST(MeshTopology, RefusesInconsistentData) {
    const MeshData good = square_mesh(1, 1).topology().data();
    const auto message = [&](const std::function<void(MeshData&)>& damage) -> std::string {
        MeshData data = good;
        damage(data);
        try {
            MeshTopology topology(data);
        } catch (const Error& error) {
            return error.what();
        }
        return "accepted";
    };
    EXPECT_EQ(message([](MeshData&) {}), "accepted");
    EXPECT_EQ(message([](MeshData& d) { d.node_tags[1] = d.node_tags[0]; }),
              "Node 11 occurs twice; node tags must be unique.");
    const std::size_t last = good.blocks.size() - 1;
    EXPECT_EQ(message([&](MeshData& d) { d.blocks[last].nodes[0] = 99; }),
              "Element " + std::to_string(good.blocks[last].tags[0].value) + " refers to a node that does not exist.");
    EXPECT_NE(message([&](MeshData& d) { d.blocks[last].nodes[1] = d.blocks[last].nodes[0]; }).find("twice; its nodes"),
              std::string::npos);
    EXPECT_NE(message([&](MeshData& d) { d.blocks[last].tags[1] = d.blocks[last].tags[0]; }).find("element tags"),
              std::string::npos);
    EXPECT_NE(message([&](MeshData& d) { d.blocks[last].nodes.pop_back(); }).find("instead of"), std::string::npos);
    EXPECT_NE(message([&](MeshData& d) { d.blocks[last].type.order = 11; }).find("orders 1 to 10"), std::string::npos);
    EXPECT_NE(message([](MeshData& d) { d.entities.push_back(d.entities[0]); }).find("occurs twice"),
              std::string::npos);
}

TEST(CurvedMesh, ChecksItsCoordinates) {
    const CurvedMesh mesh = square_mesh(1, 1);
    EXPECT_THROW(mesh.with_coordinates(Coordinates::Zero(3, 3)), InvalidInput);
    Coordinates x = mesh.coordinates();
    x(2, 1) = std::numeric_limits<double>::quiet_NaN();
    try {
        mesh.with_coordinates(x);
        FAIL();
    } catch (const InvalidInput& error) {
        EXPECT_STREQ(error.what(), "Node 13 has a coordinate that is not finite.");
    }
}

}  // namespace
}  // namespace curvewright
