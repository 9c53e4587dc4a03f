#include "core/boundary/boundary_shape.h"

#include <cmath>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

#include "core/untangle/constrained_objective.h"
#include "tests/support/mesh_factory.h"

namespace curvewright {
namespace {

BoundaryRules all(BoundaryMode mode) {
    BoundaryRules rules;
    rules.otherwise = mode;
    return rules;
}

/// The elements alone, without cells on the boundary, entities and groups.
CurvedMesh without_groups(const CurvedMesh& mesh) {
    MeshData data = mesh.topology().data();
    std::erase_if(data.blocks,
                  [&](const ElementBlock& block) { return dimension(block.type.shape) < mesh.topology().dimension(); });
    for (ElementBlock& block : data.blocks) block.entity_tag = 0;
    data.entities.clear();
    data.groups.clear();
    data.node_entities.clear();
    return {std::make_shared<const MeshTopology>(std::move(data)), mesh.coordinates()};
}

CurvedMesh mapped(const CurvedMesh& mesh, const auto& map) {
    Coordinates x = mesh.coordinates();
    for (Eigen::Index i = 0; i < x.rows(); ++i) x.row(i) = map(Eigen::RowVector3d(x.row(i)));
    return mesh.with_coordinates(x);
}

Eigen::RowVector3d bend(const Eigen::RowVector3d& p) {
    const double pi = std::numbers::pi;
    return p + 0.12 * Eigen::RowVector3d(std::sin(pi * p[1]), std::sin(pi * p[2]), std::sin(pi * p[0]));
}

int sides_of_cube(const Eigen::RowVector3d& p) {
    int sides = 0;
    for (int d = 0; d < 3; ++d) sides += p[d] == 0.0 || p[d] == 1.0 ? 1 : 0;
    return sides;
}

TEST(BoundaryShape, ACubeHasCornersEdgesAndFaces) {
    for (const int order : {1, 2, 3}) {
        const CurvedMesh cube = testing::cube_mesh(2, order);
        for (const CurvedMesh& mesh : {mapped(cube, bend), without_groups(mapped(cube, bend))}) {
            const BoundaryShape shape(mesh, all(BoundaryMode::slide));
            for (Index node = 0; node < mesh.topology().node_count(); ++node) {
                const int sides = sides_of_cube(cube.coordinates().row(node));
                EXPECT_EQ(shape.may_move(node), sides < 3);
                EXPECT_EQ(shape.slides(node), sides == 1 || sides == 2);
                EXPECT_EQ(shape.sliding_directions(node), sides == 0 ? 0 : 3 - sides);
                if (shape.slides(node)) {
                    EXPECT_LT((shape.position(shape.foot(node)).transpose() - mesh.coordinates().row(node)).norm(),
                              1e-14);
                }
            }
        }
    }
}

TEST(BoundaryShape, HexahedraHaveQuadrilateralsThatSlide) {
    const CurvedMesh cube = testing::hex_mesh(2, 2);
    const CurvedMesh mesh = mapped(cube, bend);
    const BoundaryShape shape(mesh, all(BoundaryMode::slide));
    for (Index node = 0; node < mesh.topology().node_count(); ++node) {
        const int sides = sides_of_cube(cube.coordinates().row(node));
        EXPECT_EQ(shape.sliding_directions(node), sides == 0 ? 0 : 3 - sides);
    }
}

TEST(BoundaryShape, GroupsAndThePointsOfTheFileAreFeaturesOfASmoothCurve) {
    // The unit square's bottom and right side bent into one smooth curve: (0, 0) to (1, 1) by a quarter of a circle.
    const CurvedMesh square = testing::square_mesh(4, 3);
    const auto round = [](const Eigen::RowVector3d& p) -> Eigen::RowVector3d {
        const double angle = (p[0] + p[1]) * std::numbers::pi / 4, radius = 1.0 + 0.5 * (p[0] - p[1]);
        return {radius * std::cos(angle), radius * std::sin(angle), 0.0};
    };
    const CurvedMesh mesh = mapped(square, round);
    Index corner = -1;
    for (Index node = 0; node < square.topology().node_count(); ++node)
        if (square.coordinates()(node, 0) == 1.0 && square.coordinates()(node, 1) == 0.0) corner = node;
    BoundaryRules rules = all(BoundaryMode::slide);
    EXPECT_FALSE(BoundaryShape(mesh, rules).slides(corner)) << "two groups meet there";
    rules.feature_angle = 100.0;  // the mapping leaves a right angle there
    const CurvedMesh bare = without_groups(mesh);
    EXPECT_TRUE(BoundaryShape(bare, rules).slides(corner));
    MeshData data = bare.topology().data();
    data.node_entities.assign(data.node_tags.size(), {2, 1});
    data.node_entities[static_cast<std::size_t>(corner)] = {0, 1};
    const CurvedMesh with_point(std::make_shared<const MeshTopology>(data), mesh.coordinates());
    EXPECT_FALSE(BoundaryShape(with_point, rules).slides(corner));
}

TEST(BoundaryShape, AFacetThatFoldsBackOnItselfIsNoFeature) {
    CurvedMesh mesh = testing::square_mesh(2, 2);
    Coordinates x = mesh.coordinates();
    Index joint = -1;
    for (Index node = 0; node < mesh.topology().node_count(); ++node) {
        if (x(node, 1) != 0.0) continue;
        if (x(node, 0) == 0.5) joint = node;
        if (x(node, 0) == 0.25) x(node, 0) = 0.45;
    }
    const BoundaryShape shape(mesh.with_coordinates(x), all(BoundaryMode::slide));
    EXPECT_TRUE(shape.slides(joint));
}

TEST(BoundaryShape, ProjectingWalksFromPieceToPiece) {
    const CurvedMesh cube = testing::cube_mesh(3, 3);
    const CurvedMesh mesh = mapped(cube, bend);
    const BoundaryShape shape(mesh, all(BoundaryMode::slide));
    std::mt19937 random(4);
    std::vector<std::vector<Index>> faces(6);
    for (const Index node : mesh.topology().boundary_nodes())
        if (shape.sliding_directions(node) == 2)
            for (int d = 0; d < 3; ++d) {
                if (cube.coordinates()(node, d) == 0.0) faces[static_cast<std::size_t>(2 * d)].push_back(node);
                if (cube.coordinates()(node, d) == 1.0) faces[static_cast<std::size_t>(2 * d + 1)].push_back(node);
            }
    for (const auto& face : faces)
        for (int trial = 0; trial < 40; ++trial) {
            const Index from = face[random() % face.size()], to = face[random() % face.size()];
            const Eigen::Vector3d y = mesh.coordinates().row(to).transpose();
            EXPECT_LT(shape.project(y, shape.foot(from)).closest.squared_distance, 1e-20);
        }
}

TEST(BoundaryShape, LargestDistanceIsThatOfTheFacetsThatMoved) {
    const CurvedMesh mesh = testing::square_mesh(2, 2);
    const BoundaryShape shape(mesh, all(BoundaryMode::free));
    EXPECT_EQ(shape.largest_distance(mesh.coordinates()), 0.0);
    Coordinates x = mesh.coordinates();
    for (const Index node : mesh.topology().boundary_nodes())
        if (x(node, 0) == 0.25 && x(node, 1) == 0.0) x(node, 1) = -0.125;  // the middle of a parabola
    EXPECT_NEAR(shape.largest_distance(x), 0.125, 1e-12);
}

TEST(ConstrainedObjective, GradientIsThatOfDifferences) {
    std::mt19937 random(5);
    std::uniform_real_distribution<double> shift(-0.02, 0.02);
    for (const bool is_solid : {false, true}) {
        const CurvedMesh straight = is_solid ? testing::cube_mesh(1, 3) : testing::square_mesh(2, 3);
        const CurvedMesh mesh = mapped(straight, [&](const Eigen::RowVector3d& p) -> Eigen::RowVector3d {
            if (is_solid) return bend(p);
            return {p[0] + 0.1 * std::sin(3 * p[1]), p[1] + 0.1 * std::sin(3 * p[0]), 0.0};
        });
        const BoundaryShape shape(mesh, all(BoundaryMode::slide));
        FreePatch patch;
        std::vector<Foot> feet;
        for (Index e = 0; e < mesh.topology().element_count(); ++e) patch.elements.push_back(e);
        for (Index node = 0; node < mesh.topology().node_count(); ++node)
            if (shape.may_move(node)) {
                patch.nodes.push_back(node);
                if (shape.slides(node)) feet.push_back(shape.foot(node));
            }
        ConstrainedObjective objective(
            PatchObjective(mesh.topology(), mesh.coordinates(), straight.coordinates(), 1.0, patch), &shape,
            mesh.coordinates(), feet);
        Eigen::VectorXd at = objective.start();
        for (double& v : at) v += shift(random);
        DistortionOptions options;
        options.eps = 0.1;
        Eigen::VectorXd gradient, ignored;
        for (const bool is_recentred : {false, true}) {
            if (is_recentred) {
                Coordinates before = mesh.coordinates(), after = before;
                objective.store(at, before);
                objective.recentre(at);
                objective.store(at, after);
                EXPECT_LT((after - before).cwiseAbs().maxCoeff(), 1e-14);
            }
            const double value = objective.evaluate(at, options, gradient);
            constexpr double h = 1e-6;
            for (Eigen::Index i = 0; i < at.size(); ++i) {
                Eigen::VectorXd moved = at;
                moved[i] = at[i] + h;
                const double plus = objective.evaluate(moved, options, ignored);
                moved[i] = at[i] - h;
                const double minus = objective.evaluate(moved, options, ignored);
                // The derivative jumps where a node passes from piece to piece; right after recentring many nodes are
                // on such joints.
                const double forward = (plus - value) / h, backward = (value - minus) / h;
                const double tolerance = (is_recentred ? 0.1 : 3e-4) * (1.0 + std::abs(gradient[i]));
                EXPECT_GT(gradient[i], std::min(forward, backward) - tolerance) << i;
                EXPECT_LT(gradient[i], std::max(forward, backward) + tolerance) << i;
            }
        }
    }
}

}  // namespace
}  // namespace curvewright
