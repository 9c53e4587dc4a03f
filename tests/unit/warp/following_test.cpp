// Boundary nodes that follow: the mesh as if it went on behind them.

#include <cmath>

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/warp/response.h"
#include "tests/support/mesh_factory.h"

namespace curvewright {
namespace {

using namespace curvewright::testing;

std::vector<Index> group(const CurvedMesh& mesh, const char* name) {
    return mesh.topology().find_group_nodes(name).value();
}

/// Boundary nodes at none of two opposite sides x = 0 and x = 1.
std::vector<Index> lateral_nodes(const CurvedMesh& mesh) {
    std::vector<Index> nodes;
    for (const Index node : mesh.topology().boundary_nodes()) {
        const double x = mesh.coordinates()(node, 0);
        if (x > 0.0 && x < 1.0) nodes.push_back(node);
    }
    return nodes;
}

struct Case {
    const char* name;
    CurvedMesh mesh;
};

std::vector<Case> cases() {
    return {{"P1 triangles", square_mesh(4, 1)},    {"P3 triangles", square_mesh(4, 3)},
            {"P2 quadrilaterals", quad_mesh(4, 2)}, {"P2 tetrahedra", cube_mesh(3, 2)},
            {"P2 hexahedra", hex_mesh(3, 2)},       {"mixed", mixed_square_mesh(4, 3)}};
}

TEST(FollowingBoundary, StretchesLikeABarBetweenTwoEnds) {
    // Along x the displacement x (0.1, 0.02, -0.03) has no derivative across the lateral sides: it is the solution for
    // every weighting that reproduces places along the boundary.
    for (const auto& [name, mesh] : cases())
        for (const Weighting weighting : {Weighting::convex, Weighting::affine}) {
            WarpOptions options;
            options.weighting = weighting;
            options.following_nodes = lateral_nodes(mesh);
            ASSERT_FALSE(options.following_nodes.empty());
            const Warper warper(mesh, options);
            const bool is_flat = mesh.topology().dimension() == 2;
            const Eigen::RowVector3d pull(0.1, 0.02, is_flat ? 0.0 : -0.03);
            Coordinates wanted = mesh.coordinates(), boundary = mesh.coordinates();
            for (Index node = 0; node < wanted.rows(); ++node) wanted.row(node) += mesh.coordinates()(node, 0) * pull;
            for (const Index node : warper.given_nodes()) boundary.row(node) = wanted.row(node);
            const WarpResult result = warper.move(boundary);
            EXPECT_LT((result.coordinates - wanted).cwiseAbs().maxCoeff(), 1e-9) << name << " " << to_string(weighting);
            EXPECT_TRUE(result.report.outside_hull.empty() || weighting == Weighting::affine) << name;
        }
}

TEST(FollowingBoundary, TranslationsAreExactAndWeightsStayConvex) {
    std::mt19937 random(3);
    const CurvedMesh mesh = with_shaken_corners(square_mesh(5, 1), 0.04, 3, random);
    WarpOptions options;
    // All but one side.
    for (const Index node : mesh.topology().boundary_nodes()) options.following_nodes.push_back(node);
    for (const Index node : group(mesh, "left")) std::erase(options.following_nodes, node);
    const Warper warper(mesh, options);
    EXPECT_TRUE(warper.setup_report().outside_hull.empty());
    EXPECT_EQ(warper.given_nodes(), group(mesh, "left"));
    Coordinates boundary = mesh.coordinates();
    for (const Index node : warper.given_nodes()) boundary.row(node) += Eigen::RowVector3d(0.3, -0.7, 0.0);
    const Coordinates moved = warper.move(boundary).coordinates;
    const Coordinates shift = moved - mesh.coordinates();
    EXPECT_LT((shift.rowwise() - Eigen::RowVector3d(0.3, -0.7, 0.0)).cwiseAbs().maxCoeff(), 1e-12);

    // Positive weights: nobody moves farther than those who are moved.
    for (const Index node : warper.given_nodes())
        boundary(node, 1) = mesh.coordinates()(node, 1) + 0.1 * std::sin(9.0 * mesh.coordinates()(node, 1));
    const Coordinates bent = warper.move(boundary).coordinates - mesh.coordinates();
    EXPECT_LE(bent.col(1).maxCoeff(), 0.1 + 1e-12);
    EXPECT_GE(bent.col(1).minCoeff(), -0.1 - 1e-12);
}

TEST(FollowingBoundary, AnElasticBodyIsPulledAtOneEnd) {
    const CurvedMesh mesh = square_mesh(4, 2);
    WarpOptions options;
    options.weighting = Weighting::elastic;
    options.poisson_ratio = 0.0;  // no contraction: x (0.1, 0) has no forces at the lateral sides
    options.following_nodes = lateral_nodes(mesh);
    const Warper warper(mesh, options);
    Coordinates wanted = mesh.coordinates(), boundary = mesh.coordinates();
    wanted.col(0) *= 1.1;
    for (const Index node : warper.given_nodes()) boundary.row(node) = wanted.row(node);
    EXPECT_LT((warper.move(boundary).coordinates - wanted).cwiseAbs().maxCoeff(), 1e-9);
}

TEST(FollowingBoundary, SomethingMustBeGiven) {
    const CurvedMesh mesh = square_mesh(2, 2);
    WarpOptions options;
    options.following_nodes = mesh.topology().boundary_nodes();
    EXPECT_THROW(Warper(mesh, options), InvalidInput);
    options.following_nodes = {mesh.topology().node_count()};
    EXPECT_THROW(Warper(mesh, options), InvalidInput);
    // Interior nodes follow anyway.
    options.following_nodes = mesh.topology().interior_nodes();
    EXPECT_EQ(Warper(mesh, options).given_nodes(), mesh.topology().boundary_nodes());
}

}  // namespace
}  // namespace curvewright
