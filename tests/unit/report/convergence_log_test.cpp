#include "core/report/convergence_log.h"

#include <gtest/gtest.h>

#include "core/base/parallel.h"
#include "core/quality/quality.h"
#include "core/report/untangle_run.h"
#include "tests/support/mesh_factory.h"

namespace curvewright {
namespace {

namespace event = untangle_event;

TEST(Thinned, KeepsAllAsLongAsThereIsRoom) {
    Thinned<int> list(4);
    EXPECT_TRUE(list.values().empty());
    for (int i = 0; i < 4; ++i) list.add(i);
    EXPECT_EQ(list.values(), (std::vector<int>{0, 1, 2, 3}));
}

TEST(Thinned, ThenASelectionAndTheLast) {
    Thinned<int> list(4);
    for (int i = 0; i < 5; ++i) list.add(i);
    EXPECT_EQ(list.values(), (std::vector<int>{0, 2, 4}));
    list.add(5);
    EXPECT_EQ(list.values(), (std::vector<int>{0, 2, 4, 5}));
    list.add(6);
    EXPECT_EQ(list.values(), (std::vector<int>{0, 2, 4, 6}));
    for (int count = 8; count < 3000; ++count) {
        list.add(count - 1);
        const std::vector<int> values = list.values();
        ASSERT_LE(values.size(), 5u);
        ASSERT_GE(values.size(), 3u);
        ASSERT_EQ(values.front(), 0);
        ASSERT_EQ(values.back(), count - 1);
        ASSERT_EQ(list.count(), static_cast<std::size_t>(count));
        for (std::size_t i = 2; i + 1 < values.size(); ++i) ASSERT_EQ(values[i] - values[i - 1], values[1] - values[0]);
    }
}

TEST(ConvergenceLog, AddsUpWhatItHears) {
    const CurvedMesh mesh = testing::square_mesh(1, 2);
    ConvergenceLog log;
    log.on_event(event::Started{&mesh});
    log.on_event(event::PassBegan{1});
    log.on_event(event::PatchBegan{{1, 2}, {0, 1}, {}});
    event::EnergyStep step;
    step.round = 1;
    step.iteration = 1;
    step.objective = 9.0;
    step.least_determinant = -1.0;
    log.on_event(step);
    step.iteration = 2;
    step.objective = 7.0;
    log.on_event(step);
    step.round = 2;
    step.iteration = 1;
    step.objective = 5.0;
    step.least_determinant = 0.25;
    log.on_event(step);
    log.on_event(event::PatchCertified{2, 1, -0.5, 0, {}});
    log.on_event(event::PatchCertified{3, 0, 0.75, 0, {}});  // of a round without a step
    event::PatchEnded ended;
    ended.iterations = 3;
    ended.objective_before = 10.0;
    ended.objective_after = 4.0;
    ended.min_scaled_jacobian_before = -2.0;
    ended.min_scaled_jacobian_after = 0.75;
    log.on_event(ended);
    log.on_event(event::PatchBegan{{3}, {1}, {}});
    ended.objective_before = 1.0;
    ended.objective_after = 0.5;
    log.on_event(ended);
    event::PassEnded pass;
    pass.pass = 1;
    pass.min_scaled_jacobian = 0.75;
    pass.undecided = 1;
    log.on_event(pass);
    log.on_event(event::Finished{StopReason::converged, 1});

    ASSERT_EQ(log.passes().count(), 1u);
    const convergence::Pass told = log.passes().values().front();
    EXPECT_EQ(told.patches, 2);
    EXPECT_EQ(told.minimisations, 4);  // three rounds, and a patch of a method without rounds
    EXPECT_EQ(told.iterations, 6);
    EXPECT_EQ(told.objective_before, 11.0);
    EXPECT_EQ(told.objective_after, 4.5);
    EXPECT_EQ(told.min_scaled_jacobian, 0.75);
    EXPECT_EQ(told.undecided, 1);

    const auto patches = log.patches().values();
    ASSERT_EQ(patches.size(), 2u);
    EXPECT_EQ(patches[0].nodes, 2);
    EXPECT_EQ(patches[0].elements, 2);
    EXPECT_EQ(patches[0].minimisations, 3);
    EXPECT_EQ(patches[0].min_scaled_jacobian_before, -2.0);
    EXPECT_EQ(patches[1].patch, 2);

    const auto rounds = log.rounds().values();
    ASSERT_EQ(rounds.size(), 3u);
    EXPECT_EQ(rounds[0].iterations, 2);
    EXPECT_EQ(rounds[0].objective, 7.0);
    EXPECT_EQ(rounds[0].least_determinant, -1.0);
    EXPECT_FALSE(rounds[0].not_valid);
    EXPECT_EQ(rounds[1].not_valid, 1);
    EXPECT_EQ(rounds[1].min_scaled_jacobian, -0.5);
    EXPECT_FALSE(rounds[2].objective);
    EXPECT_EQ(rounds[2].not_valid, 0);
    EXPECT_EQ(rounds[2].round, 3);
}

TEST(ConvergenceLog, BeginsAnewWithAnotherRun) {
    const CurvedMesh mesh = testing::bulged_square_mesh(3, 3, 0.15);
    ConvergenceLog once, twice;
    run_untangling(mesh, GuaranteedOptions(), &once);
    run_untangling(mesh, GuaranteedOptions(), &twice);
    run_untangling(mesh, GuaranteedOptions(), &twice);
    EXPECT_EQ(once.rounds().count(), twice.rounds().count());
    EXPECT_EQ(once.passes().count(), twice.passes().count());
}

TEST(ConvergenceLog, EndsWhereTheRunEnds) {
    const CurvedMesh mesh = testing::bulged_square_mesh(4, 3, 0.12);
    const QualityReport before = assess_quality(mesh);
    ASSERT_GT(before.summary.invalid, 0);
    for (const UntangleOptions& options :
         std::initializer_list<UntangleOptions>{GuaranteedOptions(), SignedAngleOptions(), UnsignedAngleOptions()}) {
        ConvergenceLog log;
        const UntangleRun run = run_untangling(mesh, options, &log);
        EXPECT_EQ(run.coordinates, run_untangling(mesh, options).coordinates);
        QualityOptions sign;
        sign.orientation_sign = before.orientation_sign;
        const QualityReport after = assess_quality(mesh.with_coordinates(run.coordinates), sign);
        ASSERT_GT(log.passes().count(), 0u);
        const convergence::Pass last = log.passes().values().back();
        EXPECT_EQ(last.min_scaled_jacobian, after.summary.min);
        EXPECT_EQ(last.invalid, after.summary.invalid);
        EXPECT_EQ(last.undecided, after.summary.undecided);
        if (std::holds_alternative<GuaranteedOptions>(options))
            EXPECT_GE(log.rounds().count(), static_cast<std::size_t>(run.rounds));
        else
            EXPECT_EQ(log.passes().count(), static_cast<std::size_t>(run.passes));
    }
}

TEST(ObserverFan, TellsEverybody) {
    ObserverFan fan;
    EXPECT_EQ(fan.observer(), nullptr);
    fan.add(nullptr);
    EXPECT_EQ(fan.observer(), nullptr);
    ConvergenceLog one, two;
    fan.add(&one);
    fan.add(&two);
    run_untangling(testing::bulged_square_mesh(3, 3, 0.15), GuaranteedOptions(), fan.observer());
    EXPECT_GT(one.rounds().count(), 0u);
    EXPECT_EQ(one.rounds().count(), two.rounds().count());
}

}  // namespace
}  // namespace curvewright
