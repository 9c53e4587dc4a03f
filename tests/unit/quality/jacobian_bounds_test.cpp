#include "core/quality/jacobian_bounds.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>
#include <Eigen/LU>

#include "core/basis/bernstein.h"
#include "core/basis/lagrange.h"
#include "core/basis/node_ordering.h"
#include "tests/support/mesh_factory.h"

namespace curvewright {
namespace {

using testing::random_simplex;

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

struct Case {
    Shape shape;
    int order;
};

class EveryOrder : public ::testing::TestWithParam<Case> {};

TEST_P(EveryOrder, BoundsEncloseDenseSamplesAndAreTight) {
    const ElementType type{GetParam().shape, GetParam().order};
    const bool is_solid = type.shape == Shape::tetrahedron;
    std::mt19937 random(17 + type.order);
    JacobianBounds bounds(type);
    const int elements = type.order <= 4 ? 12 : is_solid ? 2 : 4;
    const int samples = is_solid ? (type.order <= 4 ? 20 : 16) : 48;
    for (int i = 0; i < elements; ++i) {
        // High orders: small motions, or every element is hopelessly tangled.
        const Eigen::MatrixX3d x = random_simplex(type, type.order <= 4 ? 0.35 : 0.1, random);
        const ElementQuality q = bounds.bound(x, 1.0, {});
        const auto [low, high] = sampled_range(type, x, samples);
        const double scale = std::max(std::abs(low), std::abs(high));
        EXPECT_LE(q.min_lower, low + 1e-12 * scale);
        EXPECT_GE(q.max_upper, high - 1e-12 * scale);
        EXPECT_LE(q.min_upper - q.min_lower, 3e-3 * scale);
        EXPECT_LE(q.max_upper - q.max_lower, 3e-3 * scale);
        // The samples come close to the extrema (in high orders not close enough), so a bound that is far off shows.
        if (type.order <= 5) {
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

TEST_P(EveryOrder, StraightElementHasScaledJacobianOne) {
    const ElementType type{GetParam().shape, GetParam().order};
    std::mt19937 random(5);
    const Eigen::MatrixX3d x = random_simplex(type, 0.0, random);
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
    const Eigen::MatrixX3d x = random_simplex(type, type.order <= 4 ? 0.3 : 0.1, random);
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

/// J at the corners of an element in extended precision: at a corner the derivatives involve the nodes of the adjacent
/// edges only, with the integer-quotient weights of the one-dimensional Lagrange derivative.
std::vector<long double> corner_jacobians(ElementType type, const Eigen::MatrixX3d& x) {
    const int dim = dimension(type.shape);
    const ExtendedMatrix& bezier = lagrange_to_bernstein(type);
    const BernsteinSimplex& form = BernsteinSimplex::get(dim, type.order);
    using Matrix = Eigen::Matrix<long double, Eigen::Dynamic, Eigen::Dynamic>;
    const Matrix control = bezier * (x.rowwise() - x.row(0)).leftCols(dim).cast<long double>();
    std::vector<long double> values;
    for (int corner = 0; corner <= dim; ++corner) {
        // The tangents at a corner lead to the control points next to it; those of direction k end minus those of 0.
        Matrix jacobian(dim, dim);
        for (int k = 0; k < dim; ++k) {
            auto plus = form.indices()[form.corners()[corner]], minus = plus;
            --plus[corner], ++plus[k + 1];
            --minus[corner], ++minus[0];
            jacobian.row(k) = type.order * (control.row(form.position(plus[1], plus[2], plus[3])) -
                                            control.row(form.position(minus[1], minus[2], minus[3])));
        }
        values.push_back(jacobian.determinant());
    }
    return values;
}

/// Elements sheared to within rounding of a line or plane: the sign of J drowns in rounding errors, and only a right error
/// bound keeps the certificate from claiming what it does not know.
TEST(JacobianBoundsTest, FlatElementsAreNeverFalselyJudged) {
    std::mt19937 random(11);
    std::normal_distribution<double> normal;
    int decided = 0, undecided = 0;
    for (const Shape shape : {Shape::triangle, Shape::tetrahedron})
        for (int order = 1; order <= 4; ++order) {
            const ElementType type{shape, order};
            const int dim = dimension(shape);
            JacobianBounds bounds(type);
            for (int trial = 0; trial < 1500; ++trial) {
                Eigen::MatrixX3d x = reference_nodes(type);
                if (trial % 3 > 0)
                    for (Eigen::Index i = 0; i < x.rows(); ++i)
                        for (int d = 0; d < dim; ++d) x(i, d) += 0.02 * normal(random);
                const double slope = normal(random), thickness = std::pow(10.0, -12 - 6.0 * (trial % 100) / 100);
                x.col(dim - 1) = slope * x.col(0) + thickness * x.col(dim - 1);
                if (dim == 3) x.col(2) -= 0.3 * slope * x.col(1);
                const ElementQuality q = bounds.bound(x, 1.0, {});
                const auto exact = corner_jacobians(type, x);
                const auto [low, high] = std::minmax_element(exact.begin(), exact.end());
                // Extended precision has 11 bits more; within its own noise it says nothing.
                const long double noise = 1e-3L * bounds.coefficient_error() * std::scalbn(1.0L, bounds.exponent());
                if (q.validity == Validity::valid) {
                    EXPECT_GT(*low, -noise) << name(type) << ", trial " << trial;
                }
                EXPECT_LE(q.min_lower, *low + noise);
                EXPECT_GE(q.max_upper, *high - noise);
                const BernsteinSimplex& form = BernsteinSimplex::get(dim, dim * (order - 1));
                for (int corner = 0; corner <= dim; ++corner) {
                    const long double computed =
                        std::scalbn(static_cast<long double>(bounds.coefficients()[form.corners()[corner]]),
                                    bounds.exponent());
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
    for (const ElementType type : {ElementType{Shape::triangle, 3}, ElementType{Shape::tetrahedron, 2}})
        for (int trial = 0; trial < 100; ++trial) {
            JacobianBounds bounds(type);
            const Eigen::MatrixX3d x = random_simplex(type, 0.4, random);
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

TEST(JacobianBoundsTest, BudgetRunsOutAsUndecided) {
    std::mt19937 random(3);
    const ElementType type{Shape::triangle, 4};
    JacobianBounds bounds(type);
    int undecided = 0;
    for (int i = 0; i < 200; ++i) {
        const Eigen::MatrixX3d x = random_simplex(type, 0.25, random);
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
    for (const ElementType type : {ElementType{Shape::triangle, 3}, ElementType{Shape::tetrahedron, 2}}) {
        const Eigen::MatrixX3d x = random_simplex(type, 0.4, random);
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
