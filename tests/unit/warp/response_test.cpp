#include "core/warp/response.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include "core/base/error.h"
#include "tests/support/mesh_factory.h"

namespace curvewright {
namespace {

using testing::cube_mesh;
using testing::shaken;
using testing::square_mesh;

constexpr Weighting weightings[] = {Weighting::convex, Weighting::affine, Weighting::elastic};

WarpOptions with(Weighting weighting) {
    WarpOptions options;
    options.weighting = weighting;
    return options;
}

/// Some boundary nodes; weights fall off at random if they are soft.
DraggedSet random_set(const CurvedMesh& mesh, bool is_soft, std::mt19937& random) {
    std::uniform_real_distribution<double> uniform(0.0, 1.0);
    DraggedSet set;
    for (const Index node : mesh.topology().boundary_nodes())
        if (uniform(random) < 0.3) {
            set.nodes.push_back(node);
            if (is_soft) set.weights.push_back(uniform(random));
        }
    std::shuffle(set.nodes.begin(), set.nodes.end(), random);
    return set;
}

/// Where the boundary goes: node by node as the motion says.
Coordinates boundary_after(const CurvedMesh& mesh, const DraggedSet& set, const AffineMotion& motion,
                           const Eigen::Vector3d& origin) {
    Coordinates x = mesh.coordinates();
    const int dim = mesh.topology().dimension();
    for (std::size_t i = 0; i < set.nodes.size(); ++i) {
        const Eigen::Vector3d from = mesh.coordinates().row(set.nodes[i]).transpose();
        const Eigen::Vector3d to = origin + motion.linear * (from - origin) + motion.shift;
        x.row(set.nodes[i]).head(dim) +=
            (set.weights.empty() ? 1.0 : set.weights[i]) * (to - from).transpose().head(dim);
    }
    return x;
}

std::vector<AffineMotion> motions(int dim) {
    std::vector<AffineMotion> result{
        AffineMotion::translation({0.3, -0.2, dim == 3 ? 0.5 : 0.0}), AffineMotion::rotation({0, 0, 2}, 0.7),
        AffineMotion::scaling({1.5, 0.4, dim == 3 ? 2.0 : 1.0}), AffineMotion::shear(0, 1, 0.6)};
    if (dim == 3) {
        result.push_back(AffineMotion::rotation({1, -2, 0.5}, -1.1));
        result.push_back(AffineMotion::shear(2, 0, -0.4));
    }
    AffineMotion together = AffineMotion::rotation({0, 0, 1}, 0.4);
    together.linear *= 1.3;
    if (dim == 2) together.linear(2, 2) = 1.0;
    together.shift = {0.2, 0.1, 0.0};
    result.push_back(together);
    return result;
}

TEST(AffineMotion, IsWhatItsNameSays) {
    EXPECT_EQ(AffineMotion::translation({1, 2, 3}).shift, Eigen::Vector3d(1, 2, 3));
    EXPECT_EQ(AffineMotion::translation({1, 2, 3}).linear, Eigen::Matrix3d::Identity());
    const Eigen::Vector3d turned =
        AffineMotion::rotation({0, 0, 5}, std::acos(-1.0) / 2).linear * Eigen::Vector3d(1, 0, 0);
    EXPECT_LT((turned - Eigen::Vector3d(0, 1, 0)).norm(), 1e-15);
    EXPECT_EQ(AffineMotion::scaling({2, 3, 4}).linear * Eigen::Vector3d(1, 1, 1), Eigen::Vector3d(2, 3, 4));
    EXPECT_EQ(AffineMotion::shear(0, 1, 0.5).linear * Eigen::Vector3d(1, 2, 3), Eigen::Vector3d(2, 2, 3));
}

TEST(ResponseField, GivesWhatAWarpOfTheSameMotionGives) {
    std::mt19937 random(1);
    const Eigen::Vector3d origin(0.3, 0.8, -0.2);
    for (const CurvedMesh& mesh : {shaken(square_mesh(5, 3), 0.01, random), shaken(cube_mesh(2, 2), 0.03, random),
                                   shaken(testing::quad_mesh(4, 2), 0.01, random)})
        for (const Weighting weighting : weightings)
            for (const bool is_soft : {false, true}) {
                const Warper warper(mesh, with(weighting));
                const DraggedSet set = random_set(mesh, is_soft, random);
                const ResponseField field(warper, set, ResponseKind::affine, origin);
                Coordinates frame;
                for (const AffineMotion& motion : motions(mesh.topology().dimension())) {
                    field.apply(motion, mesh.coordinates(), frame);
                    const Coordinates boundary = boundary_after(mesh, set, motion, origin);
                    const Coordinates expected = warper.move(boundary).coordinates;
                    EXPECT_GT((expected - mesh.coordinates()).norm(), 0.1);
                    EXPECT_LT((frame - expected).cwiseAbs().maxCoeff(), 1e-9) << to_string(weighting);
                    for (const Index node : mesh.topology().boundary_nodes())
                        EXPECT_LT((frame.row(node) - boundary.row(node)).norm(), 1e-13);
                }
            }
}

TEST(ResponseField, ForTranslationsIsTheSameAndSmaller) {
    std::mt19937 random(2);
    for (const CurvedMesh& mesh : {square_mesh(5, 2), cube_mesh(2, 2)})
        for (const Weighting weighting : weightings) {
            const Warper warper(mesh, with(weighting));
            const DraggedSet set = random_set(mesh, true, random);
            const ResponseField small(warper, set, ResponseKind::translation), full(warper, set, ResponseKind::affine);
            const AffineMotion motion = motions(mesh.topology().dimension()).front();
            Coordinates a, b;
            small.apply(motion, mesh.coordinates(), a);
            full.apply(motion, mesh.coordinates(), b);
            EXPECT_LT((a - b).cwiseAbs().maxCoeff(), 1e-12);
            EXPECT_THROW(small.apply(AffineMotion::shear(0, 1, 0.1), mesh.coordinates(), a), InvalidInput);
        }
}

TEST(ResponseField, FramesDoNotAccumulate) {
    std::mt19937 random(3);
    const CurvedMesh mesh = shaken(cube_mesh(2, 2), 0.03, random);
    const Warper warper(mesh);
    const ResponseField field(warper, random_set(mesh, true, random), ResponseKind::affine);
    Coordinates frame, alone;
    for (int i = 0; i <= 50; ++i) field.apply(AffineMotion::rotation({1, 1, 0}, 0.02 * i), mesh.coordinates(), frame);
    field.apply(AffineMotion::rotation({1, 1, 0}, 0.02 * 50), mesh.coordinates(), alone);
    EXPECT_EQ(frame, alone);
    field.apply({}, mesh.coordinates(), frame);
    EXPECT_EQ(frame, mesh.coordinates());  // back where it began, to the bit
    // A drag may start from other positions; rows that do not move are left alone.
    Coordinates start = mesh.coordinates();
    start.col(0).array() += 10.0;
    Coordinates result = Coordinates::Constant(start.rows(), 3, -1.0);
    field.apply({}, start, result);
    const auto& moving = field.moving_nodes();
    for (Index node = 0; node < mesh.topology().node_count(); ++node) {
        const bool moves = std::binary_search(moving.begin(), moving.end(), node);
        EXPECT_EQ(Eigen::RowVector3d(result.row(node)),
                  moves ? Eigen::RowVector3d(start.row(node)) : Eigen::RowVector3d(-1.0, -1.0, -1.0));
    }
}

TEST(ResponseField, SharesAreThoseOfAUnitShift) {
    std::mt19937 random(4);
    const CurvedMesh mesh = square_mesh(6, 2);
    for (const Weighting weighting : weightings) {
        const Warper warper(mesh, with(weighting));
        const DraggedSet set{*mesh.topology().find_group_nodes("top"), {}};
        const ResponseField field(warper, set, ResponseKind::translation);
        Coordinates moved;
        field.apply(AffineMotion::translation({1, 0, 0}), mesh.coordinates(), moved);
        EXPECT_TRUE(std::is_sorted(field.moving_nodes().begin(), field.moving_nodes().end()));
        for (Index node = 0; node < mesh.topology().node_count(); ++node)
            EXPECT_NEAR(field.translation_share(node), moved(node, 0) - mesh.coordinates()(node, 0), 1e-14);
        for (const Index node : set.nodes) EXPECT_EQ(field.translation_share(node), 1.0);
        const std::vector<Index> bottom = *mesh.topology().find_group_nodes("bottom");
        for (const Index node : bottom) EXPECT_EQ(field.translation_share(node), 0.0);
        if (weighting == Weighting::convex)
            for (const Index node : mesh.topology().interior_nodes()) {
                EXPECT_GT(field.translation_share(node), 0.0);
                EXPECT_LT(field.translation_share(node), 1.0);
            }
    }
}

TEST(ResponseField, PrescribedInteriorNodesCanBeDragged) {
    const CurvedMesh mesh = square_mesh(6, 2);
    WarpOptions options;
    options.prescribed_nodes = {mesh.topology().interior_nodes()[5], mesh.topology().interior_nodes()[20]};
    const Warper warper(mesh, options);
    const DraggedSet set{options.prescribed_nodes, {1.0, 0.5}};
    const ResponseField field(warper, set, ResponseKind::translation);
    Coordinates frame;
    const AffineMotion motion = AffineMotion::translation({0.02, 0.01, 0.0});
    field.apply(motion, mesh.coordinates(), frame);
    const Coordinates boundary = boundary_after(mesh, set, motion, Eigen::Vector3d::Zero());
    EXPECT_LT((frame - warper.move(boundary).coordinates).cwiseAbs().maxCoeff(), 1e-12);
}

TEST(ResponseField, NothingDraggedNothingMoves) {
    const CurvedMesh mesh = square_mesh(3, 2);
    const Warper warper(mesh);
    const ResponseField field(warper, {}, ResponseKind::affine);
    EXPECT_TRUE(field.moving_nodes().empty());
    Coordinates frame;
    field.apply(AffineMotion::translation({1, 1, 0}), mesh.coordinates(), frame);
    EXPECT_EQ(frame, mesh.coordinates());
}

TEST(ResponseField, RefusesWhatItCannotDrag) {
    const CurvedMesh mesh = square_mesh(3, 2);
    const Warper warper(mesh);
    const Index inner = mesh.topology().interior_nodes()[1];
    const auto message = [&](const DraggedSet& set) -> std::string {
        try {
            ResponseField(warper, set, ResponseKind::translation);
        } catch (const InvalidInput& error) {
            return error.what();
        }
        return "accepted";
    };
    EXPECT_NE(message({{inner}, {}}).find("Node " + std::to_string(mesh.topology().node_tag(inner).value) + " "),
              std::string::npos);
    EXPECT_NE(message({{mesh.topology().node_count()}, {}}), "accepted");
    EXPECT_NE(message({{-1}, {}}), "accepted");
    EXPECT_NE(message({{0, 1}, {1.0}}), "accepted");
    EXPECT_NE(message({{0}, {1.0, 2.0}}), "accepted");
    EXPECT_NE(message({{0}, {std::numeric_limits<double>::quiet_NaN()}}), "accepted");
}

TEST(ResponseField, PositionsOfAnotherMeshAreRefused) {
    const CurvedMesh mesh = square_mesh(3, 2);
    const Warper warper(mesh);
    const ResponseField field(warper, {mesh.topology().boundary_nodes(), {}}, ResponseKind::translation);
    Coordinates frame;
    EXPECT_THROW(field.apply({}, Coordinates::Zero(3, 3), frame), InvalidInput);
}

TEST(ResponseField, Cancels) {
    const CurvedMesh mesh = square_mesh(14, 2);
    WarpOptions options;
    options.solver = SolverChoice::iterative;
    const Warper warper(mesh, options);
    const DraggedSet set{*mesh.topology().find_group_nodes("top"), {}};
    std::stop_source source;
    const ProgressCallback stop = [&](std::string_view phase, double) {
        EXPECT_EQ(phase, "Solving");
        source.request_stop();
    };
    EXPECT_THROW(ResponseField(warper, set, ResponseKind::affine, Eigen::Vector3d::Zero(),
                               TaskContext{source.get_token(), stop}),
                 Cancelled);
    EXPECT_NO_THROW(ResponseField(warper, set, ResponseKind::affine));
}

}  // namespace
}  // namespace curvewright
