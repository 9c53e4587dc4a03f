#include "core/warp/weights.h"

#include <algorithm>
#include <cmath>
#include <random>

#include <gtest/gtest.h>
#include <Eigen/LU>
#include <Eigen/QR>

#include "tests/support/mesh_factory.h"
#include "tests/unit/warp/convex_reference.h"

namespace curvewright {
namespace {

/// Random neighbours around the origin, which is strictly inside their hull: they come in noisy opposite pairs.
Eigen::MatrixXd random_patch(int pairs, int dim, std::mt19937& random) {
    std::normal_distribution<double> normal;
    Eigen::MatrixXd y(2 * pairs, dim);
    for (int j = 0; j < pairs; ++j)
        for (int d = 0; d < dim; ++d) {
            const double v = normal(random);
            y(2 * j, d) = v + 0.3 * normal(random);
            y(2 * j + 1, d) = -v + 0.3 * normal(random);
        }
    return y;
}

TEST(ConvexWeights, AgreeWithNewtonOnTheFullKktSystem) {
    std::mt19937 random(1);
    for (const int dim : {2, 3})
        for (const int pairs : {3, 6, 15})
            for (const double power : {0.0, 2.0}) {
                const Eigen::MatrixXd y = random_patch(pairs, dim, random);
                Eigen::VectorXd w(y.rows());
                ASSERT_EQ(convex_weights(y, influences(y, power), w), PatchStatus::regular);
                EXPECT_LT((w - testing::convex_weights_by_kkt(y, influences(y, power))).cwiseAbs().maxCoeff(), 1e-8);
            }
}

TEST(ConvexWeights, ArePositiveSumToOneAndReproduceTheNode) {
    std::mt19937 random(2);
    for (int trial = 0; trial < 200; ++trial) {
        const int dim = 2 + trial % 2;
        const double power = trial % 5;
        Eigen::MatrixXd y = random_patch(4 + trial % 20, dim, random);
        y.col(0) *= std::pow(10.0, trial % 7 - 3);  // stretched, as in a boundary layer
        Eigen::VectorXd w(y.rows());
        ASSERT_EQ(convex_weights(y, influences(y, power), w), PatchStatus::regular);
        EXPECT_GT(w.minCoeff(), 0.0);
        EXPECT_NEAR(w.sum(), 1.0, 1e-12);
        const Eigen::RowVectorXd moment = w.transpose() * y;
        for (int d = 0; d < dim; ++d) EXPECT_LT(std::abs(moment[d]), 1e-10 * y.col(d).cwiseAbs().maxCoeff());
    }
}

TEST(ConvexWeights, NodeOutsideOrOnTheHullIsDetected) {
    Eigen::MatrixXd outside(4, 2), edge(4, 2), line(3, 2);
    outside << 1, 1, 2, 1, 1, 2, 3, 3;
    edge << -1, 0, 1, 0, 0, 1, 0, 2;
    line << -1, 0, 1, 0, 2, 0;
    Eigen::VectorXd w(4), w3(3);
    EXPECT_EQ(convex_weights(outside, influences(outside, 0), w), PatchStatus::outside_hull);
    EXPECT_EQ(convex_weights(edge, influences(edge, 0), w), PatchStatus::outside_hull);
    EXPECT_EQ(convex_weights(line, influences(line, 0), w3), PatchStatus::outside_hull);
}

TEST(AffineWeights, AgreeWithTheMinimumNormSolutionByQr) {
    std::mt19937 random(3);
    const double power = 0.0;
    for (const int dim : {2, 3})
        for (int trial = 0; trial < 50; ++trial) {
            Eigen::MatrixXd y = random_patch(3 + trial, dim, random);
            y.rowwise() += Eigen::RowVectorXd::Constant(dim, 0.7);  // affine weights need no hull
            y *= std::pow(10.0, trial % 9 - 4);
            Eigen::VectorXd w(y.rows());
            ASSERT_EQ(affine_weights(y, influences(y, power), w), PatchStatus::regular);
            Eigen::MatrixXd a(dim + 1, y.rows());
            a.topRows(dim) = y.transpose() / y.cwiseAbs().maxCoeff();
            a.row(dim).setOnes();
            // Thesis 2.9: reduced QR of A^T, w = Q R^-T b.
            const Eigen::HouseholderQR<Eigen::MatrixXd> qr(a.transpose());
            const Eigen::MatrixXd q = qr.householderQ() * Eigen::MatrixXd::Identity(y.rows(), dim + 1);
            const Eigen::MatrixXd r = qr.matrixQR().topRows(dim + 1).triangularView<Eigen::Upper>();
            const Eigen::VectorXd reference =
                q * r.transpose().triangularView<Eigen::Lower>().solve(Eigen::VectorXd::Unit(dim + 1, dim));
            EXPECT_LT((w - reference).cwiseAbs().maxCoeff(), 1e-10);
        }
}

TEST(AffineWeights, MinimiseTheWeightedNorm) {
    // Any other weights that satisfy the constraints, w + z with A z = 0, have a larger sum w^2 / c.
    std::mt19937 random(4);
    const Eigen::MatrixXd y = random_patch(6, 2, random);
    const Eigen::VectorXd c = influences(y, 2.0);
    Eigen::VectorXd w(y.rows());
    ASSERT_EQ(affine_weights(y, c, w), PatchStatus::regular);
    Eigen::MatrixXd a(3, y.rows());
    a.topRows(2) = y.transpose();
    a.row(2).setOnes();
    EXPECT_LT((a * w - Eigen::Vector3d(0, 0, 1)).norm(), 1e-12);
    const Eigen::MatrixXd kernel = Eigen::FullPivLU<Eigen::MatrixXd>(a).kernel();
    for (Eigen::Index k = 0; k < kernel.cols(); ++k)
        EXPECT_NEAR(w.cwiseQuotient(c).dot(kernel.col(k)), 0.0, 1e-12 * kernel.col(k).norm());
}

TEST(Influences, FallWithTheDistanceAndHaveMeanOne) {
    Eigen::MatrixXd y(3, 2);
    y << 1, 0, 0, 2, -4, 0;
    EXPECT_EQ(influences(y, 0.0), Eigen::VectorXd::Ones(3));
    const Eigen::VectorXd c = influences(y, 2.0);
    EXPECT_NEAR(c.mean(), 1.0, 1e-15);
    EXPECT_NEAR(c[0] / c[1], 4.0, 1e-12);
    EXPECT_NEAR(c[0] / c[2], 16.0, 1e-12);
    y.row(0).setZero();
    EXPECT_TRUE(influences(y, 2.0).allFinite());
}

TEST(AffineWeights, DegeneratePatchIsReported) {
    Eigen::MatrixXd line(4, 2);
    line << -1, 1, 1, -1, 2, -2, 3, -3;  // the node is on their line: weights exist, but the patch has no area
    Eigen::VectorXd w(4);
    EXPECT_EQ(affine_weights(line, influences(line, 2), w), PatchStatus::degenerate);
    EXPECT_NEAR(w.sum(), 1.0, 1e-12);
    EXPECT_LT((w.transpose() * line).norm(), 1e-12);
}

TEST(ComputeWeights, FallBackToAffineWhereConvexDoNotExist) {
    CurvedMesh mesh = testing::square_mesh(2, 1);  // one interior node, in the middle
    Coordinates x = mesh.coordinates();
    x.row(mesh.topology().interior_nodes().front()) << 1.5, 0.5, 0.0;
    mesh = mesh.with_coordinates(x);
    const NeighbourSets sets = find_neighbours(mesh.topology(), mesh.topology().interior_nodes());
    const WeightTable table = compute_weights(mesh, sets, convex_weighting(2.0));
    ASSERT_EQ(table.status.size(), 1u);
    EXPECT_EQ(table.status[0], PatchStatus::outside_hull);
    EXPECT_EQ(compute_weights(mesh, sets, affine_weighting(2.0)).weights, table.weights);
}

}  // namespace
}  // namespace curvewright
