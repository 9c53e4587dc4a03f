#include "core/warp/incremental.h"

#include <cmath>
#include <random>
#include <set>

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/deform/deformation.h"
#include "tests/support/mesh_factory.h"

namespace curvewright {
namespace {

using testing::cube_mesh;
using testing::shaken;
using testing::square_mesh;

WarpOptions with(Weighting weighting) {
    WarpOptions options;
    options.weighting = weighting;
    return options;
}

/// The top side is bent and shifted; by 1 that is too much, by 0.2 it is easy.
BoundaryPath bending(const CurvedMesh& mesh, double amount) {
    return [mesh, amount](double fraction) {
        Coordinates x = mesh.coordinates();
        for (const Index node : mesh.topology().boundary_nodes()) {
            const double height = mesh.coordinates()(node, 1), along = mesh.coordinates()(node, 0);
            x(node, 1) -= fraction * amount * height * std::sin(std::acos(-1.0) * along);
            x(node, 0) += 0.3 * fraction * amount * height * height;
        }
        return x;
    };
}

bool all_valid(const CurvedMesh& mesh, const Coordinates& x) {
    const QualitySummary summary = assess_quality(mesh.with_coordinates(x)).summary;
    return summary.invalid == 0 && summary.undecided == 0;
}

TEST(Increments, KeptWeightsEndWhereADirectWarpEnds) {
    std::mt19937 random(1);
    for (const CurvedMesh& mesh : {shaken(square_mesh(6, 3), 0.003, random), cube_mesh(2, 2)})
        for (const Weighting weighting : {Weighting::convex, Weighting::affine, Weighting::elastic})
            for (const int steps : {0, 1, 4}) {
                const BoundaryPath path = bending(mesh, 0.2);
                const IncrementalResult result =
                    warp_in_increments(mesh, path, with(weighting), {steps, false, 1.0 / 64});
                EXPECT_TRUE(result.increments.is_complete());
                EXPECT_EQ(result.increments.accepted, std::max(1, steps));
                EXPECT_EQ(result.increments.steps.size(), static_cast<std::size_t>(std::max(1, steps)));
                EXPECT_FALSE(result.increments.failed_element);
                EXPECT_LT(
                    (result.coordinates - warp(mesh, path(1.0), with(weighting)).coordinates).cwiseAbs().maxCoeff(),
                    1e-9);
                const Coordinates end = path(1.0);
                for (const Index node : mesh.topology().boundary_nodes())
                    EXPECT_EQ(result.coordinates.row(node), end.row(node));
                EXPECT_EQ(result.quality.summary.valid, mesh.topology().element_count());
            }
}

TEST(Increments, RecomputedWeightsAreThoseOfEveryStep) {
    const CurvedMesh mesh = square_mesh(6, 2);
    const BoundaryPath path = bending(mesh, 0.5);
    const IncrementalResult result = warp_in_increments(mesh, path, {}, {3, true, 1.0 / 64});
    ASSERT_TRUE(result.increments.is_complete());
    CurvedMesh by_hand = mesh;
    for (int step = 1; step <= 3; ++step)
        by_hand = by_hand.with_coordinates(warp(by_hand, path(step == 3 ? 1.0 : step * (1.0 / 3)), {}).coordinates);
    EXPECT_EQ(result.coordinates, by_hand.coordinates());
    const IncrementalResult kept = warp_in_increments(mesh, path, {}, {3, false, 1.0 / 64});
    EXPECT_GT((kept.coordinates - result.coordinates).cwiseAbs().maxCoeff(), 1e-4);  // they are not the same thing
    std::vector<double> fractions;
    for (const IncrementStep& step : result.increments.steps) fractions.push_back(step.fraction);
    ASSERT_EQ(fractions.size(), 3u);
    EXPECT_NEAR(fractions[0], 1.0 / 3, 1e-15);
    EXPECT_NEAR(fractions[1], 2.0 / 3, 1e-15);
    EXPECT_EQ(fractions[2], 1.0);
}

TEST(Increments, AMotionTooLargeStopsAtTheLastValidState) {
    for (const CurvedMesh& mesh : {square_mesh(6, 3), cube_mesh(2, 2)})
        for (const int steps : {0, 7}) {
            const BoundaryPath path = bending(mesh, 1.6);
            ASSERT_FALSE(all_valid(mesh, warp(mesh, path(1.0)).coordinates));
            const IncrementalResult result = warp_in_increments(mesh, path, {}, {steps, false, 1.0 / 64});
            const IncrementReport& report = result.increments;
            EXPECT_FALSE(report.is_complete());
            EXPECT_GT(report.fraction, 0.0);
            EXPECT_LT(report.fraction, report.failed_fraction);
            EXPECT_LE(report.failed_fraction, 1.0);
            // The state is the warp to the fraction told, and valid; the next is not.
            EXPECT_LT((result.coordinates - warp(mesh, path(report.fraction)).coordinates).cwiseAbs().maxCoeff(), 1e-9);
            EXPECT_TRUE(all_valid(mesh, result.coordinates));
            EXPECT_EQ(result.quality.summary.valid, mesh.topology().element_count());
            const CurvedMesh failed = mesh.with_coordinates(warp(mesh, path(report.failed_fraction)).coordinates);
            QualityOptions options;
            options.orientation_sign = 1.0;
            const QualityReport quality = assess_quality(failed, options);
            EXPECT_GT(quality.summary.invalid + quality.summary.undecided, 0);
            ASSERT_TRUE(report.failed_element);
            EXPECT_EQ(*report.failed_element, quality.worst(1).front());
            EXPECT_NEAR(report.failed_scaled_jacobian, quality.summary.min, 1e-9);
            EXPECT_LE(report.failed_scaled_jacobian, 0.0);
            if (steps == 0) {
                EXPECT_LE(report.failed_fraction - report.fraction, 2.0 / 64);
            } else {
                EXPECT_NEAR(report.fraction, report.accepted / 7.0, 1e-12);
                EXPECT_NEAR(report.failed_fraction, (report.accepted + 1) / 7.0, 1e-12);
            }
            const std::string text = describe(report, mesh.topology());
            EXPECT_NE(text.find("element " + std::to_string(mesh.topology().element_tag(*report.failed_element).value)),
                      std::string::npos)
                << text;
        }
}

TEST(Increments, RecomputedWeightsGoAtLeastAsFarAsKeptOnes) {
    const CurvedMesh mesh = square_mesh(8, 2);
    const BoundaryPath path = bending(mesh, 0.85);
    const double kept = warp_in_increments(mesh, path, {}, {0, false, 1.0 / 64}).increments.fraction;
    const IncrementalResult recomputed = warp_in_increments(mesh, path, {}, {0, true, 1.0 / 64});
    EXPECT_TRUE(all_valid(mesh, recomputed.coordinates));
    EXPECT_GE(recomputed.increments.fraction, kept);
}

TEST(Increments, StepsTriedAddUp) {
    const CurvedMesh mesh = square_mesh(6, 2);
    for (const bool recomputes : {false, true}) {
        const IncrementalResult result = warp_in_increments(mesh, bending(mesh, 1.6), {}, {0, recomputes, 1.0 / 32});
        double reached = 0.0;
        int accepted = 0;
        for (const IncrementStep& step : result.increments.steps) {
            EXPECT_GT(step.fraction, reached);
            EXPECT_EQ(step.is_accepted, step.summary.invalid == 0 && step.summary.undecided == 0);
            EXPECT_EQ(step.summary.elements(), mesh.topology().element_count());
            EXPECT_GE(step.fraction - reached, 1.0 / 32 - 1e-12);
            if (!step.is_accepted) continue;
            reached = step.fraction;
            ++accepted;
        }
        EXPECT_EQ(reached, result.increments.fraction);
        EXPECT_EQ(accepted, result.increments.accepted);
    }
}

TEST(Increments, NoProgressLeavesTheMeshAsItWas) {
    const CurvedMesh mesh = square_mesh(4, 2);
    // Turned inside out at once, however short the step.
    const BoundaryPath path = [&](double fraction) {
        Coordinates x = mesh.coordinates();
        if (fraction > 0.0) x.col(0) *= -1.0;
        return x;
    };
    for (const int steps : {0, 3}) {
        const IncrementalResult result = warp_in_increments(mesh, path, {}, {steps, true, 0.25});
        EXPECT_EQ(result.coordinates, mesh.coordinates());
        EXPECT_EQ(result.increments.fraction, 0.0);
        EXPECT_EQ(result.increments.accepted, 0);
        EXPECT_EQ(result.increments.steps.size(), steps == 0 ? 3u : 1u);  // 1, 1/2, 1/4
        EXPECT_EQ(result.quality.summary.valid, mesh.topology().element_count());
    }
}

TEST(Increments, ARotationGoesRoundWhereTheStraightWayFails) {
    // Half a turn of the whole boundary: the straight way leads through a point, the deformation's own does not.
    const CurvedMesh mesh = square_mesh(4, 3);
    const Deformation turn{OperationList{{{"boundary", Rotate{{0.5, 0.5, 0.0}, 180.0, {0, 0, 1}}}}}, ""};
    const BoundaryPath path = [&](double fraction) { return apply_deformation(mesh, turn, fraction); };
    const IncrementalResult result = warp_in_increments(mesh, path, {}, {4, true, 1.0 / 64});
    EXPECT_TRUE(result.increments.is_complete());
    for (Index node = 0; node < mesh.topology().node_count(); ++node) {
        const Eigen::RowVector3d expected = Eigen::RowVector3d(1.0, 1.0, 0.0) - mesh.coordinates().row(node);
        EXPECT_LT((result.coordinates.row(node) - expected).norm(), 1e-12);
    }
}

TEST(Increments, ClockwiseMeshesStayClockwise) {
    const CurvedMesh mesh = flip_orientation(square_mesh(5, 2));
    const IncrementalResult result = warp_in_increments(mesh, bending(mesh, 0.3), {}, {2, true, 0.1});
    EXPECT_TRUE(result.increments.is_complete());
    EXPECT_EQ(result.quality.orientation_sign, OrientationSigns(-1.0));
    EXPECT_EQ(result.quality.summary.valid, mesh.topology().element_count());
}

TEST(Increments, InvalidStartsAndOptionsAreRefused) {
    CurvedMesh mesh = square_mesh(4, 2);
    const BoundaryPath path = bending(mesh, 0.1);
    EXPECT_THROW(warp_in_increments(mesh, path, {}, {-1, true, 0.1}), InvalidInput);
    EXPECT_THROW(warp_in_increments(mesh, path, {}, {1000000, true, 0.1}), InvalidInput);
    for (const double step : {0.0, -1.0, 1.5, std::nan("")})
        EXPECT_THROW(warp_in_increments(mesh, path, {}, {0, true, step}), InvalidInput) << step;
    const CurvedMesh quads = testing::quad_mesh(3, 2);
    EXPECT_TRUE(warp_in_increments(quads, bending(quads, 0.1), {}, {}).increments.is_complete());
    // Pyramids are not assessed: they follow, and nothing stops the motion.
    const CurvedMesh pyramids = testing::pyramid_mesh(2);
    EXPECT_TRUE(warp_in_increments(pyramids, bending(pyramids, 0.1), {}, {}).increments.is_complete());

    Coordinates x = mesh.coordinates();
    for (const Index node : mesh.topology().interior_nodes())
        if ((x.row(node) - Eigen::RowVector3d(0.5, 0.5, 0.0)).norm() < 1e-9) x.row(node) << 0.9, 0.1, 0.0;
    mesh = mesh.with_coordinates(x);
    const Index worst = assess_quality(mesh).worst(1).front();
    try {
        warp_in_increments(mesh, path, {}, {});
        ADD_FAILURE() << "accepted";
    } catch (const InvalidInput& error) {
        EXPECT_NE(
            std::string(error.what()).find("element " + std::to_string(mesh.topology().element_tag(worst).value) + " "),
            std::string::npos)
            << error.what();
    }
}

TEST(Increments, ProgressOnlyGrowsAndCancelsAnywhere) {
    const CurvedMesh mesh = square_mesh(10, 3);
    for (const bool recomputes : {true, false})
        for (const double amount : {0.3, 1.6}) {
            const BoundaryPath path = bending(mesh, amount);
            double last = 0.0;
            int calls = 0, drops = 0;
            std::set<std::string> phases;
            warp_in_increments(mesh, path, {}, {amount < 1.0 ? 3 : 0, recomputes, 0.1},
                               {{}, [&](std::string_view phase, double fraction) {
                                    ++calls;
                                    phases.emplace(phase);
                                    EXPECT_LE(fraction, 1.0);
                                    EXPECT_GE(fraction, 0.0);
                                    if (phase == "Warping step by step") {
                                        drops += fraction < last ? 1 : 0;
                                        last = fraction;
                                    }
                                }});
            EXPECT_EQ(drops, 0) << amount << " " << recomputes;
            EXPECT_TRUE(phases.contains("Warping step by step"));
            EXPECT_GT(calls, 10);
            for (int at = 1; at < calls; at += 1 + calls / 15) {
                std::stop_source source;
                int left = at;
                const ProgressCallback stop = [&](std::string_view, double) {
                    if (--left == 0) source.request_stop();
                };
                // How often the calling thread reports depends on how the pieces fall to the threads: a run may end
                // before its call number `at`, but none may go on to its end after it.
                const auto runs_to_its_end = [&] {
                    try {
                        warp_in_increments(mesh, path, {}, {amount < 1.0 ? 3 : 0, recomputes, 0.1},
                                           {source.get_token(), stop});
                        return true;
                    } catch (const Cancelled&) {
                        return false;
                    }
                };
                const bool ended = runs_to_its_end();
                EXPECT_EQ(ended, left > 0) << at << " of " << calls;
            }
        }
}

TEST(Increments, Describe) {
    const CurvedMesh mesh = square_mesh(4, 2);
    EXPECT_EQ(describe(warp_in_increments(mesh, bending(mesh, 0.1), {}, {}).increments, mesh.topology()),
              "The whole motion in 1 step.");
    EXPECT_EQ(describe(warp_in_increments(mesh, bending(mesh, 0.1), {}, {4, true, 0.1}).increments, mesh.topology()),
              "The whole motion in 4 steps.");
    IncrementReport report;
    report.steps.resize(3);
    report.accepted = 2;
    report.fraction = 0.5;
    report.failed_fraction = 0.75;
    report.failed_element = 5;
    report.failed_scaled_jacobian = -0.1234;
    EXPECT_EQ(
        describe(report, mesh.topology()),
        "Stopped at 50 % of the motion, the last state without tangled elements: the step to 75 % (step 3) tangles "
        "element " +
            std::to_string(mesh.topology().element_tag(5).value) + " (scaled Jacobian -0.123).");
}

}  // namespace
}  // namespace curvewright
