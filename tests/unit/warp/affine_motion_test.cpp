// Affine motions of the boundary are affine motions of the interior, whatever the weighting, shape, order and size.
#include <cmath>
#include <random>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include "core/base/error.h"
#include "core/warp/warp.h"
#include "tests/support/mesh_factory.h"

namespace curvewright {
namespace {

using testing::shaken;

struct Motion {
    const char* name;
    Eigen::Matrix3d map;
    Eigen::RowVector3d shift;
};

/// x -> map x + shift. In 2D all of them keep z.
std::vector<Motion> motions(int dim) {
    Eigen::Matrix3d general;
    general << 1.3, 0.4, 0.0, -0.2, 0.8, 0.0, 0.0, 0.0, 1.0;
    if (dim == 3) general << 1.3, 0.4, 0.2, -0.2, 0.8, 0.1, 0.1, -0.3, 1.2;
    const Eigen::Vector3d axis = dim == 2 ? Eigen::Vector3d(0, 0, 1) : Eigen::Vector3d(1, 2, -2).normalized();
    const Eigen::Matrix3d turn = Eigen::AngleAxisd(std::acos(-1.0) / 2, axis).toRotationMatrix();
    const auto scaling = [dim](double s) {
        return Eigen::Matrix3d(Eigen::Vector3d(s, s, dim == 2 ? 1 : s).asDiagonal());
    };
    const Eigen::RowVector3d none = Eigen::RowVector3d::Zero();
    return {{"general", general, {5.0, -3.0, dim == 2 ? 0.0 : 2.0}},
            {"quarter turn", turn, none},
            {"shrinking", scaling(1e-6), none},
            {"growing", scaling(1e6), none},
            {"far shift", Eigen::Matrix3d::Identity(), {1e6, -1e6, dim == 2 ? 0.0 : 1e6}}};
}

Coordinates image(const CurvedMesh& mesh, const Motion& motion) {
    Coordinates x = mesh.coordinates() * motion.map.transpose();
    x.rowwise() += motion.shift;
    return x;
}

void expect_affine(const CurvedMesh& mesh, Weighting weighting) {
    WarpOptions options;
    options.weighting = weighting;
    const Warper warper(mesh, options);
    for (const Motion& motion : motions(mesh.topology().dimension())) {
        const Coordinates target = image(mesh, motion);
        Coordinates boundary = Coordinates::Constant(target.rows(), 3, 1e9);
        for (const Index node : mesh.topology().boundary_nodes()) boundary.row(node) = target.row(node);
        const Coordinates moved = warper.move(boundary).coordinates;
        // Displacements of size 1 remain in coordinates where everything shrinks.
        const double size = std::max(1.0, target.cwiseAbs().maxCoeff());
        EXPECT_LT((moved - target).cwiseAbs().maxCoeff(), 1e-12 * size)
            << to_string(weighting) << " " << name(mesh.topology().element_type(0)) << " " << motion.name;
    }
}

constexpr Weighting weightings[] = {Weighting::convex, Weighting::affine, Weighting::elastic};

TEST(AffineMotion, OfPlaneMeshesOfOrders1To10) {
    std::mt19937 random(1);
    for (int order = 1; order <= 10; ++order)
        for (const Weighting weighting : weightings)
            for (const CurvedMesh& mesh : {testing::square_mesh(3, order), testing::quad_mesh(3, order)}) {
                expect_affine(shaken(mesh, 0.05 / order, random), weighting);
                expect_affine(mesh, weighting);
            }
}

TEST(AffineMotion, OfSolidMeshesOfOrders1To6) {
    std::mt19937 random(2);
    for (int order = 1; order <= 6; ++order)
        for (const Weighting weighting : weightings) {
            if (weighting == Weighting::elastic && order > 4) continue;
            const int n = order <= 3 ? 2 : 1;
            for (const CurvedMesh& mesh :
                 {testing::cube_mesh(n, order), testing::hex_mesh(n, order), testing::prism_mesh(n, order)})
                expect_affine(shaken(mesh, 0.05 / order, random), weighting);
        }
}

TEST(AffineMotion, OfBodiesThatAreStiffInPlaces) {
    // Such a body is no affine one inside: its equations alone would not give this.
    std::mt19937 random(5);
    const CurvedMesh mesh = testing::with_shaken_corners(testing::square_mesh(4, 1), 0.08, 3, random);
    WarpOptions options;
    options.weighting = Weighting::elastic;
    options.stiffening = 1.0;
    const Coordinates target = image(mesh, motions(2).front());
    EXPECT_LT((warp(mesh, target, options).coordinates - target).cwiseAbs().maxCoeff(), 1e-12 * 6.0);
}

TEST(AffineMotion, OfPyramids) {
    std::mt19937 random(3);
    const CurvedMesh mesh = shaken(testing::pyramid_mesh(3), 0.03, random);
    expect_affine(mesh, Weighting::convex);
    expect_affine(mesh, Weighting::affine);
    WarpOptions elastic;
    elastic.weighting = Weighting::elastic;
    EXPECT_THROW(Warper(mesh, elastic), Unsupported);
}

TEST(AffineMotion, OfMeshesOfAnySizeAndPlace) {
    std::mt19937 random(4);
    for (const double size : {1e-6, 1e6})
        for (const Weighting weighting : weightings)
            for (const CurvedMesh& unit : {testing::square_mesh(4, 3), testing::cube_mesh(2, 2)}) {
                Coordinates x = size * shaken(unit, 0.02, random).coordinates();
                if (unit.topology().dimension() == 3) x.rowwise() += 1e3 * size * Eigen::RowVector3d(1, -2, 3);
                const CurvedMesh mesh = unit.with_coordinates(x);
                const Motion general = motions(unit.topology().dimension()).front();
                const Coordinates target = image(mesh, {"", general.map, size * general.shift});
                WarpOptions options;
                options.weighting = weighting;
                EXPECT_LT((warp(mesh, target, options).coordinates - target).cwiseAbs().maxCoeff(),
                          1e-12 * target.cwiseAbs().maxCoeff());
            }
}

TEST(AffineMotion, ComesFromTheWeightsToo) {
    // Half of the boundary moves by another affine motion: no affine function fits, but where the whole patch of a node
    // moves affinely, so does the node. The interior of a mesh whose every interior node touches the boundary shows it.
    const CurvedMesh mesh = testing::square_mesh(2, 1);
    const NeighbourSets sets = find_neighbours(mesh.topology(), mesh.topology().interior_nodes());
    ASSERT_EQ(sets.centers.size(), 1u);
    for (const Weighting weighting : weightings) {
        WarpOptions options;
        options.weighting = weighting;
        Coordinates target = mesh.coordinates();
        double bend = 0.0;
        for (const Index node : mesh.topology().boundary_nodes())
            target(node, 1) += 0.3 * std::pow(mesh.coordinates()(node, 0), 2);
        const Coordinates moved = warp(mesh, target, options).coordinates;
        for (const Index node : sets.of(0)) bend = std::max(bend, target(node, 1) - mesh.coordinates()(node, 1));
        const Index middle = sets.centers[0];
        EXPECT_GT(moved(middle, 1), mesh.coordinates()(middle, 1) + 0.05);
        EXPECT_LT(moved(middle, 1), mesh.coordinates()(middle, 1) + bend);
    }
}

}  // namespace
}  // namespace curvewright
