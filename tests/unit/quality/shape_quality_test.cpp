#include "core/quality/shape_quality.h"

#include <cmath>

#include <gtest/gtest.h>
#include <Eigen/LU>

#include "core/basis/lagrange.h"
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

/// The worst of the definition at the samples, from the shape functions' own derivatives.
double by_definition(const CurvedMesh& mesh, const CurvedMesh& ideal, Index element) {
    const ElementType type = mesh.topology().element_type(element);
    const int dim = dimension(type.shape), corners = node_count({type.shape, 1});
    const Eigen::MatrixX3d points = lattice_points(type.shape, 3 * type.order);
    const BasisTable basis = lagrange_basis(type, points), straight = lagrange_basis({type.shape, 1}, points);
    const Eigen::MatrixX3d x = mesh.element_coordinates(element), w = ideal.element_coordinates(element);
    double worst = 2.0;
    for (Eigen::Index q = 0; q < points.rows(); ++q) {
        Eigen::MatrixXd of_element(dim, dim), of_ideal(dim, dim);
        for (int k = 0; k < dim; ++k) {
            of_element.col(k) = (basis.gradients[k].row(q) * x).head(dim).transpose();
            of_ideal.col(k) = (straight.gradients[k].row(q) * w.topRows(corners)).head(dim).transpose();
        }
        const Eigen::MatrixXd t = of_element * of_ideal.inverse();
        const double det = t.determinant(), power = std::pow(std::abs(det), 2.0 / dim);
        worst = std::min(worst, std::copysign(dim * power / t.squaredNorm(), det));
    }
    return worst;
}

TEST(ShapeQuality, IsTheWorstOfTheSamplesOfEverySimplex) {
    std::mt19937 random(3);
    for (const bool is_3d : {false, true})
        for (int order = 1; order <= (is_3d ? 4 : 5); ++order)
            for (const double stretch : {1.0, 1e-4}) {
                SCOPED_TRACE(std::to_string(order) + (is_3d ? " 3D " : " 2D ") + std::to_string(stretch));
                const CurvedMesh linear = is_3d ? cube_mesh(2, 1) : square_mesh(3, 1);
                const CurvedMesh straight = testing::with_shaken_corners(linear, 0.1, order, random);
                Coordinates x = testing::shaken(straight, 0.1 / order, random).coordinates();
                // Some elements stay straight.
                for (Index element = 0; element < straight.topology().element_count(); element += 3)
                    for (const Index node : straight.topology().element_nodes(element))
                        x.row(node) = straight.coordinates().row(node);
                x.col(1) *= stretch;
                Coordinates w = straight.coordinates();
                w.col(1) *= stretch;
                x.col(0).array() += 7.0;
                const CurvedMesh mesh = straight.with_coordinates(x), ideal = straight.with_coordinates(w);
                const std::vector<double> shapes = element_shapes(mesh, ideal.coordinates());
                for (Index element = 0; element < mesh.topology().element_count(); ++element)
                    EXPECT_NEAR(shapes[element], by_definition(mesh, ideal, element), 1e-9);
            }
}

TEST(ShapeQuality, IsTheWorstOfTheSamplesOfEveryQuadrilateralHexahedronAndPrism) {
    std::mt19937 random(4);
    for (int order = 1; order <= 4; ++order)
        for (const CurvedMesh& linear : {testing::quad_mesh(3, 1), testing::hex_mesh(2, 1), testing::prism_mesh(2, 1)})
            for (const double size : {1.0, 1e-60}) {
                SCOPED_TRACE(name(linear.topology().element_type(0)) + std::to_string(order));
                const CurvedMesh straight = testing::with_shaken_corners(linear, 0.05, order, random);
                Coordinates x = testing::shaken(straight, 0.1 / order, random).coordinates();
                x.col(0).array() += 2.0;
                const CurvedMesh mesh = straight.with_coordinates(x);
                const std::vector<double> shapes =
                    element_shapes(mesh.with_coordinates(size * x), size * straight.coordinates());
                for (Index element = 0; element < mesh.topology().element_count(); ++element)
                    EXPECT_NEAR(shapes[element], by_definition(mesh, straight, element), 1e-9);
            }
}

TEST(ShapeQuality, FlatIdealIsSimilarToNothing) {
    const CurvedMesh mesh = square_mesh(2, 2);
    Coordinates flat = mesh.coordinates();
    flat.col(1).setZero();
    EXPECT_EQ(assess_shape(mesh, flat).min, 0.0);
}

}  // namespace
}  // namespace curvewright
