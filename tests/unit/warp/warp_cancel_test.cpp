#include <cmath>

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/warp/warp.h"
#include "tests/support/mesh_factory.h"

namespace curvewright {
namespace {

struct Case {
    const char* name;
    Weighting weighting;
    SolverChoice solver;
    int max_iterations;
    std::vector<std::string> phases;
};

class WarpCancel : public ::testing::TestWithParam<Case> {
  protected:
    WarpCancel() : mesh_(testing::square_mesh(14, 3)), target_(mesh_.coordinates()) {
        target_.col(1) += 0.1 * (3.0 * target_.col(0)).array().sin().matrix();
        options_.weighting = GetParam().weighting;
        options_.solver = GetParam().solver;
        options_.max_iterations = GetParam().max_iterations;
        options_.custom_weights = convex_weighting(2.0);
    }
    CurvedMesh mesh_;
    Coordinates target_;
    WarpOptions options_;
};

TEST_P(WarpCancel, TellsItsPhasesAndStopsInEach) {
    std::vector<std::string> phases;
    double last = 0.0;
    warp(mesh_, target_, options_, {{}, [&](std::string_view phase, double fraction) {
                                        if (phases.empty() || phases.back() != phase) {
                                            phases.emplace_back(phase);
                                            last = 0.0;
                                        }
                                        EXPECT_GE(fraction, last);
                                        EXPECT_LE(fraction, 1.0);
                                        last = fraction;
                                    }});
    EXPECT_EQ(phases, GetParam().phases);
    for (std::size_t target = 0; target < phases.size(); ++target) {
        std::stop_source source;
        std::vector<std::string> seen;
        const ProgressCallback stop = [&](std::string_view phase, double) {
            if (seen.empty() || seen.back() != phase) seen.emplace_back(phase);
            if (seen.size() == target + 1) source.request_stop();
        };
        EXPECT_THROW(warp(mesh_, target_, options_, {source.get_token(), stop}), Cancelled) << phases[target];
        EXPECT_EQ(seen.size(), target + 1);
    }
}

TEST_P(WarpCancel, StopsBeforeItBeginsAndAWarperSurvives) {
    std::stop_source source;
    source.request_stop();
    EXPECT_THROW(Warper(mesh_, options_, {source.get_token(), {}}), Cancelled);
    const Warper warper(mesh_, options_);
    if (GetParam().solver != SolverChoice::direct) {
        EXPECT_THROW(warper.move(target_, {source.get_token(), {}}), Cancelled);
    }
    EXPECT_EQ(warper.move(target_).coordinates, warp(mesh_, target_, options_).coordinates);
}

const std::vector<std::string> usual{"Finding neighbours", "Computing weights", "Preparing the solver", "Solving"};
const std::vector<std::string> direct{"Finding neighbours", "Computing weights", "Factorising"};

INSTANTIATE_TEST_SUITE_P(Weightings, WarpCancel,
                         ::testing::Values(Case{"convex", Weighting::convex, SolverChoice::iterative, 500, usual},
                                           Case{"affine", Weighting::affine, SolverChoice::iterative, 500, usual},
                                           Case{"custom", Weighting::custom, SolverChoice::iterative, 500, usual},
                                           Case{"elastic",
                                                Weighting::elastic,
                                                SolverChoice::iterative,
                                                500,
                                                {"Finding neighbours", "Assembling the elastic body",
                                                 "Preparing the solver", "Solving"}},
                                           Case{"convex_direct", Weighting::convex, SolverChoice::direct, 500, direct},
                                           Case{"elastic_direct",
                                                Weighting::elastic,
                                                SolverChoice::direct,
                                                500,
                                                {"Finding neighbours", "Assembling the elastic body", "Factorising"}},
                                           Case{"convex_falling_back",
                                                Weighting::convex,
                                                SolverChoice::automatic,
                                                1,
                                                {"Finding neighbours", "Computing weights", "Preparing the solver",
                                                 "Solving", "Factorising"}}),
                         [](const auto& test) { return std::string(test.param.name); });

}  // namespace
}  // namespace curvewright
