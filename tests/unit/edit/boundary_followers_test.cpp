// Drags in which the rest of the boundary slides or follows freely, and drags that are solved anew at the end.

#include "core/edit/boundary_followers.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/edit/drag.h"
#include "tests/support/mesh_factory.h"

namespace curvewright {
namespace {

using namespace curvewright::testing;

std::vector<Index> group(const CurvedMesh& mesh, const char* name) {
    return mesh.topology().find_group_nodes(name).value();
}

WarperSource fresh() {
    return [](const CurvedMesh& mesh, const WarpOptions& options) {
        return std::make_shared<const Warper>(mesh, options);
    };
}

/// A ring of four blocks with its boundary on two circles as well as order p can: x = (r cos, r sin).
CurvedMesh bent_square(int n, int order) {
    // The square as a sector: bottom = inner arc, top = outer arc.
    const CurvedMesh square = square_mesh(n, order);
    Coordinates x = square.coordinates();
    for (Eigen::Index i = 0; i < x.rows(); ++i) {
        const double angle = 0.4 * std::numbers::pi * (1.0 - x(i, 0)), radius = 1.0 + x(i, 1);
        x.row(i) << radius * std::cos(angle), radius * std::sin(angle), 0.0;
    }
    return square.with_coordinates(x);
}

DragSetup setup_of(const CurvedMesh& mesh, const char* side, const char* rule) {
    DragSetup setup;
    setup.set.nodes = group(mesh, side);
    setup.rules.boundary.add(rule);
    return setup;
}

TEST(BoundaryFollowers, AreWhatTheRulesLetMove) {
    const CurvedMesh mesh = square_mesh(3, 2);
    BoundaryRules rules;
    EXPECT_TRUE(BoundaryFollowers(mesh, rules, {}).is_empty());
    rules.add("right=slide");
    rules.add("top=free");
    const auto left = group(mesh, "left");
    const BoundaryFollowers followers(mesh, rules, left);
    EXPECT_TRUE(followers.has_sliding());
    for (std::size_t i = 0; i < followers.nodes().size(); ++i) {
        const Eigen::RowVector3d at = mesh.coordinates().row(followers.nodes()[i]);
        const bool is_right = at[0] == 1.0;
        EXPECT_TRUE(is_right ? at[1] > 0.0 && at[1] < 1.0 : at[1] == 1.0 && at[0] > 0.0) << at;
        const Eigen::Matrix3d wanted = is_right
                                           ? Eigen::Matrix3d(Eigen::Vector3d::UnitY() * Eigen::RowVector3d::UnitY())
                                           : Eigen::Matrix3d(Eigen::Matrix3d::Identity());
        EXPECT_LT((followers.projections()[i] - wanted).norm(), 1e-12);
    }
    EXPECT_EQ(followers.nodes().size(), 10u);
    rules.add("nowhere=slide");
    EXPECT_THROW(BoundaryFollowers(mesh, rules, left), InvalidInput);
}

TEST(BoundaryFollowers, SidesSlideWhileAnEndIsPulled) {
    // The top and bottom sides let the pull through: every node moves by its part of it.
    const CurvedMesh mesh = square_mesh(4, 3);
    DragSetup setup = setup_of(mesh, "right", "top=slide");
    setup.rules.boundary.add("bottom=slide");
    Drag drag(setup, mesh, mesh, nullptr, fresh());
    EXPECT_TRUE(drag.needs_settling());
    const Coordinates moved = drag.move(AffineMotion::translation({0.2, 0.0, 0.0}));
    Coordinates wanted = mesh.coordinates();
    wanted.col(0) *= 1.2;
    EXPECT_LT((moved - wanted).cwiseAbs().maxCoeff(), 1e-9);
    EXPECT_LT((drag.settled(moved, fresh()) - wanted).cwiseAbs().maxCoeff(), 1e-9);
    // Across them it is not let through.
    const Coordinates across = drag.move(AffineMotion::translation({0.0, 0.1, 0.0}));
    for (const Index node : group(mesh, "bottom"))
        if (mesh.coordinates()(node, 0) < 1.0) {
            EXPECT_EQ(across(node, 1), 0.0);
        }
}

TEST(BoundaryFollowers, SlidingNodesStayOnTheCurveAndTheInteriorIsTheirWarp) {
    for (const Weighting weighting : {Weighting::convex, Weighting::elastic}) {
        const CurvedMesh mesh = bent_square(4, 3);
        DragSetup setup = setup_of(mesh, "right", "top=slide");
        setup.rules.boundary.add("bottom=slide");
        setup.options.weighting = weighting;
        setup.kind = ResponseKind::affine;
        const auto report = std::make_shared<const QualityReport>(assess_quality(mesh));
        Drag drag(setup, mesh, mesh, report, fresh());
        // The end of the sector turns about the centre: the arcs' nodes go along their arcs.
        const Coordinates moved = drag.move(AffineMotion::rotation(Eigen::Vector3d::UnitZ(), 0.2));
        const Coordinates end = drag.settled(moved, fresh());
        int slid = 0;
        for (const char* side : {"top", "bottom"}) {
            const double radius = *side == 't' ? 2.0 : 1.0;
            for (const Index node : group(mesh, side)) {
                if (moved.row(node) == mesh.coordinates().row(node)) continue;
                // On the cubic pieces, which are that near the circle.
                if (std::find(setup.set.nodes.begin(), setup.set.nodes.end(), node) != setup.set.nodes.end()) continue;
                ++slid;
                EXPECT_NEAR(moved.row(node).norm(), radius, 2e-4) << side;
                EXPECT_EQ(end.row(node), moved.row(node));
            }
        }
        EXPECT_GT(slid, 10);
        // What is settled is the warp of the boundary that was reached.
        const Coordinates direct = Warper(mesh, setup.options).move(end).coordinates;
        EXPECT_LT((direct - end).cwiseAbs().maxCoeff(), 1e-9);

        QualityReport live = *report;
        drag.certify(end, live);
        const QualityReport anew =
            assess_quality(mesh.with_coordinates(end), {.orientation_sign = report->orientation_sign});
        for (std::size_t i = 0; i < live.elements.size(); ++i)
            EXPECT_EQ(live.elements[i].scaled_jacobian, anew.elements[i].scaled_jacobian);
    }
}

TEST(BoundaryFollowers, AFreeSideIsTakenAlong) {
    const CurvedMesh mesh = square_mesh(4, 2);
    DragSetup setup = setup_of(mesh, "left", "free");
    Drag drag(setup, mesh, mesh, nullptr, fresh());
    EXPECT_FALSE(drag.needs_settling());
    const Coordinates moved = drag.move(AffineMotion::translation({0.3, 0.2, 0.0}));
    // Nobody holds anything: all of it moves.
    const Coordinates shift = moved - mesh.coordinates();
    EXPECT_LT((shift.rowwise() - Eigen::RowVector3d(0.3, 0.2, 0.0)).cwiseAbs().maxCoeff(), 1e-10);

    // Pinned nodes stay.
    setup.pinned = group(mesh, "right");
    Drag held(setup, mesh, mesh, nullptr, fresh());
    const Coordinates stretched = held.move(AffineMotion::translation({0.3, 0.0, 0.0}));
    for (const Index node : setup.pinned) EXPECT_EQ(stretched.row(node), mesh.coordinates().row(node));
    for (const Index node : mesh.topology().boundary_nodes())
        EXPECT_NEAR(stretched(node, 0), 0.3 + 0.7 * mesh.coordinates()(node, 0), 1e-9);
}

TEST(BoundaryFollowers, FacesOfASolidSlide) {
    const CurvedMesh mesh = cube_mesh(3, 2);
    DragSetup setup = setup_of(mesh, "x1", "slide");
    setup.rules.boundary.groups.push_back({"x0", BoundaryMode::fixed});
    Drag drag(setup, mesh, mesh, nullptr, fresh());
    const Coordinates moved = drag.move(AffineMotion::translation({0.2, 0.0, 0.0}));
    Coordinates wanted = mesh.coordinates();
    wanted.col(0) *= 1.2;
    EXPECT_LT((moved - wanted).cwiseAbs().maxCoeff(), 1e-9);
}

TEST(Drag, SolvedAnewItTakesTheWeightsOfWhereItBegan) {
    const CurvedMesh opened = square_mesh(5, 3);
    DragSetup setup = setup_of(opened, "top", "fixed");
    // The first drag: a large one, by the weights of the mesh as opened.
    setup.kind = ResponseKind::affine;
    Drag first(setup, opened, opened, nullptr, fresh());
    const CurvedMesh start = opened.with_coordinates(first.move(AffineMotion::shear(0, 1, 0.6)));
    setup.rules.solves_anew = true;
    Drag second(setup, opened, start, nullptr, fresh());
    const AffineMotion motion = AffineMotion::scaling({1.3, 1.2, 1.0});
    const Coordinates seen = second.move(motion);
    EXPECT_TRUE(second.needs_settling());
    const Coordinates end = second.settled(seen, fresh());
    EXPECT_EQ(end, Warper(start, setup.options).move(seen).coordinates);
    EXPECT_GT((end - seen).cwiseAbs().maxCoeff(), 1e-4);
    for (const Index node : opened.topology().boundary_nodes()) EXPECT_EQ(end.row(node), seen.row(node));
}

}  // namespace
}  // namespace curvewright
