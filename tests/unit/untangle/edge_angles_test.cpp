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

/// Positions of an edge's nodes: x, y of each in turn.
Eigen::VectorXd edge_positions(const CurvedMesh& mesh, const InteriorEdge& edge) {
    Eigen::VectorXd result(2 * static_cast<Eigen::Index>(edge.nodes.size()));
    for (std::size_t i = 0; i < edge.nodes.size(); ++i)
        result.segment<2>(static_cast<Eigen::Index>(2 * i)) = mesh.coordinates().row(edge.nodes[i]).head<2>();
    return result;
}

TEST(UnsignedAngleSum, AddsTheMagnitudesOfTheSignedAngles) {
    std::mt19937 random(3);
    for (const int order : {2, 3, 4, 7}) {
        const CurvedMesh mesh = shaken(square_mesh(4, order), 0.15 / order, random);  // some angles are negative
        bool has_negative = false;
        for (const InteriorEdge& edge : find_interior_edges(mesh.topology())) {
            const UnsignedAngleSum sum(mesh.topology(), mesh.coordinates(), edge);
            const EdgeNode first{edge.nodes[0], edge.triangles, edge.local_edges, 2};
            const auto signed_angles = EdgeAngles(mesh.topology(), mesh.coordinates(), first, 1.0)
                                           .evaluate(mesh.coordinates().row(edge.nodes[0]).head<2>().transpose());
            const Eigen::VectorXd positions = edge_positions(mesh, edge);
            const auto angles = sum.angles(positions);
            for (int i = 0; i < 4; ++i) {
                EXPECT_NEAR(angles[i], std::abs(signed_angles[i]), 1e-7);
                has_negative |= signed_angles[i] < 0.0;
            }
            EXPECT_DOUBLE_EQ(sum.evaluate(positions), angles[0] + angles[1] + angles[2] + angles[3]);
        }
        EXPECT_TRUE(has_negative) << "P" << order;
    }
}

TEST(UnsignedAngleSum, TheExactGradientAgreesWithTheDifferences) {
    std::mt19937 random(4);
    int compared = 0, nonzero = 0;
    for (const int order : {2, 3, 5}) {
        const CurvedMesh mesh = shaken(square_mesh(4, order), 0.15 / order, random);
        for (const InteriorEdge& edge : find_interior_edges(mesh.topology())) {
            const UnsignedAngleSum sum(mesh.topology(), mesh.coordinates(), edge);
            const Eigen::VectorXd positions = edge_positions(mesh, edge);
            const auto angles = sum.angles(positions);
            // The differences straddle a kink where an angle is nearly 0 or pi.
            if (std::any_of(angles.begin(), angles.end(),
                            [](double a) { return std::min(a, std::numbers::pi - a) < 0.02; }))
                continue;
            Eigen::VectorXd gradient;
            EXPECT_EQ(sum.evaluate(positions, gradient), sum.evaluate(positions));
            const Eigen::VectorXd differences = sum.difference_gradient(positions, 1e-6 * sum.edge_length());
            EXPECT_LT((gradient - differences).norm() * sum.edge_length(), 1e-7 * (1.0 + gradient.norm()));
            ++compared;
            nonzero += gradient.norm() > 0.0 ? 1 : 0;
        }
    }
    EXPECT_GT(compared, 80);
    EXPECT_GT(nonzero, 10);
}

TEST(InteriorEdges, HaveTheirNodesInTheOrderOfTheirFirstTriangle) {
    const CurvedMesh mesh = square_mesh(3, 4);
    const auto edges = find_interior_edges(mesh.topology());
    ASSERT_EQ(edges.size(), 33u - 12u);
    for (const InteriorEdge& edge : edges) {
        ASSERT_EQ(edge.nodes.size(), 3u);
        EXPECT_LT(edge.triangles[0], edge.triangles[1]);
        const auto nodes = mesh.topology().element_nodes(edge.triangles[0]);
        const int local = edge.local_edges[0];
        const Eigen::RowVector3d start = mesh.coordinates().row(nodes[local]);
        double last = 0.0;
        for (const Index node : edge.nodes) {
            const double distance = (mesh.coordinates().row(node) - start).norm();
            EXPECT_GT(distance, last);
            last = distance;
        }
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
