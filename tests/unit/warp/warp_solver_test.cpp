// How the solver copes with the systems of real warps.
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/warp/warp.h"
#include "tests/support/mesh_factory.h"

namespace curvewright {
namespace {

Coordinates bent(const CurvedMesh& mesh) {
    Coordinates x = mesh.coordinates();
    x.col(1) += 0.2 * (3.0 * mesh.coordinates().col(0)).array().sin().matrix();
    x.col(0) += 0.1 * (5.0 * mesh.coordinates().col(1)).array().cos().matrix();
    return x;
}

WarpReport solve(const CurvedMesh& mesh, Weighting weighting) {
    WarpOptions options;
    options.weighting = weighting;
    options.solver = SolverChoice::iterative;
    const WarpReport report = warp(mesh, bent(mesh), options).report;
    EXPECT_LE(report.residual, 1e-11);
    return report;
}

TEST(WarpSolver, IterationsDoNotGrowWithAPlaneMesh) {
    for (const Weighting weighting : {Weighting::convex, Weighting::affine, Weighting::elastic}) {
        std::vector<int> iterations;
        for (const int n : {8, 16, 32, 64})
            iterations.push_back(solve(testing::square_mesh(n, 2), weighting).iterations);
        EXPECT_LE(iterations.back(), iterations.front() + 12) << to_string(weighting);
        EXPECT_LE(iterations.back(), weighting == Weighting::elastic ? 40 : 25) << to_string(weighting);
    }
}

TEST(WarpSolver, IterationsDoNotGrowWithASolidMesh) {
    for (const Weighting weighting : {Weighting::convex, Weighting::affine, Weighting::elastic}) {
        std::vector<int> iterations;
        for (const int n : {3, 6, 9}) iterations.push_back(solve(testing::cube_mesh(n, 2), weighting).iterations);
        EXPECT_LE(iterations.back(), iterations.front() + 10) << to_string(weighting);
        EXPECT_LE(iterations.back(), weighting == Weighting::elastic ? 40 : 25) << to_string(weighting);
    }
}

TEST(WarpSolver, IterationsStayBoundedForHighOrdersAndStretchedMeshes) {
    for (const Weighting weighting : {Weighting::convex, Weighting::elastic}) {
        for (const int order : {1, 3, 5, 8})
            EXPECT_LE(solve(testing::square_mesh(10, order), weighting).iterations,
                      weighting == Weighting::elastic ? 30 * order : 20 + 10 * order)
                << to_string(weighting) << order;
        CurvedMesh mesh = testing::square_mesh(24, 2);
        Coordinates x = mesh.coordinates();
        x.col(1) *= 0.05;
        EXPECT_LE(solve(mesh.with_coordinates(x), weighting).iterations, 150) << to_string(weighting);
    }
}

TEST(WarpSolver, NodesThatAreTiedToNothingButEachOtherAreASolverFailure) {
    // A pair of nodes, each the mean of the other alone, beside nodes that know the boundary.
    const CurvedMesh mesh = testing::square_mesh(6, 2);
    const Index a = mesh.topology().interior_nodes()[10];
    const NeighbourSets sets = find_neighbours(mesh.topology(), {a});
    Index b = -1;
    for (const Index node : sets.nodes)
        if (mesh.topology().is_interior_node(node)) b = node;
    ASSERT_GE(b, 0);
    WarpOptions options;
    options.weighting = Weighting::custom;
    options.custom_weights = [&](const Patch& patch, Eigen::Ref<Eigen::VectorXd> weights) {
        weights.setConstant(1.0 / static_cast<double>(weights.size()));
        if (patch.center != a && patch.center != b) return PatchStatus::regular;
        for (Eigen::Index j = 0; j < weights.size(); ++j)
            weights[j] = patch.neighbours[static_cast<std::size_t>(j)] == (patch.center == a ? b : a) ? 1.0 : 0.0;
        return PatchStatus::regular;
    };
    options.solver = SolverChoice::direct;
    EXPECT_THROW(warp(mesh, bent(mesh), options), SolverFailure);
}

TEST(WarpSolver, ReportsWhatHappened) {
    const CurvedMesh mesh = testing::square_mesh(20, 3);
    const WarpReport report = solve(mesh, Weighting::convex);
    EXPECT_EQ(report.interior_nodes, static_cast<Index>(mesh.topology().interior_nodes().size()));
    EXPECT_EQ(report.condensed_nodes, mesh.topology().element_count());
    EXPECT_EQ(report.solver, SolverChoice::iterative);
    EXPECT_NE(report.solver_note.find("BiCGSTAB with Gauss-Seidel and "), std::string::npos) << report.solver_note;
    EXPECT_NE(report.solver_note.find("over 361 vertices"), std::string::npos) << report.solver_note;
    EXPECT_GE(report.solve_seconds, 0.0);
    EXPECT_NE(solve(mesh, Weighting::elastic).solver_note.find("Conjugate gradients"), std::string::npos);
}

}  // namespace
}  // namespace curvewright
