#include "core/mesh/conformity.h"

#include <cmath>
#include <numbers>
#include <set>

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/mesh/coincident_nodes.h"
#include "core/mesh/elevate.h"
#include "tests/support/mesh_factory.h"
#include "tests/unit/mesh/torn_meshes.h"

namespace curvewright {
namespace {

using testing::Cell;
using testing::mesh_of_cells;

std::set<std::int64_t> hanging_tags(const CurvedMesh& mesh) {
    std::set<std::int64_t> tags;
    for (const HangingNode& node : find_nonconformity(mesh).hanging)
        tags.insert(mesh.topology().node_tag(node.node).value);
    return tags;
}

/// A smooth map that bends everything.
CurvedMesh bent(const CurvedMesh& mesh) {
    Coordinates x = mesh.coordinates();
    for (Eigen::Index i = 0; i < x.rows(); ++i) {
        const Eigen::RowVector3d p = x.row(i);
        x(i, 0) = p[0] + 0.15 * std::sin(2 * p[1]) + 0.1 * p[2];
        x(i, 1) = p[1] + 0.2 * p[0] * p[0] - 0.1 * p[2] * p[2];
    }
    return mesh.with_coordinates(x);
}

TEST(Conformity, MatchingMeshesOfEveryShapeAndOrderConform) {
    for (int order = 1; order <= 4; ++order) {
        const std::vector<CurvedMesh> meshes = {testing::square_mesh(4, order),       testing::quad_mesh(4, order),
                                                testing::mixed_square_mesh(4, order), testing::cube_mesh(2, order),
                                                testing::hex_mesh(2, order),          testing::prism_mesh(2, order),
                                                testing::mixed_cube_mesh(2, order)};
        for (const CurvedMesh& mesh : meshes)
            for (const CurvedMesh& state : {mesh, bent(mesh)}) {
                EXPECT_TRUE(find_nonconformity(state).conforms());
                EXPECT_NO_THROW(require_conforming(state));
                // Cells of their own points touch everywhere, node for node.
                EXPECT_TRUE(find_nonconformity(testing::with_own_points(state)).conforms());
            }
    }
    EXPECT_TRUE(find_nonconformity(testing::pyramid_mesh(2)).conforms());
    EXPECT_TRUE(find_nonconformity(mesh_of_cells({{0, 0, 0}}, {})).conforms());
}

TEST(Conformity, SlitsConform) {
    for (int order = 1; order <= 4; ++order) {
        const auto on_half = [](const Eigen::RowVector3d& p) { return std::abs(p[0] - 0.5) < 1e-12 && p[1] < 0.49; };
        const auto behind = [](const Eigen::RowVector3d& p) { return p[0] > 0.5; };
        for (const CurvedMesh& mesh : {testing::square_mesh(4, order), testing::cube_mesh(2, order)}) {
            const CurvedMesh slit = testing::with_slit(mesh, on_half, behind);
            ASSERT_GT(slit.topology().node_count(), mesh.topology().node_count());
            EXPECT_TRUE(find_nonconformity(slit).conforms());
            EXPECT_TRUE(find_nonconformity(bent(slit)).conforms());
        }
    }
}

TEST(Conformity, FindsTheHangingNodeOfAnEdge) {
    const CurvedMesh mesh = testing::hanging_square();
    const Nonconformity found = find_nonconformity(mesh);
    ASSERT_EQ(found.hanging.size(), 1u);
    EXPECT_EQ(mesh.topology().node_tag(found.hanging[0].node).value, 6);
    EXPECT_EQ(mesh.topology().element_tag(found.hanging[0].facet.element).value, 1);
    EXPECT_TRUE(found.hanging[0].is_on_edge);
    EXPECT_EQ(describe(found, mesh.topology()), "Node 6 hangs on an edge of element 1");
    EXPECT_THROW(require_conforming(mesh), Unsupported);
}

TEST(Conformity, FindsHangingNodesOfHighOrderOnCurvedEdges) {
    for (int order = 2; order <= 4; ++order) {
        const CurvedMesh straight = elevate(testing::hanging_square(), order);
        Coordinates x = straight.coordinates();
        // Of second degree along the common edge, where both sides hold it exactly.
        for (Eigen::Index i = 0; i < x.rows(); ++i) x(i, 0) += 0.4 * x(i, 1) * x(i, 1);
        for (const CurvedMesh& mesh : {straight, straight.with_coordinates(x)}) {
            std::set<std::int64_t> expected;
            const MeshTopology& topology = mesh.topology();
            std::set<Index> left(topology.element_nodes(0).begin(), topology.element_nodes(0).end());
            for (Index node = 0; node < topology.node_count(); ++node) {
                const auto p = straight.coordinates().row(node);
                // With nodes of the large edge at the same place a node does not hang.
                const double t = p[1] * order;
                if (p[0] == 1.0 && !left.contains(node) && std::abs(t - std::round(t)) > 1e-9)
                    expected.insert(topology.node_tag(node).value);
            }
            ASSERT_FALSE(expected.empty());
            EXPECT_EQ(hanging_tags(mesh), expected) << order;
        }
    }
}

TEST(Conformity, FindsHangingNodesOfFaces) {
    const CurvedMesh mesh = testing::hanging_cubes();
    // The middles of the large face and of its edges.
    std::set<std::int64_t> expected;
    for (Index node = 0; node < mesh.topology().node_count(); ++node) {
        const auto p = mesh.coordinates().row(node);
        if (p[0] == 0.0 && (p[1] == 1.0 || p[2] == 1.0)) expected.insert(mesh.topology().node_tag(node).value);
    }
    ASSERT_EQ(expected.size(), 5u);
    EXPECT_EQ(hanging_tags(mesh), expected);
    int inside = 0;
    for (const HangingNode& node : find_nonconformity(mesh).hanging) inside += node.is_on_edge ? 0 : 1;
    EXPECT_EQ(inside, 1);
    EXPECT_FALSE(find_nonconformity(elevate(mesh, 3)).conforms());

    // Four tetrahedra on one: the middle of an edge of the base.
    const CurvedMesh tetrahedra = mesh_of_cells({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {.5, .5, 0}, {0, 0, -1}},
                                                {{{Shape::tetrahedron, 1}, {0, 1, 2, 3}},
                                                 {{Shape::tetrahedron, 1}, {0, 4, 1, 5}},
                                                 {{Shape::tetrahedron, 1}, {0, 2, 4, 5}}});
    EXPECT_EQ(hanging_tags(tetrahedra), std::set<std::int64_t>{5});
}

TEST(Conformity, FindsNeighboursOfOtherOrders) {
    // P2 beside P1; the node in the middle of their edge is not one that hangs.
    const CurvedMesh mesh = mesh_of_cells(
        {{0, 0, 0},
         {1, 0, 0},
         {1, 1, 0},
         {0, 1, 0},
         {.5, 0, 0},
         {1, .5, 0},
         {.5, 1, 0},
         {0, .5, 0},
         {.5, .5, 0},
         {2, 0, 0},
         {2, 1, 0}},
        {{{Shape::quadrilateral, 2}, {0, 1, 2, 3, 4, 5, 6, 7, 8}}, {{Shape::quadrilateral, 1}, {1, 9, 10, 2}}});
    const Nonconformity found = find_nonconformity(mesh);
    EXPECT_TRUE(found.hanging.empty());
    ASSERT_EQ(found.unlike.size(), 1u);
    EXPECT_EQ(describe(found, mesh.topology()),
              "Element 1 (P2 quadrilateral) and its neighbour 2 (P1 quadrilateral) have other nodes than each other on "
              "their common edge");
    // Two tetrahedra.
    const CurvedMesh two = mesh_of_cells(
        {{0, 0, 0},
         {1, 0, 0},
         {0, 1, 0},
         {0, 0, 1},
         {.5, 0, 0},
         {.5, .5, 0},
         {0, .5, 0},
         {0, 0, .5},
         {.5, 0, .5},
         {0, .5, .5},
         {0, 0, -1}},
        {{{Shape::tetrahedron, 2}, {0, 1, 2, 3, 4, 5, 6, 7, 8, 9}}, {{Shape::tetrahedron, 1}, {0, 2, 1, 10}}});
    EXPECT_EQ(find_nonconformity(two).unlike.size(), 1u);
    EXPECT_THROW(require_conforming(two), Unsupported);
}

TEST(Conformity, FindsQuadrilateralsBesideTriangles) {
    const CurvedMesh mesh = mesh_of_cells(
        {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}, {2, .5, .5}},
        {{{Shape::hexahedron, 1}, {0, 1, 2, 3, 4, 5, 6, 7}},
         {{Shape::tetrahedron, 1}, {1, 2, 6, 8}},
         {{Shape::tetrahedron, 1}, {1, 6, 5, 8}}});
    const Nonconformity found = find_nonconformity(mesh);
    EXPECT_EQ(found.unlike.size(), 2u);
    EXPECT_TRUE(found.hanging.empty());
}

TEST(Conformity, BoundariesThatTouchAtAPointConform) {
    // The corner of a triangle on the middle of a square's side, and two squares that share half a side's corner.
    const CurvedMesh corner =
        mesh_of_cells({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {.5, 1, 0}, {1, 2, 0}, {0, 2, 0}},
                      {{{Shape::quadrilateral, 1}, {0, 1, 2, 3}}, {{Shape::triangle, 1}, {4, 5, 6}}});
    EXPECT_TRUE(find_nonconformity(corner).conforms());
}

TEST(Conformity, BodiesThatTouchAreToldAndConform) {
    // Parts of an assembly, halves and thirds of a side, and a cube on four: no node in common.
    const CurvedMesh squares =
        mesh_of_cells({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {1, -.5, 0}, {2, 0, 0}, {2, .5, 0}, {1, .5, 0}},
                      {{{Shape::quadrilateral, 1}, {0, 1, 2, 3}}, {{Shape::quadrilateral, 1}, {4, 5, 6, 7}}});
    for (const CurvedMesh& mesh : {squares, testing::with_own_points(testing::hanging_square()),
                                   testing::with_own_points(testing::hanging_cubes())}) {
        const Nonconformity found = find_nonconformity(mesh);
        EXPECT_TRUE(found.hanging.empty());
        EXPECT_FALSE(found.touching.empty());
        EXPECT_NO_THROW(require_conforming(mesh));
    }
    // As soon as nodes at one place are one, the others hang.
    for (const CurvedMesh& whole : {testing::hanging_square(), testing::hanging_cubes()}) {
        const CurvedMesh torn = testing::with_own_points(whole);
        const CurvedMesh merged = merge_nodes(torn, find_coincident_nodes(torn)).mesh;
        EXPECT_EQ(find_nonconformity(merged).hanging.size(), find_nonconformity(whole).hanging.size());
        EXPECT_TRUE(find_nonconformity(merged).touching.empty());
    }
}

TEST(Conformity, LayersThatLieOnEachOtherConform) {
    // Two squares at one place, as in a mesh that is wrapped twice: their sides do not face each other.
    const CurvedMesh twice =
        mesh_of_cells({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {.5, 0, 0}, {1.5, 0, 0}, {1.5, 1, 0}, {.5, 1, 0}},
                      {{{Shape::quadrilateral, 1}, {0, 1, 2, 3}}, {{Shape::quadrilateral, 1}, {4, 5, 6, 7}}});
    EXPECT_TRUE(find_nonconformity(twice).conforms());
}

}  // namespace
}  // namespace curvewright
