// Geometry inside the domain: what the file says about it decides, not where nodes lie.

#include <gtest/gtest.h>

#include "core/mesh/mesh_topology.h"
#include "tests/support/mesh_factory.h"
#include "tests/support/region_meshes.h"

namespace curvewright {
namespace {

using namespace testing;

struct Case {
    const char* name;
    CurvedMesh mesh;
    std::size_t facets, nodes;  ///< of the interface at x = 0.5
};

std::vector<Case> cases() {
    return {{"triangles P1", square_mesh(4, 1), 4, 3},
            {"triangles P3", square_mesh(4, 3), 4, 11},
            {"quadrilaterals P2", quad_mesh(4, 2), 4, 7},
            {"quadrilaterals and triangles P2", mixed_square_mesh(4, 2), 4, 7},
            {"tetrahedra P2", cube_mesh(2, 2), 8, 9},
            {"hexahedra P2", hex_mesh(2, 2), 4, 9},
            {"prisms P1", prism_mesh(4, 1), 16, 9},
            {"hexahedra and prisms P3", mixed_cube_mesh(2, 3), 4, 25}};
}

void expect_interface(const CurvedMesh& mesh, std::size_t facets, std::size_t nodes) {
    const MeshTopology& topology = mesh.topology();
    ASSERT_EQ(topology.interface_facets().size(), facets);
    ASSERT_EQ(topology.interface_neighbours().size(), facets);
    EXPECT_EQ(topology.interface_nodes().size(), nodes);
    for (std::size_t f = 0; f < facets; ++f) {
        const Facet facet = topology.interface_facets()[f];
        for (const Index node : topology.facet_nodes(facet)) EXPECT_NEAR(mesh.coordinates()(node, 0), 0.5, 1e-14);
        const Index other = topology.interface_neighbours()[f];
        EXPECT_LT(facet.element, other);
        EXPECT_LT((mesh.element_center(facet.element)[0] - 0.5) * (mesh.element_center(other)[0] - 0.5), 0.0);
    }
    for (const Index node : topology.interface_nodes()) {
        EXPECT_TRUE(topology.is_interior_node(node) && topology.is_interface_node(node));
        EXPECT_NEAR(mesh.coordinates()(node, 0), 0.5, 1e-14);
    }
}

TEST(Interfaces, OneGroupHasNone) {
    for (const Case& one : cases()) {
        SCOPED_TRACE(one.name);
        expect_interface(one.mesh, 0, 0);
    }
}

TEST(Interfaces, DifferentGroupsOnTheTwoSidesMakeOne) {
    for (const Case& one : cases()) {
        SCOPED_TRACE(one.name);
        expect_interface(with_regions(one.mesh, InterfaceCells::none), one.facets, one.nodes);
        expect_interface(with_regions(one.mesh, InterfaceCells::named), one.facets, one.nodes);
    }
}

/// The regions' groups made the same: two entities of one group, as partitions and CAD faces are.
CurvedMesh in_one_group(const CurvedMesh& mesh) {
    MeshData data = mesh.topology().data();
    for (Entity& entity : data.entities)
        if (entity.dimension == mesh.topology().dimension()) entity.physical_tags = {1};
    return {std::make_shared<const MeshTopology>(std::move(data)), mesh.coordinates()};
}

TEST(Interfaces, EntitiesOfOneGroupHaveNoneBetweenThemUnlessTheFileHasCellsThere) {
    for (const Case& one : cases()) {
        SCOPED_TRACE(one.name);
        expect_interface(in_one_group(with_regions(one.mesh, InterfaceCells::none)), 0, 0);
        expect_interface(in_one_group(with_regions(one.mesh, InterfaceCells::unnamed)), one.facets, one.nodes);
    }
}

TEST(Interfaces, NamedPointsAndCurvesInsideAreGeometry) {
    const CurvedMesh square = square_mesh(4, 2);
    const Index inside = node_at(square, 0.25, 0.5), corner = node_at(square, 0.0, 0.0);
    const ElementType point{Shape::vertex, 1};
    EXPECT_EQ(with_named_cell(square, point, {inside}, "probe").topology().interface_nodes(),
              std::vector<Index>{inside});
    EXPECT_TRUE(with_named_cell(square, point, {corner}, "corner").topology().interface_nodes().empty());

    const CurvedMesh cube = cube_mesh(4, 1);
    const Index a = node_at(cube, 0.25, 0.5, 0.5), b = node_at(cube, 0.5, 0.5, 0.5);
    const MeshTopology with_curve = with_named_cell(cube, {Shape::line, 1}, {a, b}, "wire").topology();
    EXPECT_EQ(with_curve.interface_nodes(), (std::vector<Index>{std::min(a, b), std::max(a, b)}));
    EXPECT_TRUE(with_curve.interface_facets().empty());
}

}  // namespace
}  // namespace curvewright
