#include "core/warp/warp.h"

#include <algorithm>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/quality/quality.h"
#include "tests/support/mesh_factory.h"

namespace curvewright {
namespace {

using testing::cube_mesh;
using testing::shaken;
using testing::square_mesh;

/// An affine map of the plane (2D) or of space.
Coordinates affine_image(const CurvedMesh& mesh) {
    Eigen::Matrix3d map;
    map << 1.3, 0.4, 0.0, -0.2, 0.8, 0.0, 0.0, 0.0, 1.0;
    if (mesh.topology().dimension() == 3) {
        map.row(2) << 0.1, -0.3, 1.2;
        map.col(2) << 0.2, 0.1, 1.2;
    }
    Coordinates x = mesh.coordinates() * map.transpose();
    x.rowwise() += Eigen::RowVector3d(5.0, -3.0, mesh.topology().dimension() == 3 ? 2.0 : 0.0);
    return x;
}

TEST(Warp, ReproducesAffineMotionsExactly) {
    std::mt19937 random(1);
    for (const Weighting weighting : {Weighting::convex, Weighting::affine})
        for (const SolverChoice solver : {SolverChoice::iterative, SolverChoice::direct})
            for (int order = 1; order <= 6; ++order) {
                std::vector<CurvedMesh> meshes{shaken(square_mesh(4, order), 0.02, random)};
                if (order <= 4) meshes.push_back(shaken(cube_mesh(2, order), 0.01, random));
                for (const CurvedMesh& mesh : meshes) {
                    WarpOptions options;
                    options.weighting = weighting;
                    options.solver = solver;
                    options.residual_tolerance = 1e-14;
                    const Coordinates target = affine_image(mesh);
                    const WarpResult result = warp(mesh, target, options);
                    EXPECT_LT((result.coordinates - target).cwiseAbs().maxCoeff(), 1e-12 * 6.0)
                        << to_string(weighting) << " " << to_string(solver) << " P" << order;
                    EXPECT_TRUE(result.report.degenerate.empty());
                }
            }
}

TEST(Warp, BoundaryIsTakenBitForBitAndInteriorRowsOfTheInputAreIgnored) {
    std::mt19937 random(2);
    const CurvedMesh mesh = square_mesh(4, 3);
    Coordinates target = mesh.coordinates();
    std::uniform_real_distribution<double> shift(-0.01, 0.01);
    for (Index node : mesh.topology().boundary_nodes()) target(node, 0) += shift(random);
    Coordinates nonsense = target;
    for (Index node : mesh.topology().interior_nodes()) nonsense.row(node).setConstant(77.0);
    const Coordinates x = warp(mesh, target).coordinates, y = warp(mesh, nonsense).coordinates;
    EXPECT_EQ(x, y);
    for (Index node : mesh.topology().boundary_nodes()) EXPECT_EQ(x.row(node), target.row(node));
}

TEST(Warp, ZeroMotionChangesNothing) {
    std::mt19937 random(3);
    const CurvedMesh mesh = shaken(cube_mesh(2, 3), 0.02, random);
    EXPECT_EQ(warp(mesh, mesh.coordinates()).coordinates, mesh.coordinates());
}

TEST(Warp, ConvexWeightsKeepTheInteriorInsideTheHullOfTheBoundary) {
    const CurvedMesh mesh = square_mesh(6, 2);
    Coordinates target = mesh.coordinates();
    for (Index node : mesh.topology().boundary_nodes()) {
        const double x = target(node, 0) - 0.5, y = target(node, 1) - 0.5;
        target(node, 0) += 0.8 * y * y - 0.3 * x;
        target(node, 1) *= 1.7;
    }
    const WarpResult result = warp(mesh, target);
    double low[2] = {1e9, 1e9}, high[2] = {-1e9, -1e9};
    for (Index node : mesh.topology().boundary_nodes())
        for (int d = 0; d < 2; ++d) {
            low[d] = std::min(low[d], target(node, d));
            high[d] = std::max(high[d], target(node, d));
        }
    for (Index node : mesh.topology().interior_nodes())
        for (int d = 0; d < 2; ++d) {
            EXPECT_GT(result.coordinates(node, d), low[d]);
            EXPECT_LT(result.coordinates(node, d), high[d]);
        }
    EXPECT_EQ(assess_quality(mesh.with_coordinates(result.coordinates)).summary.invalid, 0);
}

TEST(Warp, DirectAndIterativeSolversAgree) {
    std::mt19937 random(4);
    const CurvedMesh mesh = shaken(square_mesh(8, 3), 0.01, random);
    Coordinates target = mesh.coordinates();
    for (Index node : mesh.topology().boundary_nodes()) target(node, 1) += 0.2 * std::sin(3 * target(node, 0));
    WarpOptions options;
    options.solver = SolverChoice::direct;
    const WarpResult direct = warp(mesh, target, options);
    options.solver = SolverChoice::iterative;
    const WarpResult iterative = warp(mesh, target, options);
    EXPECT_LT((direct.coordinates - iterative.coordinates).cwiseAbs().maxCoeff(), 1e-10);
    EXPECT_EQ(direct.report.solver, SolverChoice::direct);
    EXPECT_EQ(direct.report.iterations, 0);
    EXPECT_GT(iterative.report.iterations, 0);
    EXPECT_LT(iterative.report.residual, 1e-11);
}

TEST(Warp, AutomaticChoiceFallsBackToTheDirectSolver) {
    std::mt19937 random(5);
    const CurvedMesh mesh = shaken(square_mesh(20, 2), 0.003, random);
    Coordinates target = mesh.coordinates();
    for (Index node : mesh.topology().boundary_nodes()) target(node, 1) += 0.2 * std::sin(3 * target(node, 0));
    WarpOptions options;
    options.max_iterations = 1;
    const WarpResult result = warp(mesh, target, options);
    EXPECT_EQ(result.report.solver, SolverChoice::direct);
    EXPECT_NE(result.report.solver_note.find("The direct solver took over."), std::string::npos);
    options.solver = SolverChoice::iterative;
    EXPECT_THROW(warp(mesh, target, options), SolverFailure);
}

TEST(Warp, SameResultForEveryThreadCount) {
    std::mt19937 random(6);
    const CurvedMesh mesh = shaken(cube_mesh(3, 2), 0.02, random);
    Coordinates target = mesh.coordinates();
    for (Index node : mesh.topology().boundary_nodes()) target(node, 2) += 0.1 * target(node, 0) * target(node, 1);
    set_thread_count(1);
    const Coordinates one = warp(mesh, target).coordinates;
    set_thread_count(4);
    const Coordinates four = warp(mesh, target).coordinates;
    set_thread_count(0);
    EXPECT_EQ(one, four);
}

TEST(Warp, TellsItsPhasesAndCancelsInEach) {
    std::mt19937 random(7);
    const CurvedMesh mesh = shaken(square_mesh(12, 3), 0.005, random);
    Coordinates target_positions = mesh.coordinates();
    for (Index node : mesh.topology().boundary_nodes())
        target_positions(node, 1) += 0.1 * std::sin(target_positions(node, 0));
    std::vector<std::string> phases;
    warp(mesh, target_positions, {}, {{}, [&](std::string_view phase, double) {
                                          if (phases.empty() || phases.back() != phase) phases.emplace_back(phase);
                                      }});
    EXPECT_EQ(phases,
              (std::vector<std::string>{"Finding neighbours", "Computing weights", "Preparing the solver", "Solving"}));
    for (const std::string& target : phases) {
        std::stop_source source;
        const ProgressCallback stop = [&](std::string_view phase, double) {
            if (phase == target) source.request_stop();
        };
        EXPECT_THROW(warp(mesh, target_positions, {}, {source.get_token(), stop}), Cancelled) << target;
    }
}

TEST(Warp, MeshWithoutInteriorMovesItsBoundary) {
    const CurvedMesh mesh = square_mesh(1, 1);
    EXPECT_EQ(warp(mesh, affine_image(mesh)).coordinates, affine_image(mesh));
}

TEST(Warp, PrescribedInteriorNodesGoWhereTheyAreSent) {
    std::mt19937 random(8);
    const CurvedMesh mesh = shaken(square_mesh(6, 2), 0.005, random);
    WarpOptions options;
    Coordinates target = mesh.coordinates();
    for (Index node : mesh.topology().interior_nodes())
        if (std::abs(mesh.coordinates()(node, 0) - 0.5) < 0.06 && std::abs(mesh.coordinates()(node, 1) - 0.5) < 0.26) {
            options.prescribed_nodes.push_back(node);
            target(node, 0) += 0.05;
        }
    ASSERT_GT(options.prescribed_nodes.size(), 3u);
    const WarpResult result = warp(mesh, target, options);
    for (Index node : options.prescribed_nodes) EXPECT_EQ(result.coordinates.row(node), target.row(node));
    for (Index node : mesh.topology().boundary_nodes())
        EXPECT_EQ(result.coordinates.row(node), mesh.coordinates().row(node));
    EXPECT_EQ(result.report.interior_nodes + options.prescribed_nodes.size(), mesh.topology().interior_nodes().size());
    // The neighbours follow: between the given motions, and not by nothing.
    int followed = 0;
    for (Index node : mesh.topology().interior_nodes()) {
        const double motion = result.coordinates(node, 0) - mesh.coordinates()(node, 0);
        EXPECT_GE(motion, -1e-12);
        EXPECT_LE(motion, 0.05 + 1e-12);
        followed += motion > 0.005 && motion < 0.045 ? 1 : 0;
    }
    EXPECT_GT(followed, 10);
    EXPECT_EQ(assess_quality(mesh.with_coordinates(result.coordinates)).summary.invalid, 0);
}

TEST(Warp, RefusesWrongInput) {
    const CurvedMesh mesh = square_mesh(2, 2);
    EXPECT_THROW(warp(mesh, Coordinates::Zero(3, 3)), InvalidInput);
    Coordinates x = mesh.coordinates();
    x(mesh.topology().boundary_nodes().front(), 0) = std::numeric_limits<double>::infinity();
    EXPECT_THROW(warp(mesh, x), InvalidInput);
    WarpOptions options;
    options.distance_power = -1.0;
    EXPECT_THROW(warp(mesh, mesh.coordinates(), options), InvalidInput);
}

}  // namespace
}  // namespace curvewright
