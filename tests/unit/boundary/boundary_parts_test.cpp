#include "core/boundary/boundary_parts.h"

#include <cmath>
#include <numbers>
#include <set>

#include <gtest/gtest.h>

#include "core/quality/quality.h"
#include "tests/support/mesh_factory.h"

namespace curvewright {
namespace {

using namespace curvewright::testing;

Index node_at(const CurvedMesh& mesh, const Eigen::RowVector3d& place) {
    Index best = 0;
    for (Index node = 0; node < mesh.topology().node_count(); ++node)
        if ((mesh.coordinates().row(node) - place).norm() < (mesh.coordinates().row(best) - place).norm()) best = node;
    EXPECT_LT((mesh.coordinates().row(best) - place).norm(), 1e-9);
    return best;
}

TEST(BoundaryParts, SquareHasFourSidesInOnePiece) {
    const CurvedMesh mesh = square_mesh(4, 3);
    const BoundaryParts parts(mesh);
    EXPECT_EQ(parts.component_count(), 1);
    EXPECT_EQ(parts.smooth_part_count(), 4);
    const std::vector<Index> right = parts.smooth_nodes_around(node_at(mesh, {1.0, 0.5, 0.0}));
    EXPECT_EQ(right, mesh.topology().find_group_nodes("right"));
    EXPECT_EQ(parts.component_nodes_around(right.front()), mesh.topology().boundary_nodes());
    // A corner belongs to two sides.
    const auto two = parts.smooth_nodes_around(node_at(mesh, {1.0, 1.0, 0.0}));
    EXPECT_EQ(two.size(), 2 * right.size() - 1);
}

TEST(BoundaryParts, CubeHasSixFaces) {
    for (const CurvedMesh& mesh : {cube_mesh(3, 2), hex_mesh(3, 2), prism_mesh(2, 3)}) {
        const BoundaryParts parts(mesh);
        EXPECT_EQ(parts.component_count(), 1);
        EXPECT_EQ(parts.smooth_part_count(), 6);
        const auto top = parts.smooth_nodes_around(node_at(mesh, {0.5, 0.5, 1.0}));
        for (Index node : top) EXPECT_DOUBLE_EQ(mesh.coordinates()(node, 2), 1.0);
    }
}

TEST(BoundaryParts, EdgesOfACubeAreTwelveFeatureLines) {
    for (const int order : {1, 3}) {
        const CurvedMesh mesh = cube_mesh(2, order);
        const BoundaryParts parts(mesh);
        const auto sides = [&](Index node) {
            int count = 0;
            for (int d = 0; d < 3; ++d) {
                const double x = mesh.coordinates()(node, d);
                count += x == 0.0 || x == 1.0;
            }
            return count;
        };
        for (const Index node : mesh.topology().boundary_nodes()) {
            const auto line = parts.feature_line_nodes_around(node);
            const std::size_t on_one = static_cast<std::size_t>(2 * order + 1);
            // Inside a face none, on an edge that edge, in a corner the three that meet there.
            EXPECT_EQ(line.size(), sides(node) == 1 ? 0u : sides(node) == 2 ? on_one : 3 * on_one - 2);
            for (const Index other : line) EXPECT_GE(sides(other), 2);
        }
        for (const Index node : mesh.topology().interior_nodes())
            EXPECT_TRUE(parts.feature_line_nodes_around(node).empty());
    }
    const CurvedMesh square = square_mesh(2, 2);
    EXPECT_TRUE(BoundaryParts(square).feature_line_nodes_around(square.topology().boundary_nodes().front()).empty());
}

TEST(BoundaryParts, TheFeatureAngleDecides) {
    // The square's right side bent outward to a circular arc of 60 degrees against its neighbours: 90 - 60 = 30 or less
    // is left of two of its corners.
    CurvedMesh mesh = square_mesh(6, 2);
    Coordinates x = mesh.coordinates();
    for (Index node = 0; node < x.rows(); ++node) {
        const double y = 2.0 * x(node, 1) - 1.0;
        x(node, 0) += x(node, 0) * 0.9 * (1.0 - y * y);
    }
    mesh = mesh.with_coordinates(x);
    // slope of the arc at its ends: dx/dy = 0.9 · 4 = 3.6 (discretely a little less): turns by about 16 degrees there
    EXPECT_EQ(BoundaryParts(mesh, 40.0).smooth_part_count(), 2);
    EXPECT_EQ(BoundaryParts(mesh, 5.0).smooth_part_count(), 4);
}

TEST(BoundaryParts, SeparateBoundariesAreComponents) {
    // A ring: the square's middle elements taken out.
    const CurvedMesh full = quad_mesh(3, 2);
    MeshData data = full.topology().data();
    for (ElementBlock& block : data.blocks)
        if (block.type.shape == Shape::quadrilateral) {
            ElementBlock kept{block.type, block.entity_tag, {}, {}};
            const auto size = static_cast<std::size_t>(node_count(block.type));
            for (Index i = 0; i < block.size(); ++i) {
                const auto first = block.nodes.begin() + static_cast<std::ptrdiff_t>(size) * i;
                Eigen::RowVector3d center = Eigen::RowVector3d::Zero();
                for (int corner = 0; corner < 4; ++corner) center += full.coordinates().row(first[corner]) / 4.0;
                if ((center - Eigen::RowVector3d(0.5, 0.5, 0.0)).norm() < 0.1) continue;
                kept.nodes.insert(kept.nodes.end(), first, first + static_cast<std::ptrdiff_t>(size));
                kept.tags.push_back(block.tags[static_cast<std::size_t>(i)]);
            }
            block = kept;
        }
    const CurvedMesh ring(std::make_shared<MeshTopology>(data), full.coordinates());
    const BoundaryParts parts(ring);
    EXPECT_EQ(parts.component_count(), 2);
    EXPECT_EQ(parts.smooth_part_count(), 8);
    const auto hole = parts.component_nodes_around(node_at(ring, {1.0 / 3.0, 0.5, 0.0}));
    EXPECT_EQ(hole.size(), 8u);
    for (Index node : hole) EXPECT_LT((ring.coordinates().row(node).array() - 0.5).abs().head<2>().maxCoeff(), 0.2);
}

TEST(BoundaryParts, NormalsPointOutward) {
    for (const CurvedMesh& mesh : {square_mesh(4, 3), cube_mesh(2, 2), hex_mesh(2, 3), prism_mesh(2, 2)}) {
        const bool is_flat = mesh.topology().dimension() == 2;
        for (const CurvedMesh& numbered : {mesh, flip_orientation(mesh)}) {
            const BoundaryParts parts(numbered);
            const Eigen::Vector3d n = parts.normal(mesh.coordinates(), node_at(mesh, {1.0, 0.5, is_flat ? 0.0 : 0.5}));
            EXPECT_NEAR((n - Eigen::Vector3d::UnitX()).norm(), 0.0, 1e-12);
            EXPECT_EQ(parts.normal(mesh.coordinates(), mesh.topology().interior_nodes().front()).norm(), 0.0);
        }
    }
}

TEST(BoundaryParts, OtherNodesHaveNone) {
    const CurvedMesh mesh = square_mesh(4, 2);
    const BoundaryParts parts(mesh);
    const Index inside = mesh.topology().interior_nodes().front();
    EXPECT_TRUE(parts.facets_of_node(inside).empty());
    EXPECT_TRUE(parts.smooth_nodes_around(inside).empty());
    EXPECT_TRUE(parts.component_nodes_around(inside).empty());
    EXPECT_TRUE(parts.facets_of_node(-1).empty());
    EXPECT_TRUE(parts.facets_of_node(mesh.topology().node_count()).empty());
}

}  // namespace
}  // namespace curvewright
