#include "core/quality/shape_quality.h"

#include <cmath>

#include <gtest/gtest.h>

#include "tests/support/mesh_factory.h"

namespace curvewright {
namespace {

using testing::cube_mesh;
using testing::square_mesh;

TEST(ShapeQuality, SimilarElementsHaveMeanRatioOne) {
    std::mt19937 random(1);
    for (const CurvedMesh& mesh :
         {square_mesh(2, 3), cube_mesh(1, 2), testing::with_shaken_corners(testing::quad_mesh(2, 1), 0.1, 2, random),
          testing::with_shaken_corners(testing::hex_mesh(2, 1), 0.05, 2, random),
          testing::with_shaken_corners(testing::prism_mesh(2, 1), 0.05, 3, random)}) {
        const Coordinates larger = 3.0 * mesh.coordinates();
        const ShapeSummary shape = assess_shape(mesh.with_coordinates(larger), mesh.coordinates());
        EXPECT_NEAR(shape.min, 1.0, 1e-10);
        EXPECT_NEAR(shape.mean, 1.0, 1e-10);
    }
}

TEST(ShapeQuality, StretchingByAFactorGivesTheKnownRatio) {
    const double s = 3.0;
    Coordinates x = square_mesh(2, 2).coordinates();
    x.col(0) *= s;  // T = diag(s, 1): 2 s / (s^2 + 1)
    EXPECT_NEAR(assess_shape(square_mesh(2, 2).with_coordinates(x), square_mesh(2, 2).coordinates()).min,
                2 * s / (s * s + 1), 1e-12);
    Coordinates y = cube_mesh(1, 2).coordinates();
    y.col(0) *= s;  // T = diag(s, 1, 1): 3 s^(2/3) / (s^2 + 2)
    EXPECT_NEAR(assess_shape(cube_mesh(1, 2).with_coordinates(y), cube_mesh(1, 2).coordinates()).min,
                3 * std::pow(s, 2.0 / 3.0) / (s * s + 2), 1e-12);
}

TEST(ShapeQuality, TangledElementIsNegative) {
    std::mt19937 random(2);
    const CurvedMesh mesh = square_mesh(3, 2);
    EXPECT_LT(assess_shape(testing::shaken(mesh, 0.3, random), mesh.coordinates()).min, 0.0);
}

TEST(ShapeQuality, TheIdealOfAQuadrilateralVariesOverTheElement) {
    // A square against the trapezoid with widths 2 and 1 and height 1 as its ideal: W = [2 - eta, (1 - 2 xi) / 2; 0, 1]
    // and T = W^-1, so that eta = 2 (2 - eta) / ((2 - eta)^2 + 1 + ((1 - 2 xi) / 2)^2); least at eta = 0, xi = 0: 4
    // / 5.25.
    Eigen::MatrixX3d square(4, 3), trapezoid(4, 3);
    square << 0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0;
    trapezoid << 0, 0, 0, 2, 0, 0, 1.5, 1, 0, 0.5, 1, 0;
    const CurvedMesh mesh = testing::single_element({Shape::quadrilateral, 1}, square);
    EXPECT_NEAR(assess_shape(mesh, trapezoid).min, 4.0 / 5.25, 1e-12);
    trapezoid.row(2) << 0.3, 0.1, 0;  // folded at its third corner
    EXPECT_EQ(assess_shape(mesh, trapezoid).min, 0.0);
}

TEST(ShapeQuality, FlatIdealIsSimilarToNothing) {
    const CurvedMesh mesh = square_mesh(2, 2);
    Coordinates flat = mesh.coordinates();
    flat.col(1).setZero();
    EXPECT_EQ(assess_shape(mesh, flat).min, 0.0);
}

}  // namespace
}  // namespace curvewright
