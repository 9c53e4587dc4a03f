// What the guaranteed method tells, where it can be stopped, and what it promises about shape, unit and origin.

#include <algorithm>
#include <cmath>
#include <random>
#include <set>

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/quality/quality.h"
#include "core/quality/shape_quality.h"
#include "core/untangle/guaranteed.h"
#include "core/untangle/improve.h"
#include "tests/support/mesh_factory.h"

namespace curvewright {
namespace {

namespace event = untangle_event;

QualitySummary summary_of(const CurvedMesh& mesh, const Coordinates& x) {
    QualityOptions options;
    options.orientation_sign = assess_quality(mesh).orientation_sign;
    return assess_quality(mesh.with_coordinates(x), options).summary;
}

CurvedMesh tangled_square(unsigned seed, int n = 5, double amplitude = 0.05) {
    std::mt19937 random(seed);
    return testing::shaken(testing::square_mesh(n, 3), amplitude, random);
}

GuaranteedOptions sliding() {
    GuaranteedOptions options;
    options.boundary.add("slide");
    return options;
}

TEST(GuaranteedSteps, TellsEveryStepOfAPatchInOrder) {
    struct Recorder : UntangleObserver {
        void on_event(const UntangleEvent& e) override { events.push_back(e); }
        std::vector<UntangleEvent> events;
    };
    for (const GuaranteedOptions& options : {GuaranteedOptions{}, sliding()}) {
        const CurvedMesh mesh = tangled_square(1);
        Recorder recorder;
        const GuaranteedResult result = untangle_guaranteed(mesh, options, &recorder);
        EXPECT_EQ(result.coordinates, untangle_guaranteed(mesh, options).coordinates) << "observing changed the result";

        const event::PatchBegan* patch = nullptr;
        int patches = 0, iterations = 0, round = 0, certified = 0;
        Coordinates x = mesh.coordinates();
        for (const UntangleEvent& each : recorder.events) {
            if (const auto* began = std::get_if<event::PatchBegan>(&each)) {
                ASSERT_EQ(patch, nullptr);
                patch = began;
                ++patches;
                iterations = round = 0;
                ASSERT_EQ(began->positions.size(), began->nodes.size());
                for (std::size_t i = 0; i < began->nodes.size(); ++i)
                    for (std::size_t d = 0; d < 3; ++d)
                        EXPECT_EQ(began->positions[i][d], x(began->nodes[i], static_cast<int>(d)));
            } else if (const auto* step = std::get_if<event::EnergyStep>(&each)) {
                ASSERT_NE(patch, nullptr);
                EXPECT_GE(step->round, round);
                round = step->round;
                ++iterations;
                EXPECT_EQ(step->positions.size(), patch->nodes.size());
                EXPECT_GT(step->eps, 0.0);
            } else if (const auto* judged = std::get_if<event::PatchCertified>(&each)) {
                ASSERT_NE(patch, nullptr);
                ++certified;
                EXPECT_TRUE(std::count(patch->elements.begin(), patch->elements.end(), judged->worst_element));
            } else if (const auto* ended = std::get_if<event::PatchEnded>(&each)) {
                ASSERT_NE(patch, nullptr);
                EXPECT_EQ(ended->iterations, iterations);
                EXPECT_EQ(ended->nodes, patch->nodes);
                EXPECT_GE(ended->min_scaled_jacobian_after, ended->min_scaled_jacobian_before);
                for (std::size_t i = 0; i < ended->nodes.size(); ++i)
                    for (std::size_t d = 0; d < 3; ++d)
                        x(ended->nodes[i], static_cast<int>(d)) = ended->positions[i][d];
                patch = nullptr;
            }
        }
        EXPECT_EQ(patch, nullptr);
        EXPECT_GE(patches, 2);
        EXPECT_GE(certified, 7);
        EXPECT_EQ(x, result.coordinates) << "the events do not lead to the result";
    }
}

TEST(GuaranteedSteps, KeepsTheBestMeshWhenCancelledAtAnyMoment) {
    struct Stopper : UntangleObserver {
        explicit Stopper(int moment) : left(moment) {}
        void on_event(const UntangleEvent&) override {
            if (--left == 0) source.request_stop();
        }
        int left;
        std::stop_source source;
    };
    const CurvedMesh mesh = tangled_square(2);
    const QualitySummary before = assess_quality(mesh).summary;
    int cancelled = 0;
    std::set<Index> seen;
    for (const int moment : {1, 3, 5, 10, 20, 30, 50, 100, 200, 400}) {
        GuaranteedOptions options = moment % 20 == 0 ? sliding() : GuaranteedOptions{};
        Stopper throwing(moment), keeping(moment);
        try {
            untangle_guaranteed(mesh, options, &throwing, {throwing.source.get_token(), {}});
        } catch (const Cancelled&) {
            ++cancelled;
        }
        options.keeps_best_on_cancel = true;
        const GuaranteedResult result = untangle_guaranteed(mesh, options, &keeping, {keeping.source.get_token(), {}});
        if (keeping.left <= 0) {
            EXPECT_EQ(result.reason, StopReason::cancelled) << moment;
        }
        const QualitySummary after = summary_of(mesh, result.coordinates);
        EXPECT_LE(after.invalid + after.undecided, before.invalid + before.undecided);
        if (after.invalid + after.undecided == before.invalid + before.undecided) {
            EXPECT_GE(after.min, before.min);
        }
        if (moment > 1) {
            EXPECT_EQ(static_cast<Index>(result.unmended.size()), after.invalid + after.undecided);
        }
        seen.insert(after.invalid);
    }
    EXPECT_GE(cancelled, 7);
    EXPECT_GE(seen.size(), 2u) << "no state but one was ever kept";
}

TEST(GuaranteedSteps, AShapeFloorHoldsTheWorstShapeUp) {
    // Arches along the bottom: the more evenly the elements there are stretched, the flatter they get. The start is
    // what a large shape weight makes of them.
    const CurvedMesh straight = testing::square_mesh(4, 3);
    Coordinates x = straight.coordinates();
    for (const Index node : straight.topology().boundary_nodes()) {
        const double u = 4.0 * x(node, 0) - std::floor(4.0 * x(node, 0));
        if (x(node, 1) == 0.0) x(node, 1) = 0.3 * u * (1.0 - u);
    }
    GuaranteedOptions mending;
    mending.target = 1.0;
    mending.shape_weight = 10.0;
    const CurvedMesh mesh =
        straight.with_coordinates(untangle_guaranteed(straight.with_coordinates(x), mending).coordinates);
    ImproveOptions options;
    options.target = 1.0;
    const auto worst_shape = [&](const Coordinates& of) {
        return assess_shape(mesh.with_coordinates(of), mesh.coordinates()).min;
    };
    options.shape_weight = 1e-4;
    const ImproveResult without = improve(mesh, options);
    const double start = worst_shape(mesh.coordinates()), low = worst_shape(without.coordinates);
    ASSERT_GT(start, low + 0.02) << "improving costs no shape here";
    options.shape_floor = 0.5 * (start + low);
    const ImproveResult with = improve(mesh, options);
    EXPECT_GE(worst_shape(with.coordinates), options.shape_floor);
    EXPECT_LT(summary_of(mesh, with.coordinates).min, summary_of(mesh, without.coordinates).min);
    EXPECT_GT(summary_of(mesh, with.coordinates).min, summary_of(mesh, mesh.coordinates()).min);
    options.shape_floor = 0.999;  // more than the start has: the start's is what must not be lowered
    EXPECT_GE(worst_shape(improve(mesh, options).coordinates), start);
    GuaranteedOptions wrong;
    wrong.shape_floor = 1.0;
    EXPECT_THROW(untangle_guaranteed(mesh, wrong), InvalidInput);
}

TEST(GuaranteedSteps, LimitedWorkGoesToTheWorstElementsFirst) {
    const CurvedMesh mesh = tangled_square(3, 12, 0.02);
    GuaranteedOptions options;
    options.improves = false;
    const CurvedMesh valid = mesh.with_coordinates(untangle_guaranteed(mesh, options).coordinates);
    const QualitySummary start = summary_of(valid, valid.coordinates());
    ASSERT_EQ(start.invalid, 0);
    options.improves = true;
    const Coordinates all = untangle_guaranteed(mesh, options).coordinates;
    options.improve_work = 1e4;  // some 30 elements
    const Coordinates few = untangle_guaranteed(mesh, options).coordinates;
    const auto moved = [&](const Coordinates& x) {
        Index count = 0;
        for (Eigen::Index node = 0; node < x.rows(); ++node) count += x.row(node) != valid.coordinates().row(node);
        return count;
    };
    EXPECT_GT(moved(few), 0);
    EXPECT_LT(moved(few), moved(all) / 2);
    EXPECT_GT(summary_of(valid, few).min, start.min);
    EXPECT_GT(summary_of(valid, all).min, summary_of(valid, few).min);
    options.improve_work = 0.0;
    EXPECT_THROW(untangle_guaranteed(valid, options), InvalidInput);
}

TEST(GuaranteedSteps, TheUnitOfLengthAndTheOriginDoNotMatter) {
    for (const GuaranteedOptions& options : {GuaranteedOptions{}, sliding()}) {
        const CurvedMesh mesh = tangled_square(4);
        const GuaranteedResult result = untangle_guaranteed(mesh, options);
        const double least = summary_of(mesh, result.coordinates).min;
        EXPECT_TRUE(result.unmended.empty());
        const auto expect_same = [&](const CurvedMesh& moved, double unit) {
            const GuaranteedResult other = untangle_guaranteed(moved, options);
            EXPECT_TRUE(other.unmended.empty()) << unit;
            EXPECT_NEAR(summary_of(moved, other.coordinates).min, least, 5e-3) << unit;
            EXPECT_NEAR(other.largest_boundary_distance / unit, result.largest_boundary_distance, 1e-8) << unit;
        };
        for (const double unit : {1e-6, 1e6}) expect_same(mesh.with_coordinates(unit * mesh.coordinates()), unit);
        Coordinates shifted = mesh.coordinates();
        shifted.col(0).array() += 1e6;
        shifted.col(1).array() -= 1e6;
        expect_same(mesh.with_coordinates(shifted), 1.0);
    }
}

}  // namespace
}  // namespace curvewright
