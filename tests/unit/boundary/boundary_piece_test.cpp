#include "core/boundary/boundary_piece.h"

#include <cmath>
#include <limits>
#include <random>

#include <gtest/gtest.h>

#include "core/basis/lagrange.h"

namespace curvewright {
namespace {

/// The reference element on a bent surface, its nodes moved at random.
BoundaryPiece random_piece(ElementType type, std::mt19937& random) {
    Eigen::MatrixX3d x = reference_nodes(type);
    std::uniform_real_distribution<double> shift(-0.15, 0.15);
    for (Eigen::Index i = 0; i < x.rows(); ++i) {
        x(i, 2) = 0.3 * x(i, 0) * x(i, 0) - 0.2 * x(i, 0) * x(i, 1);
        for (int d = 0; d < 3; ++d) x(i, d) += shift(random) / (type.order * type.order);
    }
    return {type, x};
}

constexpr std::array shapes = {Shape::line, Shape::triangle, Shape::quadrilateral};

TEST(BoundaryPiece, ValuesAreThoseOfTheBasisAndDerivativesThoseOfDifferences) {
    std::mt19937 random(1);
    for (const Shape shape : shapes)
        for (int order = 1; order <= 6; ++order) {
            const ElementType type{shape, order};
            const BoundaryPiece piece = random_piece(type, random);
            const Eigen::Vector2d at(0.31, shape == Shape::line ? 0.0 : 0.27);
            Eigen::MatrixX3d point(1, 3);
            point << at[0], at[1], 0.0;
            const Jet jet = piece.evaluate(at);
            const Eigen::Vector3d value = (lagrange_basis(type, point).values * piece.nodes()).transpose();
            EXPECT_LT((jet.value - value).norm(), 1e-13) << name(type);
            constexpr double h = 1e-5;
            for (int k = 0; k < (shape == Shape::line ? 1 : 2); ++k) {
                Eigen::Vector2d step = Eigen::Vector2d::Zero();
                step[k] = h;
                const Jet plus = piece.evaluate(at + step), minus = piece.evaluate(at - step);
                const auto i = static_cast<std::size_t>(k);
                EXPECT_LT((jet.first[i] - (plus.value - minus.value) / (2 * h)).norm(), 1e-8) << name(type);
                EXPECT_LT((jet.second[i] - (plus.first[0] - minus.first[0]) / (2 * h)).norm(), 1e-7) << name(type);
                if (k == 1) {
                    EXPECT_LT((jet.second[2] - (plus.first[1] - minus.first[1]) / (2 * h)).norm(), 1e-7);
                }
            }
        }
}

TEST(BoundaryPiece, TheClosestPointIsAsCloseAsTheBestOfManySamples) {
    std::mt19937 random(2);
    std::uniform_real_distribution<double> coordinate(-0.3, 1.3), height(-0.1, 0.1);
    int held = 0;
    for (const Shape shape : shapes)
        for (int trial = 0; trial < 100; ++trial) {
            const BoundaryPiece piece = random_piece({shape, 1 + trial % 4}, random);
            const Eigen::Vector3d y(coordinate(random), coordinate(random), height(random));
            const Closest closest = piece.closest(y, {});
            held += closest.edge >= 0 || closest.corner >= 0;
            double best = std::numeric_limits<double>::infinity();
            constexpr int n = 60;
            for (int i = 0; i <= n; ++i)
                for (int j = 0; j <= (shape == Shape::line ? 0 : shape == Shape::triangle ? n - i : n); ++j)
                    best = std::min(best, (piece.evaluate({double(i) / n, double(j) / n}).value - y).norm());
            EXPECT_LE(std::sqrt(closest.squared_distance), best + 1e-12) << name(piece.type()) << ", trial " << trial;
            EXPECT_NEAR((piece.evaluate(closest.at).value - y).norm(), std::sqrt(closest.squared_distance), 1e-14);
        }
    EXPECT_GT(held, 100);
}

TEST(BoundaryPiece, DerivativeOfTheClosestPointIsThatOfDifferences) {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> coordinate(-0.2, 1.2), height(-0.1, 0.1);
    std::array<int, 3> kinds{};
    for (const Shape shape : shapes)
        for (int trial = 0; trial < 60; ++trial) {
            const BoundaryPiece piece = random_piece({shape, 1 + trial % 4}, random);
            const Eigen::Vector3d y(coordinate(random), coordinate(random), height(random));
            const Closest closest = piece.closest(y, {});
            const Eigen::Matrix3d derivative = piece.closest_derivative(y, closest);
            constexpr double h = 1e-6;
            for (int d = 0; d < 3; ++d) {
                Eigen::Vector3d step = Eigen::Vector3d::Zero();
                step[d] = h;
                const Closest plus = piece.closest(y + step, closest.at), minus = piece.closest(y - step, closest.at);
                if (plus.edge != minus.edge || plus.corner != minus.corner) continue;  // at the edge of a region
                const Eigen::Vector3d difference =
                    (piece.evaluate(plus.at).value - piece.evaluate(minus.at).value) / (2 * h);
                EXPECT_LT((derivative.col(d) - difference).norm(), 1e-6) << name(piece.type()) << ", trial " << trial;
                ++kinds[closest.corner >= 0 ? 2 : closest.edge >= 0 ? 1 : 0];
            }
        }
    for (const int count : kinds) EXPECT_GT(count, 30);
}

TEST(BoundaryPiece, PointsOfAFoldedCurveAreFoundAllTheSame) {
    Eigen::MatrixX3d x(3, 3);
    x << 0, 0, 0, 1, 0, 0, 0.9, 0, 0;  // goes a little beyond its end, and back
    const BoundaryPiece piece({Shape::line, 2}, x);
    for (const double target : {0.0, 0.3, 0.8, 0.99, 1.0})
        EXPECT_LT(piece.closest({target, 0.0, 0.0}, {}).squared_distance, 1e-24) << target;
}

}  // namespace
}  // namespace curvewright
