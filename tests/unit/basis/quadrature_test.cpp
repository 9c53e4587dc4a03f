#include "core/basis/quadrature.h"

#include <cmath>

#include <gtest/gtest.h>

#include "core/base/error.h"

namespace curvewright {
namespace {

double factorial(int n) {
    return std::tgamma(n + 1.0);
}

/// Integral of x^i y^j z^k over the reference element, in closed form.
double exact_integral(Shape shape, int i, int j, int k) {
    switch (shape) {
        case Shape::triangle:
            return factorial(i) * factorial(j) / factorial(i + j + 2);
        case Shape::tetrahedron:
            return factorial(i) * factorial(j) * factorial(k) / factorial(i + j + k + 3);
        case Shape::prism:
            return factorial(i) * factorial(j) / factorial(i + j + 2) / (k + 1.0);
        default:
            return 1.0 / ((i + 1.0) * (j + 1.0) * (k + 1.0));
    }
}

/// What the rule of a degree promises to integrate.
bool is_promised(Shape shape, int degree, int i, int j, int k) {
    if (is_simplex(shape)) return i + j + k <= degree;
    if (shape == Shape::prism) return i + j <= degree && k <= degree;
    return true;
}

double integrate(const QuadratureRule& rule, int i, int j, int k) {
    double sum = 0.0;
    for (Eigen::Index q = 0; q < rule.weights.size(); ++q)
        sum += rule.weights[q] * std::pow(rule.points(q, 0), i) * std::pow(rule.points(q, 1), j) *
               std::pow(rule.points(q, 2), k);
    return sum;
}

class QuadratureOf : public ::testing::TestWithParam<Shape> {};

TEST_P(QuadratureOf, IsExactUpToItsDegree) {
    const Shape shape = GetParam();
    const int dim = dimension(shape), most = dim == 3 ? 12 : 20;
    for (int degree = 0; degree <= most; ++degree) {
        const QuadratureRule rule = quadrature(shape, degree);
        for (int k = 0; k <= (dim > 2 ? degree : 0); ++k)
            for (int j = 0; j <= (dim > 1 ? degree : 0); ++j)
                for (int i = 0; i <= degree; ++i)
                    if (is_promised(shape, degree, i, j, k)) {
                        const double exact = exact_integral(shape, i, j, k);
                        ASSERT_NEAR(integrate(rule, i, j, k), exact, 1e-13 * exact + 1e-16)
                            << name(shape) << " degree " << degree << ": " << i << " " << j << " " << k;
                    }
    }
}

TEST_P(QuadratureOf, HasNoMorePointsThanItsDegreeNeeds) {
    // Gauss: n points are exact up to 2 n - 1, and not beyond.
    const Shape shape = GetParam();
    const int dim = dimension(shape);
    for (const int degree : {0, 2, 4, 8}) {
        const QuadratureRule rule = quadrature(shape, degree);
        const int collapsed = is_simplex(shape) ? dim - 1 : shape == Shape::prism ? 1 : 0;
        const double per_direction = (degree + collapsed) / 2 + 1;
        EXPECT_EQ(rule.weights.size(), std::lround(std::pow(per_direction, dim)));
        const int beyond = 2 * static_cast<int>(per_direction);
        EXPECT_GT(std::abs(integrate(rule, beyond, 0, 0) - exact_integral(shape, beyond, 0, 0)),
                  1e-9 * exact_integral(shape, beyond, 0, 0));
    }
}

TEST_P(QuadratureOf, WeightsArePositiveAndPointsInside) {
    const Shape shape = GetParam();
    const int dim = dimension(shape);
    for (const int degree : {0, 1, 5, 18, 20}) {
        const QuadratureRule rule = quadrature(shape, degree);
        EXPECT_GT(rule.weights.minCoeff(), 0.0);
        EXPECT_NEAR(rule.weights.sum(), exact_integral(shape, 0, 0, 0), 1e-13);
        EXPECT_GT(rule.points.leftCols(dim).minCoeff(), 0.0);
        EXPECT_LT(rule.points.leftCols(dim).maxCoeff(), 1.0);
        EXPECT_TRUE(rule.points.rightCols(3 - dim).isZero(0.0));
        const int in_simplex = is_simplex(shape) ? dim : shape == Shape::prism ? 2 : 1;
        EXPECT_LT(rule.points.leftCols(in_simplex).rowwise().sum().maxCoeff(), 1.0);
    }
}

INSTANTIATE_TEST_SUITE_P(Shapes, QuadratureOf,
                         ::testing::Values(Shape::line, Shape::triangle, Shape::quadrilateral, Shape::tetrahedron,
                                           Shape::hexahedron, Shape::prism),
                         [](const auto& test) { return name(test.param); });

TEST(Quadrature, RefusesPyramidsAndVertices) {
    EXPECT_THROW(quadrature(Shape::pyramid, 2), Unsupported);
    EXPECT_THROW(quadrature(Shape::vertex, 2), Unsupported);
}

}  // namespace
}  // namespace curvewright
