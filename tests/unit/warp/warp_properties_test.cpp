// What must hold for every warp, on random meshes, orders and motions.
#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <thread>

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/warp/warp.h"
#include "tests/support/mesh_factory.h"

namespace curvewright {
namespace {

using testing::shaken;

constexpr Weighting weightings[] = {Weighting::convex, Weighting::affine, Weighting::elastic};

WarpOptions with(Weighting weighting) {
    WarpOptions options;
    options.weighting = weighting;
    return options;
}

/// A smooth random motion of the boundary of size about amplitude.
Coordinates random_motion(const CurvedMesh& mesh, double amplitude, std::mt19937& random) {
    std::uniform_real_distribution<double> uniform(-1.0, 1.0);
    Coordinates x = mesh.coordinates();
    for (int d = 0; d < mesh.topology().dimension(); ++d)
        for (int wave = 0; wave < 3; ++wave) {
            const Eigen::Vector3d k = 4.0 * Eigen::Vector3d(uniform(random), uniform(random), uniform(random));
            x.col(d) += amplitude * uniform(random) * (mesh.coordinates() * k).array().sin().matrix();
        }
    return x;
}

/// A curved mesh of a random shape and order.
CurvedMesh random_mesh(std::mt19937& random) {
    const int kind = static_cast<int>(random() % 5), order = 1 + static_cast<int>(random() % (kind < 2 ? 6 : 3));
    const CurvedMesh straight = kind == 0   ? testing::square_mesh(4, order)
                                : kind == 1 ? testing::quad_mesh(4, order)
                                : kind == 2 ? testing::cube_mesh(2, order)
                                : kind == 3 ? testing::hex_mesh(2, order)
                                            : testing::prism_mesh(2, order);
    return shaken(straight, 0.06 / order, random);
}

TEST(WarpProperties, ConvexInteriorStaysInTheHullOfTheBoundary) {
    std::mt19937 random(1);
    std::normal_distribution<double> normal;
    for (int trial = 0; trial < 40; ++trial) {
        const CurvedMesh mesh = random_mesh(random);
        const Coordinates target = random_motion(mesh, std::pow(10.0, trial % 4 - 2), random);
        const WarpResult result = warp(mesh, target);
        if (!result.report.outside_hull.empty()) continue;
        // In every direction the extreme nodes are of the boundary.
        for (int direction = 0; direction < 40; ++direction) {
            const Eigen::Vector3d n = Eigen::Vector3d(normal(random), normal(random), normal(random)).normalized();
            const Eigen::VectorXd height = result.coordinates * n;
            double low = std::numeric_limits<double>::infinity(), high = -low;
            for (const Index node : mesh.topology().boundary_nodes()) {
                low = std::min(low, height[node]);
                high = std::max(high, height[node]);
            }
            const double slack = 1e-9 * (high - low);
            for (const Index node : mesh.topology().interior_nodes()) {
                ASSERT_GT(height[node], low - slack) << trial;
                ASSERT_LT(height[node], high + slack) << trial;
            }
        }
    }
}

TEST(WarpProperties, InteriorDependsLinearlyOnTheBoundary) {
    std::mt19937 random(2);
    for (int trial = 0; trial < 12; ++trial) {
        const CurvedMesh mesh = random_mesh(random);
        for (const Weighting weighting : weightings) {
            const Warper warper(mesh, with(weighting));
            const Coordinates& x = mesh.coordinates();
            const Coordinates a = random_motion(mesh, 0.3, random), b = random_motion(mesh, 0.1, random);
            const Coordinates together = x + (a - x) - 2.5 * (b - x);
            const Coordinates expected = x + (warper.move(a).coordinates - x) - 2.5 * (warper.move(b).coordinates - x);
            EXPECT_LT((warper.move(together).coordinates - expected).cwiseAbs().maxCoeff(), 1e-9)
                << to_string(weighting);
        }
    }
}

TEST(WarpProperties, BoundaryIsTakenBitForBit) {
    std::mt19937 random(3);
    for (int trial = 0; trial < 12; ++trial) {
        const CurvedMesh mesh = random_mesh(random);
        const Coordinates target = random_motion(mesh, 3.0, random);
        Coordinates nonsense = target;
        for (const Index node : mesh.topology().interior_nodes())
            nonsense.row(node).setConstant(std::numeric_limits<double>::quiet_NaN());
        for (const Weighting weighting : weightings) {
            const Coordinates moved = warp(mesh, target, with(weighting)).coordinates;
            for (const Index node : mesh.topology().boundary_nodes()) EXPECT_EQ(moved.row(node), target.row(node));
            EXPECT_EQ(warp(mesh, nonsense, with(weighting)).coordinates, moved);
        }
    }
}

TEST(WarpProperties, CondensationAndSolversDoNotChangeTheResult) {
    std::mt19937 random(4);
    for (const CurvedMesh& straight : {testing::square_mesh(6, 4), testing::quad_mesh(6, 3), testing::cube_mesh(2, 4),
                                       testing::hex_mesh(2, 3), testing::prism_mesh(2, 3)}) {
        const CurvedMesh mesh = shaken(straight, 0.01, random);
        const Coordinates target = random_motion(mesh, 0.2, random);
        for (const Weighting weighting : weightings) {
            WarpOptions options = with(weighting);
            options.solver = SolverChoice::iterative;
            const WarpResult reference = warp(mesh, target, options);
            EXPECT_GT(reference.report.condensed_nodes, 0);
            EXPECT_GT(reference.report.iterations, 0);
            for (const bool condense : {false, true})
                for (const SolverChoice solver : {SolverChoice::iterative, SolverChoice::direct}) {
                    options.condense = condense;
                    options.solver = solver;
                    options.ordering = Ordering::minimum_degree;
                    const WarpResult result = warp(mesh, target, options);
                    EXPECT_LT((result.coordinates - reference.coordinates).cwiseAbs().maxCoeff(), 1e-9)
                        << to_string(weighting) << " " << to_string(solver) << " " << condense;
                    EXPECT_EQ(result.report.condensed_nodes > 0, condense);
                    EXPECT_EQ(result.report.solver, solver);
                }
        }
    }
}

TEST(WarpProperties, SameBitsForEveryThreadCount) {
    std::mt19937 random(5);
    for (const CurvedMesh& straight : {testing::square_mesh(32, 3), testing::cube_mesh(5, 2)}) {
        const CurvedMesh mesh = shaken(straight, 0.003, random);
        const Coordinates target = random_motion(mesh, 0.1, random);
        for (const Weighting weighting : weightings) {
            std::vector<Coordinates> results;
            for (const int threads : {1, 2, 4}) {
                set_thread_count(threads);
                WarpOptions options = with(weighting);
                options.solver = SolverChoice::iterative;
                results.push_back(warp(mesh, target, options).coordinates);
            }
            set_thread_count(0);
            EXPECT_EQ(results[0], results[1]) << to_string(weighting);
            EXPECT_EQ(results[0], results[2]) << to_string(weighting);
        }
    }
}

TEST(WarpProperties, AWarperServesManyPositionsAndThreads) {
    std::mt19937 random(6);
    for (const CurvedMesh& straight : {testing::square_mesh(10, 3), testing::cube_mesh(3, 2)}) {
        const CurvedMesh mesh = shaken(straight, 0.005, random);
        for (const Weighting weighting : weightings) {
            const Warper warper(mesh, with(weighting));
            std::vector<Coordinates> targets, fresh, again(4);
            for (int i = 0; i < 4; ++i) {
                targets.push_back(random_motion(mesh, 0.1 * (i + 1), random));
                fresh.push_back(warp(mesh, targets.back(), with(weighting)).coordinates);
            }
            for (std::size_t i = 4; i-- > 0;) EXPECT_EQ(warper.move(targets[i]).coordinates, fresh[i]);
            {
                std::vector<std::jthread> threads;
                for (std::size_t i = 0; i < 4; ++i)
                    threads.emplace_back([&, i] { again[i] = warper.move(targets[i]).coordinates; });
            }
            for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(again[i], fresh[i]);
        }
    }
}

TEST(WarpProperties, ExtendCarriesAnyNumberOfMotions) {
    std::mt19937 random(7);
    for (const CurvedMesh& mesh : {testing::square_mesh(5, 2), testing::cube_mesh(2, 2)})
        for (const Weighting weighting : weightings) {
            const Warper warper(mesh, with(weighting));
            const int dim = mesh.topology().dimension(), fields = warper.fields_per_motion();
            EXPECT_EQ(fields, weighting == Weighting::elastic ? dim : 1);
            // Two motions side by side, and what move makes of each.
            MultiVector motions(mesh.topology().node_count(), 2 * dim);
            std::vector<Coordinates> targets;
            for (int m = 0; m < 2; ++m) {
                targets.push_back(random_motion(mesh, 0.2, random));
                motions.middleCols(m * dim, dim) = (targets.back() - mesh.coordinates()).leftCols(dim);
            }
            SolveReport report;
            const MultiVector extended = warper.extend(motions, report);
            for (int m = 0; m < 2; ++m) {
                const Coordinates moved = warper.move(targets[static_cast<std::size_t>(m)]).coordinates;
                EXPECT_LT((extended.middleCols(m * dim, dim) - (moved - mesh.coordinates()).leftCols(dim))
                              .cwiseAbs()
                              .maxCoeff(),
                          1e-10);
            }
            EXPECT_THROW(warper.extend(MultiVector::Zero(3, dim), report), InvalidInput);
            if (fields > 1) {
                EXPECT_THROW(warper.extend(MultiVector::Zero(mesh.topology().node_count(), dim + 1), report),
                             InvalidInput);
            }
        }
}

TEST(WarpProperties, PrescribedNodesOutsideTheMeshAreRefused) {
    const CurvedMesh mesh = testing::square_mesh(3, 2);
    for (const Index node : {Index{-1}, mesh.topology().node_count(), Index{1000000000}}) {
        WarpOptions options;
        options.prescribed_nodes = {node};
        EXPECT_THROW(Warper(mesh, options), InvalidInput) << node;
    }
}

TEST(WarpProperties, PrescribedNodesInsideElementsAndTwiceOrOnTheBoundary) {
    const CurvedMesh mesh = testing::square_mesh(3, 4);
    Coordinates target = mesh.coordinates();
    target.col(1) += 0.1 * target.col(0).cwiseAbs2();
    for (const Weighting weighting : weightings) {
        WarpOptions options = with(weighting);
        const auto& interior = mesh.topology().interior_nodes();
        for (std::size_t i = 0; i < interior.size(); i += 3) options.prescribed_nodes.push_back(interior[i]);
        options.prescribed_nodes.push_back(interior[0]);
        options.prescribed_nodes.push_back(mesh.topology().boundary_nodes()[2]);
        const WarpResult condensed = warp(mesh, target, options);
        for (const Index node : options.prescribed_nodes) EXPECT_EQ(condensed.coordinates.row(node), target.row(node));
        options.condense = false;
        EXPECT_LT((warp(mesh, target, options).coordinates - condensed.coordinates).cwiseAbs().maxCoeff(), 1e-11);
    }
}

}  // namespace
}  // namespace curvewright
