#include "core/untangle/edge_angles.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "core/basis/lagrange.h"
#include "core/quality/quality.h"
#include "tests/support/mesh_factory.h"

namespace curvewright {
namespace {

using testing::shaken;
using testing::square_mesh;

/// The signed angle at corner `corner` of a triangle, from the element map itself: the edges' tangents there are
/// columns (or differences) of the Jacobian. Independent of EdgeAngles' one-dimensional shape functions.
double corner_angle(const CurvedMesh& mesh, Index triangle, int corner) {
    Eigen::MatrixX3d point = Eigen::MatrixX3d::Zero(1, 3);
    if (corner > 0) point(0, corner - 1) = 1.0;
    const BasisTable basis = lagrange_basis(mesh.topology().element_type(triangle), point);
    const Eigen::MatrixX3d x = mesh.element_coordinates(triangle);
    const Eigen::Vector2d u = (basis.gradients[0] * x).row(0).head<2>(), v = (basis.gradients[1] * x).row(0).head<2>();
    const std::array<Eigen::Vector2d, 3> next{u, v - u, -v}, previous{v, -u, u - v};
    const Eigen::Vector2d a = next[corner].normalized(), b = previous[corner].normalized();
    return std::atan2(a[0] * b[1] - a[1] * b[0], a.dot(b));
}

TEST(EdgeAngles, AgreeWithTheElementMapAtTheCorners) {
    std::mt19937 random(1);
    for (const int order : {2, 3, 5}) {
        const CurvedMesh mesh = shaken(square_mesh(4, order), 0.06 / order, random);
        const auto edge_nodes = find_interior_edge_nodes(mesh.topology());
        ASSERT_FALSE(edge_nodes.empty());
        for (const EdgeNode& edge_node : edge_nodes) {
            const EdgeAngles angles(mesh.topology(), mesh.coordinates(), edge_node, 1.0);
            const auto actual = angles.evaluate(mesh.coordinates().row(edge_node.node).head<2>().transpose());
            std::array<double, 4> expected{};
            const auto first = mesh.topology().element_nodes(edge_node.triangles[0]);
            const Index start = first[edge_node.local_edges[0]];
            for (int side = 0; side < 2; ++side) {
                const Index triangle = edge_node.triangles[side];
                const int edge = edge_node.local_edges[side];
                const bool is_reversed = mesh.topology().element_nodes(triangle)[edge] != start;
                const int at_start = is_reversed ? (edge + 1) % 3 : edge, at_end = is_reversed ? edge : (edge + 1) % 3;
                expected[2 * side] = corner_angle(mesh, triangle, at_start);
                expected[2 * side + 1] = corner_angle(mesh, triangle, at_end);
            }
            for (int i = 0; i < 4; ++i) EXPECT_NEAR(actual[i], expected[i], 1e-7);
        }
    }
}

TEST(EdgeAngles, AreTheSameForTheMirroredNumbering) {
    std::mt19937 random(2);
    const CurvedMesh mesh = shaken(square_mesh(3, 3), 0.03, random), clockwise = flip_orientation(mesh);
    const auto a = find_interior_edge_nodes(mesh.topology()), b = find_interior_edge_nodes(clockwise.topology());
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t i = 0; i < a.size(); ++i) {
        const Eigen::Vector2d at = mesh.coordinates().row(a[i].node).head<2>();
        auto angles = EdgeAngles(mesh.topology(), mesh.coordinates(), a[i], 1.0).evaluate(at);
        auto mirrored = EdgeAngles(clockwise.topology(), mesh.coordinates(), b[i], -1.0).evaluate(at);
        std::sort(angles.begin(), angles.end());
        std::sort(mirrored.begin(), mirrored.end());
        for (int k = 0; k < 4; ++k) EXPECT_NEAR(angles[k], mirrored[k], 1e-12);
    }
}

TEST(InteriorEdgeNodes, AreThoseOfEdgesWithTwoTriangles) {
    for (const int order : {2, 3, 4}) {
        const CurvedMesh mesh = square_mesh(3, order);
        // 3 n^2 + 2 n edges in all, 4 n of them on the boundary.
        EXPECT_EQ(find_interior_edge_nodes(mesh.topology()).size(), static_cast<std::size_t>((33 - 12) * (order - 1)));
    }
}

}  // namespace
}  // namespace curvewright
