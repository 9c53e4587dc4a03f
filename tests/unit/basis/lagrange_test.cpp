#include "core/basis/lagrange.h"

#include <random>

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "tests/unit/basis/element_types.h"

namespace curvewright {
namespace {

std::vector<ElementType> polynomial_types() {
    std::vector<ElementType> types;
    for (const ElementType type : all_types())
        if (type.shape != Shape::pyramid && type.shape != Shape::vertex) types.push_back(type);
    return types;
}

/// Points in the reference element (for simplices: the random cube's points folded into it).
Eigen::MatrixX3d random_points(ElementType type, int count) {
    std::mt19937 random(7u * static_cast<unsigned>(type.order) + static_cast<unsigned>(type.shape));
    std::uniform_real_distribution<double> uniform(0.0, 1.0);
    Eigen::MatrixX3d points = Eigen::MatrixX3d::Zero(count, 3);
    for (int row = 0; row < count; ++row) {
        for (int d = 0; d < dimension(type.shape); ++d) points(row, d) = uniform(random);
        const int simplex = type.shape == Shape::prism ? 2 : is_simplex(type.shape) ? dimension(type.shape) : 0;
        while (simplex > 1 && points.row(row).head(simplex).sum() > 1.0)
            for (int d = 0; d < simplex; ++d) points(row, d) = uniform(random);
    }
    return points;
}

/// Sums of |shape functions| stay below this at every order up to 10 (equispaced nodes, three directions).
constexpr double rounding = 1e-10;

TEST(Lagrange, is_one_at_its_node_and_zero_at_the_others) {
    for (const ElementType type : polynomial_types()) {
        const BasisTable table = lagrange_basis(type, reference_nodes(type));
        const Eigen::MatrixXd identity = Eigen::MatrixXd::Identity(table.values.rows(), table.values.cols());
        EXPECT_LT((table.values - identity).cwiseAbs().maxCoeff(), rounding) << name(type);
    }
}

TEST(Lagrange, sums_to_one_and_its_gradients_to_zero) {
    for (const ElementType type : polynomial_types()) {
        const BasisTable table = lagrange_basis(type, random_points(type, 5));
        EXPECT_LT((table.values.rowwise().sum().array() - 1.0).abs().maxCoeff(), rounding) << name(type);
        for (int d = 0; d < dimension(type.shape); ++d)
            EXPECT_LT(table.gradients[d].rowwise().sum().cwiseAbs().maxCoeff(), 100 * rounding) << name(type);
    }
}

TEST(Lagrange, reproduces_polynomials_of_its_order_and_their_derivatives) {
    // (a + b·x)^p lies in the space of every shape, and its derivative is known.
    const Eigen::Vector3d b(0.5, -0.7, 0.3);
    for (const ElementType type : polynomial_types()) {
        const int p = type.order, dim = dimension(type.shape);
        Eigen::Vector3d slope = Eigen::Vector3d::Zero();
        slope.head(dim) = b.head(dim);
        const Eigen::VectorXd at_nodes = ((reference_nodes(type) * slope).array() + 0.6).pow(p);
        const Eigen::MatrixX3d points = random_points(type, 5);
        const BasisTable table = lagrange_basis(type, points);
        const Eigen::ArrayXd base = (points * slope).array() + 0.6;
        EXPECT_LT(((table.values * at_nodes).array() - base.pow(p)).abs().maxCoeff(), rounding) << name(type);
        for (int d = 0; d < dim; ++d) {
            const Eigen::ArrayXd derivative = p * slope(d) * base.pow(p - 1);
            EXPECT_LT(((table.gradients[d] * at_nodes).array() - derivative).abs().maxCoeff(), 100 * rounding)
                << name(type) << " direction " << d;
        }
    }
}

TEST(Lagrange, gradients_agree_with_central_differences) {
    // Error of a central difference: h^2/6 |f'''| + eps |f| / h; functions of order <= 4 have third derivatives < 1e4.
    const double h = 1e-5, bound = h * h / 6 * 1e4 + 1e-15 * 100 / h;
    for (const ElementType type : polynomial_types()) {
        if (type.order > 4) continue;
        const Eigen::MatrixX3d points = random_points(type, 3);
        const BasisTable table = lagrange_basis(type, points);
        for (int d = 0; d < dimension(type.shape); ++d) {
            Eigen::MatrixX3d ahead = points, behind = points;
            ahead.col(d).array() += h;
            behind.col(d).array() -= h;
            const Eigen::MatrixXd difference =
                (lagrange_basis(type, ahead).values - lagrange_basis(type, behind).values) / (2 * h);
            EXPECT_LT((table.gradients[d] - difference).cwiseAbs().maxCoeff(), bound) << name(type);
        }
    }
}

TEST(Lagrange, refuses_pyramids) {
    EXPECT_THROW(lagrange_basis({Shape::pyramid, 2}, Eigen::MatrixX3d::Zero(1, 3)), Unsupported);
}

}  // namespace
}  // namespace curvewright
