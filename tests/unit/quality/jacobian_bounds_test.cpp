#include "core/quality/jacobian_bounds.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>
#include <Eigen/LU>

#include "core/base/error.h"
#include "core/basis/bernstein.h"
#include "core/basis/lagrange.h"
#include "core/basis/node_ordering.h"
#include "core/basis/reference_element.h"
#include "tests/support/mesh_factory.h"

namespace curvewright {
namespace {

using testing::random_element;

/// Jacobian determinants on a dense lattice, straight from the shape functions.
std::pair<double, double> sampled_range(ElementType type, const Eigen::MatrixX3d& x, int samples) {
    const auto lattice = gmsh_node_order({type.shape, samples});
    Eigen::MatrixX3d points(static_cast<Eigen::Index>(lattice.size()), 3);
    for (Eigen::Index i = 0; i < points.rows(); ++i)
        for (int d = 0; d < 3; ++d) points(i, d) = static_cast<double>(lattice[i][d]) / samples;
    const BasisTable basis = lagrange_basis(type, points);
    const int dim = dimension(type.shape);
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (Eigen::Index q = 0; q < points.rows(); ++q) {
        Eigen::MatrixXd jacobian(dim, dim);
        for (int k = 0; k < dim; ++k) jacobian.col(k) = (basis.gradients[k].row(q) * x).head(dim).transpose();
        low = std::min(low, jacobian.determinant());
        high = std::max(high, jacobian.determinant());
    }
    return {low, high};
}

constexpr std::array curved_types{ElementType{Shape::triangle, 3}, ElementType{Shape::tetrahedron, 2},
                                  ElementType{Shape::quadrilateral, 2}, ElementType{Shape::hexahedron, 2},
                                  ElementType{Shape::prism, 2}};

struct Case {
    Shape shape;
    int order;
};

class EveryOrder : public ::testing::TestWithParam<Case> {};

TEST_P(EveryOrder, BoundsEncloseDenseSamplesAndAreTight) {
    const ElementType type{GetParam().shape, GetParam().order};
    const bool is_solid = dimension(type.shape) == 3;
    std::mt19937 random(17 + type.order);
    JacobianBounds bounds(type);
    const int elements = type.order <= 4 ? 12 : is_solid ? 2 : 4;
    const int samples = is_solid ? (type.order <= 4 ? 20 : 16) : 48;
    for (int i = 0; i < elements; ++i) {
        // High orders: small motions, or every element is hopelessly tangled.
        const Eigen::MatrixX3d x = random_element(type, type.order <= 4 ? 0.35 : 0.1, random);
        const ElementQuality q = bounds.bound(x, 1.0, {});
        const auto [low, high] = sampled_range(type, x, samples);
        const double scale = std::max(std::abs(low), std::abs(high));
        EXPECT_LE(q.min_lower, low + 1e-12 * scale);
        EXPECT_GE(q.max_upper, high - 1e-12 * scale);
        EXPECT_LE(q.min_upper - q.min_lower, 3e-3 * scale);
        EXPECT_LE(q.max_upper - q.max_lower, 3e-3 * scale);
        // The samples come close to the extrema (in high orders not close enough), so a bound that is far off shows.
        if (type.order <= (type.shape == Shape::hexahedron ? 4 : 5)) {
            EXPECT_NEAR(q.min_lower, low, (is_solid ? 0.12 : 0.03) * scale) << name(type);
            EXPECT_NEAR(q.max_upper, high, (is_solid ? 0.12 : 0.03) * scale) << name(type);
        }
        if (low < 0) {
            EXPECT_EQ(q.validity, Validity::invalid);
        }
        if (q.validity == Validity::valid) {
            EXPECT_GT(low, 0.0);
        }
    }
}

TEST_P(EveryOrder, AffineElementHasScaledJacobianOne) {
    const ElementType type{GetParam().shape, GetParam().order};
    std::mt19937 random(5);
    const Eigen::MatrixX3d x = random_element(type, 0.0, random);
    const ElementQuality q = JacobianBounds(type).bound(x, 1.0, {});
    EXPECT_EQ(q.validity, Validity::valid);
    EXPECT_NEAR(q.scaled_jacobian, 1.0, 1e-8);
    const ElementQuality flipped = JacobianBounds(type).bound(x, -1.0, {});
    EXPECT_EQ(flipped.validity, Validity::invalid);
    EXPECT_NEAR(flipped.scaled_jacobian, -1.0, 1e-8);  // |max J| keeps an inverted element well defined
}

TEST_P(EveryOrder, JudgementDoesNotDependOnUnitOrPlace) {
    const ElementType type{GetParam().shape, GetParam().order};
    std::mt19937 random(23);
    JacobianBounds bounds(type);
    const Eigen::MatrixX3d x = random_element(type, type.order <= 4 ? 0.3 : 0.1, random);
    const ElementQuality plain = bounds.bound(x, 1.0, {});
    for (const double scale : {1e-6, 1e6}) {
        const ElementQuality scaled = bounds.bound(scale * x, 1.0, {});
        EXPECT_EQ(scaled.validity, plain.validity);
        EXPECT_NEAR(scaled.scaled_jacobian, plain.scaled_jacobian, 1e-6 * std::abs(plain.scaled_jacobian) + 1e-9);
    }
    Eigen::MatrixX3d moved = x;
    moved.leftCols(dimension(type.shape)).array() += 1e6;
    const ElementQuality far = bounds.bound(moved, 1.0, {});
    EXPECT_NEAR(far.scaled_jacobian, plain.scaled_jacobian, 1e-4);  // the input itself was rounded to 1e-10
}

INSTANTIATE_TEST_SUITE_P(Triangles, EveryOrder,
                         ::testing::Values(Case{Shape::triangle, 1}, Case{Shape::triangle, 2}, Case{Shape::triangle, 3},
                                           Case{Shape::triangle, 4}, Case{Shape::triangle, 5}, Case{Shape::triangle, 6},
                                           Case{Shape::triangle, 7}, Case{Shape::triangle, 8}, Case{Shape::triangle, 9},
                                           Case{Shape::triangle, 10}));
INSTANTIATE_TEST_SUITE_P(Tetrahedra, EveryOrder,
                         ::testing::Values(Case{Shape::tetrahedron, 1}, Case{Shape::tetrahedron, 2},
                                           Case{Shape::tetrahedron, 3}, Case{Shape::tetrahedron, 4},
                                           Case{Shape::tetrahedron, 5}, Case{Shape::tetrahedron, 6},
                                           Case{Shape::tetrahedron, 8}, Case{Shape::tetrahedron, 10}));

INSTANTIATE_TEST_SUITE_P(Quadrilaterals, EveryOrder,
                         ::testing::Values(Case{Shape::quadrilateral, 1}, Case{Shape::quadrilateral, 2},
                                           Case{Shape::quadrilateral, 3}, Case{Shape::quadrilateral, 4},
                                           Case{Shape::quadrilateral, 5}, Case{Shape::quadrilateral, 6},
                                           Case{Shape::quadrilateral, 8}, Case{Shape::quadrilateral, 10}));
INSTANTIATE_TEST_SUITE_P(Hexahedra, EveryOrder,
                         ::testing::Values(Case{Shape::hexahedron, 1}, Case{Shape::hexahedron, 2},
                                           Case{Shape::hexahedron, 3}, Case{Shape::hexahedron, 4},
                                           Case{Shape::hexahedron, 5}));
INSTANTIATE_TEST_SUITE_P(Prisms, EveryOrder,
                         ::testing::Values(Case{Shape::prism, 1}, Case{Shape::prism, 2}, Case{Shape::prism, 3},
                                           Case{Shape::prism, 4}, Case{Shape::prism, 5}, Case{Shape::prism, 7}));

/// P2 triangle with base 1, apex (1/2, h) and the base's middle node raised by s: J is linear along the base's normal
/// and min J / max J = 1 - 2 s / h exactly, for 0 <= s <= h / 2 (direct computation).
TEST(JacobianBoundsTest, RaisedMiddleNodeHasKnownScaledJacobian) {
    for (const double s : {0.0, 0.05, 0.1, 0.149, 0.1500001, 0.2}) {
        Eigen::MatrixX3d x(6, 3);
        x << 0, 0, 0, 1, 0, 0, .5, .3, 0, .5, s, 0, .75, .15, 0, .25, .15, 0;
        const ElementQuality q = JacobianBounds({Shape::triangle, 2}).bound(x, 1.0, {});
        if (s < 0.15) {
            EXPECT_NEAR(q.scaled_jacobian, 1 - 2 * s / 0.3, 5e-4) << s;
        }
        EXPECT_EQ(q.validity, s < 0.15 ? Validity::valid : Validity::invalid) << s;
    }
}

TEST(JacobianBoundsTest, ExactZeroIsUndecidedAndNeverValid) {
    // Half angle: the two edges at corner 0 are collinear there, so J vanishes in that corner and is positive
    // elsewhere.
    Eigen::MatrixX3d x(6, 3);
    x << 0, 0, 0, 1, 0, 0, -1, 0, 0, .5, 0, 0, 0, -1, 0, -.5, 0, 0;
    x.col(1) *= -1;
    const ElementQuality q = JacobianBounds({Shape::triangle, 2}).bound(x, 1.0, {});
    EXPECT_EQ(q.validity, Validity::undecided);
    EXPECT_NEAR(q.scaled_jacobian, 0.0, 1e-12);
    // All nodes in one point: J is zero everywhere.
    EXPECT_EQ(JacobianBounds({Shape::triangle, 2}).bound(Eigen::MatrixX3d::Zero(6, 3), 1.0, {}).validity,
              Validity::undecided);
}

/// Control point of an element in extended precision, found from one position per factor of the reference element.
Eigen::Matrix<long double, 1, 3> control_point(ElementType type, const Eigen::MatrixX3d& x,
                                               const std::vector<int>& positions) {
    const auto& lattice = reference_element(type).lattice;
    const std::vector<int> dimensions = simplex_factors(type.shape);
    Eigen::Matrix<long double, 1, 3> point = Eigen::Matrix<long double, 1, 3>::Zero();
    for (std::size_t node = 0; node < lattice.size(); ++node) {
        long double weight = 1.0L;
        int axis = 0;
        for (std::size_t f = 0; f < dimensions.size(); ++f) {
            const ElementType factor{simplex(dimensions[f]), type.order};
            LatticePoint own{};
            for (int d = 0; d < dimensions[f]; ++d) own[d] = lattice[node][axis++];
            weight *= lagrange_to_bernstein(factor)(positions[f], reference_element(factor).find_node(own));
        }
        point += weight * (x.row(static_cast<Eigen::Index>(node)) - x.row(0)).cast<long double>();
    }
    return point;
}

/// J at the corners of the Bernstein form in extended precision: the tangents at a corner lead to the control points
/// next to it; in every factor, those of direction k end minus those of 0.
std::vector<long double> corner_jacobians(ElementType type, const Eigen::MatrixX3d& x, const BernsteinForm& form) {
    const int dim = dimension(type.shape);
    const std::vector<int> dimensions = simplex_factors(type.shape);
    std::vector<long double> values;
    for (const BernsteinForm::Corner& corner : form.corners()) {
        Eigen::Matrix<long double, Eigen::Dynamic, Eigen::Dynamic> jacobian(dim, dim);
        int row = 0;
        for (std::size_t f = 0; f < dimensions.size(); ++f)
            for (int k = 0; k < dimensions[f]; ++k) {
                std::vector<int> plus, minus;
                for (std::size_t g = 0; g < dimensions.size(); ++g) {
                    const BernsteinSimplex& factor = BernsteinSimplex::get(dimensions[g], type.order);
                    const int vertex = corner.of_factor[g];
                    plus.push_back(factor.corners()[vertex]);
                    minus.push_back(plus.back());
                    if (g != f) continue;
                    auto up = factor.indices()[plus.back()], down = up;
                    --up[vertex], ++up[k + 1];
                    --down[vertex], ++down[0];
                    plus.back() = factor.position(up[1], up[2], up[3]);
                    minus.back() = factor.position(down[1], down[2], down[3]);
                }
                jacobian.row(row++) =
                    type.order * (control_point(type, x, plus) - control_point(type, x, minus)).leftCols(dim);
            }
        values.push_back(jacobian.determinant());
    }
    return values;
}

/// Elements sheared to within rounding of a line or plane: the sign of J drowns in rounding errors, and only a right
/// error bound keeps the certificate from claiming what it does not know.
TEST(JacobianBoundsTest, FlatElementsAreNeverFalselyJudged) {
    std::mt19937 random(11);
    std::normal_distribution<double> normal;
    int decided = 0, undecided = 0;
    for (const Shape shape :
         {Shape::triangle, Shape::quadrilateral, Shape::tetrahedron, Shape::hexahedron, Shape::prism})
        for (int order = 1; order <= 4; ++order) {
            const ElementType type{shape, order};
            const int dim = dimension(shape);
            JacobianBounds bounds(type);
            for (int trial = 0; trial < (is_simplex(shape) ? 1500 : 300); ++trial) {
                Eigen::MatrixX3d x = reference_nodes(type);
                if (trial % 3 > 0)
                    for (Eigen::Index i = 0; i < x.rows(); ++i)
                        for (int d = 0; d < dim; ++d) x(i, d) += 0.02 * normal(random);
                const double slope = normal(random), thickness = std::pow(10.0, -12 - 6.0 * (trial % 100) / 100);
                x.col(dim - 1) = slope * x.col(0) + thickness * x.col(dim - 1);
                if (dim == 3) x.col(2) -= 0.3 * slope * x.col(1);
                const ElementQuality q = bounds.bound(x, 1.0, {});
                const auto exact = corner_jacobians(type, x, bounds.form());
                const auto [low, high] = std::minmax_element(exact.begin(), exact.end());
                // Extended precision has 11 bits more; within its own noise it says nothing.
                const long double noise = 1e-3L * bounds.coefficient_error() * std::scalbn(1.0L, bounds.exponent());
                if (q.validity == Validity::valid) {
                    EXPECT_GT(*low, -noise) << name(type) << ", trial " << trial;
                }
                EXPECT_LE(q.min_lower, *low + noise);
                EXPECT_GE(q.max_upper, *high - noise);
                const auto& corners = bounds.form().corners();
                for (std::size_t corner = 0; corner < corners.size(); ++corner) {
                    const long double computed = std::scalbn(
                        static_cast<long double>(bounds.coefficients()[corners[corner].position]), bounds.exponent());
                    EXPECT_LE(std::abs(computed - exact[corner]),
                              1.001L * bounds.coefficient_error() * std::scalbn(1.0L, bounds.exponent()));
                }
                ++(q.validity == Validity::undecided ? undecided : decided);
            }
        }
    EXPECT_GT(decided, 1000);
    EXPECT_GT(undecided, 1000);
}

TEST(JacobianBoundsTest, TinyAndHugeElementsAreJudgedLikeOthers) {
    std::mt19937 random(13);
    for (const ElementType type : curved_types)
        for (int trial = 0; trial < 100; ++trial) {
            JacobianBounds bounds(type);
            const Eigen::MatrixX3d x = random_element(type, 0.4, random);
            const ElementQuality plain = bounds.bound(x, 1.0, {});
            for (const int power : {-900, -355, 340, 900}) {
                const Eigen::MatrixX3d scaled = std::scalbn(1.0, power) * x;
                const ElementQuality q = bounds.bound(scaled, 1.0, {});
                EXPECT_EQ(q.validity, plain.validity) << power;
                EXPECT_EQ(q.scaled_jacobian, plain.scaled_jacobian) << power;
            }
        }
    Eigen::MatrixX3d overflowing(3, 3);
    overflowing << -1.5e308, 0, 0, 1.5e308, 0, 0, 0, 1, 0;
    EXPECT_EQ(JacobianBounds({Shape::triangle, 1}).bound(overflowing, 1.0, {}).validity, Validity::undecided);
}

TEST(JacobianBoundsTest, WhatIsNoNumberIsUndecided) {
    std::mt19937 random(19);
    for (const ElementType type : curved_types)
        for (const double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()})
            for (const Eigen::Index node : {Eigen::Index{0}, Eigen::Index{4}}) {
                Eigen::MatrixX3d x = random_element(type, 0.1, random);
                x(node, 1) = bad;
                const ElementQuality q = JacobianBounds(type).bound(x, 1.0, {});
                EXPECT_EQ(q.validity, Validity::undecided);
                EXPECT_EQ(q.scaled_jacobian, 0.0);
            }
}

/// The J of an element of order 1 whose opposite sides or faces are parallel has its extrema at corners and as outer
/// coefficients: such elements are judged without a single bisection.
TEST(JacobianBoundsTest, MultilinearElementsOfKnownJacobianNeedNoBisection) {
    const QualityOptions at_once{2.5e-4, 0, {}};
    JacobianBounds quadrilateral({Shape::quadrilateral, 1});
    Eigen::MatrixX3d x(4, 3);
    const double s = 0.3;
    x << 0, 0, 0, 1, 0, 0, 0.6, 1, 0, 0.6 - s, 1, 0;  // trapezoid: J as wide as the element is
    ElementQuality q = quadrilateral.bound(x, 1.0, at_once);
    EXPECT_EQ(q.validity, Validity::valid);
    EXPECT_NEAR(q.scaled_jacobian, s, 1e-14);
    // The fourth corner inside the triangle of the others: J = the cross product of its sides, against 1 at the first.
    x << 0, 0, 0, 1, 0, 0, 0.2, 0.2, 0, 0, 1, 0;
    q = quadrilateral.bound(x, 1.0, at_once);
    EXPECT_EQ(q.validity, Validity::invalid);
    EXPECT_NEAR(q.scaled_jacobian, -0.6, 1e-14);
    x << 0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0;  // crossed
    EXPECT_EQ(quadrilateral.bound(x, 1.0, at_once).validity, Validity::invalid);

    Eigen::MatrixX3d frustum = reference_nodes({Shape::hexahedron, 1});
    for (Eigen::Index i = 0; i < frustum.rows(); ++i)
        if (frustum(i, 2) == 1.0) frustum.row(i).head<2>() *= s;
    q = JacobianBounds({Shape::hexahedron, 1}).bound(frustum, 1.0, at_once);
    EXPECT_EQ(q.validity, Validity::valid);
    EXPECT_NEAR(q.scaled_jacobian, s * s, 1e-14);
    Eigen::MatrixX3d wedge = reference_nodes({Shape::prism, 1});
    for (Eigen::Index i = 0; i < wedge.rows(); ++i)
        if (wedge(i, 2) == 1.0) wedge.row(i).head<2>() *= s;
    q = JacobianBounds({Shape::prism, 1}).bound(wedge, 1.0, at_once);
    EXPECT_EQ(q.validity, Validity::valid);
    EXPECT_NEAR(q.scaled_jacobian, s * s, 1e-14);
}

/// A hexahedron whose J is positive in all corners but not everywhere.
TEST(JacobianBoundsTest, PositiveCornersDoNotMakeAHexahedronValid) {
    std::mt19937 random(29);
    const ElementType type{Shape::hexahedron, 1};
    JacobianBounds bounds(type);
    int found = 0;
    for (int trial = 0; trial < 4000; ++trial) {
        const Eigen::MatrixX3d x = random_element(type, 0.25, random);
        const ElementQuality q = bounds.bound(x, 1.0, {});
        const auto corners = corner_jacobians(type, x, bounds.form());
        if (q.validity != Validity::invalid || *std::min_element(corners.begin(), corners.end()) <= 0.0L) continue;
        ++found;
        EXPECT_LT(sampled_range(type, x, 24).first, 1e-3 * static_cast<double>(corners[0]));
    }
    EXPECT_GT(found, 0);
}

TEST(JacobianBoundsTest, RefusesElementsWithoutAPolynomialJacobian) {
    EXPECT_THROW(JacobianBounds({Shape::pyramid, 1}), Unsupported);
    EXPECT_THROW(JacobianBounds({Shape::line, 2}), Unsupported);
}

TEST(JacobianBoundsTest, BudgetRunsOutAsUndecided) {
    std::mt19937 random(3);
    const ElementType type{Shape::triangle, 4};
    JacobianBounds bounds(type);
    int undecided = 0;
    for (int i = 0; i < 200; ++i) {
        const Eigen::MatrixX3d x = random_element(type, 0.25, random);
        const ElementQuality full = bounds.bound(x, 1.0, {});
        const ElementQuality none = bounds.bound(x, 1.0, {2.5e-4, 0, {}});
        if (none.validity == Validity::undecided) {
            ++undecided;
        } else {
            EXPECT_EQ(none.validity, full.validity);
        }
    }
    EXPECT_GT(undecided, 0);
}

TEST(JacobianBoundsTest, WorstPointAttainsTheMinimum) {
    std::mt19937 random(31);
    for (const ElementType type : curved_types) {
        const Eigen::MatrixX3d x = random_element(type, 0.4, random);
        const ElementQuality q = JacobianBounds(type).bound(x, 1.0, {});
        const BasisTable basis =
            lagrange_basis(type, Eigen::RowVector3d(q.worst_point[0], q.worst_point[1], q.worst_point[2]));
        const int dim = dimension(type.shape);
        Eigen::MatrixXd jacobian(dim, dim);
        for (int k = 0; k < dim; ++k) jacobian.col(k) = (basis.gradients[k] * x).row(0).head(dim).transpose();
        EXPECT_NEAR(jacobian.determinant(), q.min_upper, 1e-9);
    }
}

}  // namespace
}  // namespace curvewright
