#include "core/timeline/explanation.h"

#include <algorithm>
#include <numbers>

#include <gtest/gtest.h>

#include "core/basis/lagrange.h"
#include "core/timeline/landscape.h"
#include "tests/unit/timeline/runs.h"

namespace curvewright {
namespace {

namespace event = untangle_event;

Eigen::RowVector3d row(const event::Position& position) {
    return {position[0], position[1], position[2]};
}

/// The first steps of a kind, one per patch.
std::vector<StepNumber> steps_of(const Recording& recording, StepKind kind, std::size_t count) {
    std::vector<StepNumber> steps;
    std::optional<std::size_t> patch;
    for (StepNumber step = 0; step < recording.step_count() && steps.size() < count; ++step) {
        if (recording.kind(step) != kind || recording.patch_of(step) == patch) continue;
        patch = recording.patch_of(step);
        steps.push_back(step + 1 < recording.step_count() && recording.kind(step + 1) == kind ? step + 1 : step);
    }
    return steps;
}

TEST(StepExplainer, ShowsTheAnglesThatTheMethodSaw) {
    for (const int run : {0, 2, 3}) {
        const auto recording = testing::record(testing::runs()[static_cast<std::size_t>(run)]);
        SCOPED_TRACE(testing::runs()[static_cast<std::size_t>(run)].name);
        TimelineCursor cursor(recording);
        StepExplainer explainer;
        const StepKind kind = run == 3 ? StepKind::bfgs_step : StepKind::simplex_step;
        const auto steps = steps_of(*recording, kind, 30);
        ASSERT_GT(steps.size(), 5u);
        for (const StepNumber step : steps) {
            cursor.seek(step);
            const StepExplanation explanation = explainer.explain(cursor);
            ASSERT_EQ(explanation.angles.size(), 4u);
            const auto& seen = run == 3 ? explanation.bfgs->angles : explanation.simplex->angles;
            for (std::size_t i = 0; i < 4; ++i) {
                const AngleMark& mark = explanation.angles[i];
                EXPECT_NEAR(run == 3 ? std::abs(mark.signed_angle) : mark.signed_angle, seen[i], 1e-6);
                EXPECT_NEAR(mark.edge_tangent.dot(mark.other_tangent), std::cos(mark.signed_angle), 1e-12);
                const auto nodes = recording->mesh().topology().element_nodes(mark.triangle);
                EXPECT_TRUE(std::any_of(nodes.begin(), nodes.begin() + 3, [&](Index node) {
                    return cursor.coordinates().row(node) == row(mark.corner);
                }));
            }
            EXPECT_EQ(cursor.coordinates().row(*explanation.focus), row(explanation.path.back()));
            EXPECT_EQ(explanation.convergence.size(),
                      static_cast<std::size_t>(std::count_if(
                          explanation.convergence.begin(), explanation.convergence.end(),
                          [&](const ConvergencePoint& point) { return recording->kind(point.step) == kind; })));
            EXPECT_GT(explanation.convergence.size(), 1u);
        }
    }
}

TEST(StepExplainer, NamesTheWorstPlaceOfThePatch) {
    for (const std::size_t run : {5u, 6u}) {
        const auto recording = testing::record(testing::runs()[run]);
        TimelineCursor cursor(recording);
        StepExplainer explainer;
        const auto steps = steps_of(*recording, StepKind::patch_certified, 5);
        ASSERT_FALSE(steps.empty());
        for (const StepNumber step : steps) {
            cursor.seek(step);
            const StepExplanation explanation = explainer.explain(cursor);
            ASSERT_TRUE(explanation.certificate && explanation.energy);
            EXPECT_EQ(explanation.method, UntangleMethod::guaranteed);
            // Displacements are kept in single precision.
            EXPECT_NEAR(explanation.certificate->min_scaled_jacobian, explanation.worst_scaled_jacobian, 1e-3);
            ASSERT_TRUE(explanation.focus);
            EXPECT_TRUE(std::count(explanation.nodes.begin(), explanation.nodes.end(), *explanation.focus));
            EXPECT_EQ(explanation.path.size() > 1, true);
        }
        cursor.seek(0);
        EXPECT_FALSE(explainer.explain(cursor).method);
    }
}

TEST(PatchTrial, LeadsWhereTheMethodWentWithItsOwnParameters) {
    UnsignedAngleOptions one_attempt;
    one_attempt.first_steps = {0.01};
    one_attempt.tries_straight_edge = one_attempt.moves_face_nodes = one_attempt.is_guarded = false;
    one_attempt.target = 0.0;
    one_attempt.max_passes = 2;
    SignedAngleOptions given;
    given.beta = 0.3;
    given.max_passes = 2;
    for (const UntangleOptions& options : {UntangleOptions(given), UntangleOptions(one_attempt)}) {
        const testing::Run run{"", testing::bulged_square_mesh(4, 3, 0.12), options};
        const auto recording = testing::record(run);
        TimelineCursor cursor(recording);
        StepExplainer explainer;
        ASSERT_GT(recording->patches().size(), 3u);
        for (std::size_t i = 0; i < std::min<std::size_t>(20, recording->patches().size()); ++i) {
            const RecordedPatch& patch = recording->patches()[i];
            cursor.seek(patch.first);
            const StepExplanation explanation = explainer.explain(cursor);
            PatchTrial trial(run.mesh.with_coordinates(cursor.coordinates()), cursor.quality().orientation_sign,
                             *explanation.method, options, explanation.elements, *explanation.focus,
                             row(explanation.focus_start), run.mesh.coordinates());
            const PatchTrial::Outcome outcome = trial.outcome({.beta = 0.3, .first_step = 0.01});
            const auto ended = std::get<event::PatchEnded>(recording->read(patch.last));
            EXPECT_EQ(outcome.position, row(ended.positions[0])) << "patch " << i;
            EXPECT_EQ(outcome.min_scaled_jacobian, ended.min_scaled_jacobian_after);
            EXPECT_NEAR(outcome.objective, ended.objective_after, 1e-12 * std::abs(ended.objective_after));
            EXPECT_EQ(outcome.path.front(), row(explanation.focus_start));
        }
    }
}

TEST(PatchTrial, ItsHeightsAreTheMethodsObjective) {
    const testing::Run run = testing::runs()[0];
    const auto recording = testing::record(run);
    TimelineCursor cursor(recording);
    StepExplainer explainer;
    for (const StepNumber step : steps_of(*recording, StepKind::simplex_step, 10)) {
        cursor.seek(step);
        const StepExplanation explanation = explainer.explain(cursor);
        PatchTrial trial(run.mesh.with_coordinates(cursor.coordinates()), cursor.quality().orientation_sign,
                         *explanation.method, run.options, explanation.elements, *explanation.focus,
                         row(explanation.focus_start), run.mesh.coordinates());
        for (std::size_t i = 0; i < 3; ++i) {
            const auto& vertex = explanation.simplex->simplex[i];
            EXPECT_NEAR(trial.value({vertex[0], vertex[1], 0.0}, {.beta = 0.5}), explanation.simplex->objective[i],
                        1e-12 * explanation.simplex->objective[i]);
        }
        const Eigen::RowVector3d across(0.1, 0, 0), up(0, 0.1, 0);
        const Landscape landscape = trial.landscape(row(explanation.focus_start), across, up, 9, {.beta = 0.5});
        EXPECT_EQ(landscape.values(4, 4), trial.value(row(explanation.focus_start), {.beta = 0.5}));
        EXPECT_EQ(landscape.values(0, 8), trial.value(row(explanation.focus_start) + across - up, {.beta = 0.5}));
    }
}

TEST(PatchTrial, TheEnergysMinimumIsLowerThanItsSurroundings) {
    for (const std::size_t number : {5u, 6u}) {
        const testing::Run run = testing::runs()[number];
        const auto recording = testing::record(run);
        TimelineCursor cursor(recording);
        StepExplainer explainer;
        cursor.seek(steps_of(*recording, StepKind::energy_step, 1)[0]);
        const StepExplanation explanation = explainer.explain(cursor);
        PatchTrial trial(run.mesh.with_coordinates(cursor.coordinates()), cursor.quality().orientation_sign,
                         UntangleMethod::guaranteed, run.options, explanation.elements, *explanation.focus,
                         cursor.coordinates().row(*explanation.focus), run.mesh.coordinates());
        for (const double eps : {1e-2, 1.0}) {
            const PatchTrial::Outcome outcome = trial.outcome({.eps = eps});
            EXPECT_GT(outcome.path.size(), 1u);
            EXPECT_NEAR(trial.value(outcome.position, {.eps = eps}), outcome.objective,
                        1e-9 * std::abs(outcome.objective));
            for (int d = 0; d < run.mesh.topology().dimension(); ++d)
                for (const double step : {-0.02, 0.02}) {
                    Eigen::RowVector3d aside = outcome.position;
                    aside[d] += step;
                    EXPECT_GT(trial.value(aside, {.eps = eps}), outcome.objective);
                }
        }
    }
}

TEST(ContourLines, OfAPlaneAreStraightAndOfAConeAreClosed) {
    Eigen::MatrixXd plane(7, 9), cone(41, 41);
    for (int r = 0; r < 7; ++r)
        for (int c = 0; c < 9; ++c) plane(r, c) = 2.0 * r + c;
    const auto straight = contour_lines(plane, 7.3);
    ASSERT_EQ(straight.size(), 1u);
    for (const Eigen::Vector2d& point : straight[0]) EXPECT_NEAR(2.0 * point[0] + point[1], 7.3, 1e-12);
    EXPECT_NE(straight[0].front(), straight[0].back());

    for (int r = 0; r < 41; ++r)
        for (int c = 0; c < 41; ++c) cone(r, c) = std::hypot(r - 20, c - 20);
    const auto round = contour_lines(cone, 12.5);
    ASSERT_EQ(round.size(), 1u);
    EXPECT_EQ(round[0].front(), round[0].back());
    double length = 0.0;
    for (std::size_t i = 1; i < round[0].size(); ++i) {
        EXPECT_NEAR((round[0][i] - Eigen::Vector2d(20, 20)).norm(), 12.5, 0.02);
        length += (round[0][i] - round[0][i - 1]).norm();
    }
    EXPECT_NEAR(length, 25.0 * std::numbers::pi, 0.2);
    EXPECT_EQ(contour_lines(cone, 100.0).size(), 0u);

    // A saddle: two lines that do not cross, whichever side of its height they are on.
    Eigen::MatrixXd saddle(21, 21);
    for (int r = 0; r < 21; ++r)
        for (int c = 0; c < 21; ++c) saddle(r, c) = (r - 10.3) * (c - 9.7);
    for (const double level : {-0.1, 0.1}) EXPECT_EQ(contour_lines(saddle, level).size(), 2u);
    // Where there is no value there are no lines, and nothing fails.
    cone(20, 20) = std::numeric_limits<double>::infinity();
    EXPECT_EQ(contour_lines(cone, 0.5).size(), 0u);
}

TEST(EvenLevels, CutTheValuesIntoEqualParts) {
    Eigen::MatrixXd values(10, 10);
    for (int i = 0; i < 100; ++i) values(i / 10, i % 10) = std::exp(i);
    const auto levels = even_levels(values, 4);
    ASSERT_EQ(levels.size(), 4u);
    for (int i = 0; i < 4; ++i)
        EXPECT_NEAR(static_cast<double>((values.array() <= levels[static_cast<std::size_t>(i)]).count()),
                    20.0 * (i + 1), 1.0);
    values.setConstant(3.0);
    EXPECT_EQ(even_levels(values, 4).size(), 1u);
    // A plateau with rounding errors beside a slope: no line wanders over the plateau.
    for (Eigen::Index r = 0; r < 10; ++r)
        for (Eigen::Index c = 0; c < 10; ++c)
            values(r, c) = c < 6 ? 1.0 + 1e-15 * static_cast<double>((7 * r + 3 * c) % 5) : static_cast<double>(c - 4);
    for (const double level : even_levels(values, 4))
        for (const auto& line : contour_lines(values, level))
            for (const Eigen::Vector2d& point : line) EXPECT_GT(point[1], 5.0);
}

}  // namespace
}  // namespace curvewright
