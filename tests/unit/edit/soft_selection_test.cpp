#include "core/edit/soft_selection.h"

#include <cmath>

#include <gtest/gtest.h>

#include "tests/support/mesh_factory.h"

namespace curvewright {
namespace {

using namespace curvewright::testing;

constexpr Falloff all_falloffs[] = {Falloff::smooth, Falloff::sphere, Falloff::root, Falloff::linear, Falloff::sharp};

TEST(SoftSelection, FalloffsGoFromOneToNothing) {
    for (Falloff falloff : all_falloffs) {
        EXPECT_EQ(falloff_weight(falloff, 0.0), 1.0);
        EXPECT_EQ(falloff_weight(falloff, 1.0), 0.0);
        EXPECT_EQ(falloff_weight(falloff, 7.0), 0.0);
        EXPECT_EQ(falloff_weight(falloff, std::nan("")), 0.0);
        for (double t = 0.0; t < 1.0; t += 0.05)
            EXPECT_GT(falloff_weight(falloff, t), falloff_weight(falloff, t + 0.05)) << to_string(falloff);
    }
    EXPECT_DOUBLE_EQ(falloff_weight(Falloff::linear, 0.25), 0.75);
    EXPECT_DOUBLE_EQ(falloff_weight(Falloff::smooth, 0.5), 0.5);
    EXPECT_DOUBLE_EQ(falloff_weight(Falloff::sharp, 0.5), 0.25);
    EXPECT_DOUBLE_EQ(falloff_weight(Falloff::sphere, 0.6), 0.8);
    EXPECT_DOUBLE_EQ(falloff_weight(Falloff::root, 0.75), 0.5);
}

class SoftSelectionOnSquare : public ::testing::Test {
  protected:
    CurvedMesh mesh = square_mesh(10, 3);
    BoundaryParts parts{mesh};
    Index middle = -1;  ///< node at (0.5, 0)

    void SetUp() override {
        for (Index node : mesh.topology().boundary_nodes())
            if ((mesh.coordinates().row(node) - Eigen::RowVector3d(0.5, 0.0, 0.0)).norm() < 1e-9) middle = node;
        ASSERT_GE(middle, 0);
    }
    DraggedSet select(const SoftSelection& options, const IndexSet& pinned = {}) {
        return soft_selection(parts, mesh.topology(), mesh.coordinates(), {middle}, pinned, options);
    }
};

TEST_F(SoftSelectionOnSquare, WithoutRadiusTheSelectionAlone) {
    const DraggedSet set = select({});
    EXPECT_EQ(set.nodes, std::vector<Index>{middle});
    EXPECT_TRUE(set.weights.empty());
}

TEST_F(SoftSelectionOnSquare, WeightsAreThoseOfTheDistance) {
    const DraggedSet set = select({.radius = 0.35, .falloff = Falloff::linear});
    ASSERT_EQ(set.nodes.size(), set.weights.size());
    EXPECT_EQ(set.nodes.size(), 21u);  // 10 nodes of spacing 1/30 within 0.35 on both sides
    for (std::size_t i = 0; i < set.nodes.size(); ++i) {
        const Eigen::RowVector3d x = mesh.coordinates().row(set.nodes[i]);
        EXPECT_EQ(x.y(), 0.0);
        EXPECT_NEAR(set.weights[i], 1.0 - std::abs(x.x() - 0.5) / 0.35, 1e-12);
    }
}

TEST_F(SoftSelectionOnSquare, AlongTheBoundaryIsFurtherThanAsTheCrowFlies) {
    const DraggedSet along = select({.radius = 1.05}), straight = select({.radius = 1.05, .follows_boundary = false});
    // Along: 1.05 reaches 0.55 up both sides. Straight: to the top, 1 away.
    double highest_along = 0.0, highest_straight = 0.0;
    for (Index node : along.nodes) highest_along = std::max(highest_along, mesh.coordinates()(node, 1));
    for (Index node : straight.nodes) highest_straight = std::max(highest_straight, mesh.coordinates()(node, 1));
    EXPECT_NEAR(highest_along, 16.0 / 30.0, 1e-9);
    EXPECT_NEAR(highest_straight, 1.0, 1e-9);
}

TEST_F(SoftSelectionOnSquare, PinnedNodesStay) {
    const DraggedSet all = select({.radius = 0.35});
    const IndexSet pinned{all.nodes.front(), all.nodes.back()};
    const DraggedSet set = select({.radius = 0.35}, pinned);
    EXPECT_EQ(set.nodes.size() + 2, all.nodes.size());
    for (Index node : pinned) EXPECT_EQ(std::count(set.nodes.begin(), set.nodes.end(), node), 0);
    EXPECT_TRUE(select({}, {middle}).nodes.empty());
}

TEST_F(SoftSelectionOnSquare, InteriorNodesAreTakenAsTheyAre) {
    const Index inner = mesh.topology().interior_nodes().front();
    IndexSet selected{middle, inner};
    std::sort(selected.begin(), selected.end());
    const DraggedSet set = soft_selection(parts, mesh.topology(), mesh.coordinates(), selected, {}, {.radius = 0.1});
    const auto found = std::find(set.nodes.begin(), set.nodes.end(), inner);
    ASSERT_NE(found, set.nodes.end());
    EXPECT_EQ(set.weights[static_cast<std::size_t>(found - set.nodes.begin())], 1.0);
}

TEST(SoftSelectionOnCube, ReachesAroundEdges) {
    const CurvedMesh mesh = cube_mesh(4, 2);
    const BoundaryParts parts(mesh);
    Index corner = -1;
    for (Index node : mesh.topology().boundary_nodes())
        if (mesh.coordinates().row(node).isZero(1e-12)) corner = node;
    ASSERT_GE(corner, 0);
    const DraggedSet set = soft_selection(parts, mesh.topology(), mesh.coordinates(), {corner}, {}, {.radius = 0.3});
    EXPECT_GT(set.nodes.size(), 9u);
    for (std::size_t i = 0; i < set.nodes.size(); ++i) {
        const Eigen::RowVector3d x = mesh.coordinates().row(set.nodes[i]);
        EXPECT_TRUE(mesh.topology().is_boundary_node(set.nodes[i]));
        EXPECT_LT(x.norm(), 0.3);
        EXPECT_GT(set.weights[i], 0.0);
    }
}

}  // namespace
}  // namespace curvewright
