#include "core/untangle/signed_angle_patch.h"

#include <algorithm>
#include <random>

#include <gtest/gtest.h>

#include "tests/support/mesh_factory.h"

namespace curvewright {
namespace {

using testing::square_mesh;

bool share_a_triangle(const EdgeNode& a, const EdgeNode& b) {
    return std::find_first_of(a.triangles.begin(), a.triangles.end(), b.triangles.begin(), b.triangles.end()) !=
           a.triangles.end();
}

TEST(BatchInOrder, KeepsTheOrderOfNodesThatShareATriangle) {
    const CurvedMesh mesh = square_mesh(4, 3);
    std::vector<EdgeNode> nodes = find_interior_edge_nodes(mesh.topology());
    std::mt19937 random(1);
    for (int round = 0; round < 5; ++round) {
        std::shuffle(nodes.begin(), nodes.end(), random);
        const auto batches = batch_in_order(nodes, mesh.topology().element_count());
        std::vector<int> batch_of(nodes.size(), -1);
        for (std::size_t b = 0; b < batches.size(); ++b)
            for (const std::size_t i : batches[b]) {
                EXPECT_EQ(batch_of[i], -1) << "listed twice";
                batch_of[i] = static_cast<int>(b);
            }
        for (std::size_t i = 0; i < nodes.size(); ++i) {
            EXPECT_GE(batch_of[i], 0);
            for (std::size_t j = 0; j < i; ++j)
                if (share_a_triangle(nodes[i], nodes[j])) {
                    EXPECT_LT(batch_of[j], batch_of[i]);
                }
        }
        EXPECT_LT(batches.size(), nodes.size() / 3);  // there is something to do at the same time
    }
}

TEST(ColourEdges, EdgesOfOneColourShareNoTriangle) {
    for (const int order : {2, 4}) {
        const CurvedMesh mesh = square_mesh(5, order);
        const auto edges = group_by_edge(find_interior_edge_nodes(mesh.topology()));
        ASSERT_EQ(edges.size(), std::size_t(3 * 25 + 2 * 5 - 20));  // all but the boundary's
        for (const EdgeNodes& edge : edges) {
            ASSERT_EQ(edge.size(), std::size_t(order - 1));
            for (int i = 0; i < order - 1; ++i) {
                EXPECT_EQ(edge[i].position, i + 2);
                EXPECT_EQ(edge[i].triangles, edge[0].triangles);
                EXPECT_EQ(edge[i].local_edges, edge[0].local_edges);
            }
        }
        const auto colours = colour_edges(edges, mesh.topology().element_count());
        EXPECT_LE(colours.size(), 5u);
        std::vector<int> uses(edges.size(), 0);
        for (const auto& colour : colours)
            for (const std::size_t i : colour) {
                ++uses[i];
                for (const std::size_t j : colour) EXPECT_TRUE(i == j || !share_a_triangle(edges[i][0], edges[j][0]));
            }
        EXPECT_EQ(std::count(uses.begin(), uses.end(), 1), std::ptrdiff_t(edges.size()));
    }
}

TEST(AssessPatch, SoftMinimumSeesOneOfTwoBadCornersMended) {
    // One triangle's two lower corners are tangled alike by its bulging bottom; one of its other edges gives way.
    const CurvedMesh mesh = square_mesh(1, 2);
    const auto nodes = find_interior_edge_nodes(mesh.topology());
    ASSERT_EQ(nodes.size(), 1u);
    JacobianBounds bounds({Shape::triangle, 2});
    const PatchQuality straight = assess_patch(mesh.topology(), mesh.coordinates(), nodes[0], 1.0, bounds);
    EXPECT_EQ(straight.not_valid, 0);
    EXPECT_NEAR(straight.minimum, 1.0, 1e-12);
    EXPECT_NEAR(straight.soft_minimum, 1.0, 1e-12);

    const auto bottom = mesh.topology().find_group_nodes("bottom").value();
    const auto assess = [&](double height, double give) {
        Coordinates x = mesh.coordinates();
        for (const Index node : bottom)
            if (x(node, 0) == 0.5) x(node, 1) = height;
        x.row(nodes[0].node) += Eigen::RowVector3d(-give, give, 0.0);
        return assess_patch(mesh.topology(), x, nodes[0], 1.0, bounds);
    };
    const PatchQuality tangled = assess(0.45, 0.0);
    EXPECT_EQ(tangled.not_valid, 1);
    EXPECT_LT(tangled.minimum, 0.0);
    EXPECT_LE(tangled.soft_minimum, 0.0);
    EXPECT_GT(assess(0.45, 0.05).soft_minimum, tangled.soft_minimum);
}

TEST(MinimiseSignedAngles, AnEdgeOfNoLengthStays) {
    const CurvedMesh mesh = square_mesh(1, 2);
    const auto nodes = find_interior_edge_nodes(mesh.topology());
    const EdgeAngles angles(mesh.topology(), mesh.coordinates(), nodes[0], 1.0);
    const Eigen::Vector2d initial(0.25, 0.75);
    EXPECT_EQ(minimise_signed_angles(angles, initial, 0.0, 0.5, {}, nullptr, 0).position, initial);
}

}  // namespace
}  // namespace curvewright
