#include "core/untangle/signed_angles.h"

#include <limits>

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/quality/quality.h"
#include "tests/support/mesh_factory.h"
#include "tests/unit/untangle/bulged_mesh.h"

namespace curvewright {
namespace {

using testing::bulged;
using testing::square_mesh;

TEST(SignedAngles, UntanglesABulgedBoundary) {
    for (const int order : {2, 3}) {
        const CurvedMesh mesh = bulged(3, order, 0.1);
        const QualityReport before = assess_quality(mesh);
        ASSERT_GT(before.summary.invalid, 0);
        SignedAngleOptions options;
        options.beta = 0.5;
        const UntangleResult result = untangle_signed_angles(mesh, options);
        const QualityReport after = assess_quality(mesh.with_coordinates(result.coordinates));
        EXPECT_EQ(after.summary.invalid, 0) << "P" << order;
        EXPECT_GT(after.summary.min, 0.05);
        EXPECT_EQ(result.reason, StopReason::converged);
    }
}

TEST(SignedAngles, CornersAndBoundaryStayBitForBit) {
    const CurvedMesh mesh = bulged(3, 3, 0.2);
    const UntangleResult result = untangle_signed_angles(mesh);
    for (Index node : mesh.topology().boundary_nodes())
        EXPECT_EQ(result.coordinates.row(node), mesh.coordinates().row(node));
    for (Index element = 0; element < mesh.topology().element_count(); ++element)
        for (int corner = 0; corner < 3; ++corner) {
            const Index node = mesh.topology().element_nodes(element)[corner];
            EXPECT_EQ(result.coordinates.row(node), mesh.coordinates().row(node));
        }
}

TEST(SignedAngles, FaceNodeIsTheMeanOfTheHighOrderEdgeNodes) {
    const CurvedMesh mesh = bulged(3, 3, 0.1);
    const Coordinates x = untangle_signed_angles(mesh).coordinates;
    for (Index element = 0; element < mesh.topology().element_count(); ++element) {
        const auto nodes = mesh.topology().element_nodes(element);
        Eigen::RowVector2d mean = Eigen::RowVector2d::Zero();
        for (int i = 3; i < 9; ++i) mean += x.row(nodes[i]).head<2>() / 6;
        EXPECT_LT((x.row(nodes[9]).head<2>() - mean).norm(), 1e-14);
    }
}

TEST(SignedAngles, WorksOnClockwiseMeshes) {
    const CurvedMesh mesh = bulged(3, 2, 0.1), clockwise = flip_orientation(mesh);
    const Coordinates x = untangle_signed_angles(mesh).coordinates, y = untangle_signed_angles(clockwise).coordinates;
    EXPECT_EQ(assess_quality(clockwise.with_coordinates(y)).summary.invalid, 0);
    EXPECT_LT((x - y).cwiseAbs().maxCoeff(), 1e-3);  // the edges are walked the other way round: rounding differs
}

/// Counts events and checks that they nest.
class Checker : public UntangleObserver {
  public:
    void on_event(const UntangleEvent& event) override {
        using namespace untangle_event;
        if (std::holds_alternative<PassBegan>(event)) {
            EXPECT_FALSE(in_pass);
            in_pass = true;
        } else if (std::holds_alternative<PatchBegan>(event)) {
            EXPECT_TRUE(in_pass && !in_patch);
            in_patch = true;
            expected_step = 0;
        } else if (const auto* step = std::get_if<SimplexStep>(&event)) {
            EXPECT_TRUE(in_patch);
            EXPECT_EQ(step->iteration, expected_step++);
            EXPECT_NEAR(step->displacement_term + step->angle_term, step->objective[0], 1e-12);
            ++steps;
        } else if (const auto* patch = std::get_if<PatchEnded>(&event)) {
            EXPECT_TRUE(in_patch);
            EXPECT_LE(patch->objective_after, patch->objective_before);
            EXPECT_EQ(patch->iterations + 1, expected_step);
            in_patch = false;
            ++patches;
        } else if (const auto* pass = std::get_if<PassEnded>(&event)) {
            in_pass = false;
            EXPECT_EQ(pass->pass, ++passes);
            last = *pass->coordinates;
            last_minimum = pass->min_scaled_jacobian;
        } else if (const auto* finished = std::get_if<Finished>(&event)) {
            is_finished = true;
            EXPECT_EQ(finished->passes, passes);
        }
    }
    bool in_pass = false, in_patch = false, is_finished = false;
    int steps = 0, patches = 0, passes = 0, expected_step = 0;
    double last_minimum = 0.0;
    Coordinates last;
};

TEST(SignedAngles, ObserverSeesEveryStepAndChangesNothing) {
    const CurvedMesh mesh = bulged(3, 3, 0.2);
    Checker checker;
    const UntangleResult watched = untangle_signed_angles(mesh, {}, &checker), alone = untangle_signed_angles(mesh);
    EXPECT_EQ(watched.coordinates, alone.coordinates);
    EXPECT_TRUE(checker.is_finished);
    EXPECT_EQ(checker.passes, watched.passes);
    EXPECT_EQ(checker.patches, watched.passes * (33 - 12) * 2);
    EXPECT_GT(checker.steps, checker.patches);
    EXPECT_EQ(checker.last, watched.coordinates);
    EXPECT_EQ(checker.last_minimum, assess_quality(mesh.with_coordinates(watched.coordinates)).summary.min);
}

TEST(SignedAngles, WorsePassIsTakenBackWhenAsked) {
    // Very stretched triangles: the angle term makes them worse. One is tangled by its side on the boundary, as only a
    // mesh that is not valid is changed.
    CurvedMesh mesh = square_mesh(4, 2);
    Coordinates x = mesh.coordinates();
    const std::vector<Index> bottom = mesh.topology().find_group_nodes("bottom").value();
    for (const Index node : bottom)
        if (x(node, 0) == 0.125) x(node, 1) += 0.3;
    x.col(1) *= 1e-2;
    mesh = mesh.with_coordinates(x);
    ASSERT_GT(assess_quality(mesh).summary.invalid, 0);
    SignedAngleOptions options;
    options.beta = 1.0;
    const auto literal = untangle_signed_angles(mesh, options);
    ASSERT_GT(assess_quality(mesh.with_coordinates(literal.coordinates)).summary.invalid,
              assess_quality(mesh).summary.invalid);
    options.reject_worse_pass = true;
    const UntangleResult guarded = untangle_signed_angles(mesh, options);
    EXPECT_EQ(guarded.reason, StopReason::no_progress);
    EXPECT_EQ(guarded.passes, 0);
    EXPECT_EQ(guarded.coordinates, mesh.coordinates());
}

TEST(SignedAngles, RefusesWhatItCannotDo) {
    EXPECT_THROW(untangle_signed_angles(square_mesh(2, 1)), Unsupported);
    EXPECT_THROW(untangle_signed_angles(testing::cube_mesh(1, 2)), Unsupported);
    SignedAngleOptions options;
    for (const double beta : {0.0, -1.0, 1.5, std::numeric_limits<double>::quiet_NaN()}) {
        options.beta = beta;
        EXPECT_THROW(untangle_signed_angles(square_mesh(2, 2), options), InvalidInput);
    }
    options.beta = 0.5;
    options.max_passes = 0;
    EXPECT_THROW(untangle_signed_angles(square_mesh(2, 2), options), InvalidInput);
}

TEST(SignedAngles, CancelsInTheMiddleOfAPass) {
    std::stop_source source;
    class Stopper : public UntangleObserver {
      public:
        explicit Stopper(std::stop_source& s) : source(s) {}
        void on_event(const UntangleEvent& event) override {
            if (std::holds_alternative<untangle_event::PatchEnded>(event) && ++patches == 3) source.request_stop();
        }
        std::stop_source& source;
        int patches = 0;
    } stopper(source);
    EXPECT_THROW(untangle_signed_angles(bulged(4, 3, 0.1), {}, &stopper, {source.get_token(), {}}), Cancelled);
    EXPECT_EQ(stopper.patches, 3);
}

}  // namespace
}  // namespace curvewright
