#include "core/quality/jacobian_samples.h"

#include <random>

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/basis/lagrange.h"
#include "core/quality/quality.h"
#include "tests/support/mesh_factory.h"

namespace curvewright {
namespace {

using namespace curvewright::testing;

TEST(JacobianSamples, LieWithinWhatIsProved) {
    std::mt19937 random(3);
    for (const Shape shape :
         {Shape::triangle, Shape::quadrilateral, Shape::tetrahedron, Shape::hexahedron, Shape::prism})
        for (const int order : {1, 2, 4}) {
            const ElementType type{shape, order};
            const Eigen::MatrixX3d x = random_element(type, 0.2, random);
            const QualityReport report =
                assess_quality(single_element(type, x), {.tolerance = 1e-6, .orientation_sign = 1.0});
            const ElementQuality& quality = report.elements.front();
            const JacobianSamples samples = sample_jacobian(type, x, reference_nodes({shape, 7}));
            const double rounding = 1e-12 * std::abs(quality.max_upper);
            EXPECT_GE(samples.determinants.minCoeff(), quality.min_lower - rounding) << name(type);
            EXPECT_LE(samples.determinants.maxCoeff(), quality.max_upper + rounding) << name(type);
            // At its worst point J lies where the certificate says that its minimum lies.
            Eigen::MatrixX3d worst(1, 3);
            worst << quality.worst_point[0], quality.worst_point[1], quality.worst_point[2];
            const double least = sample_jacobian(type, x, worst).determinants[0];
            EXPECT_GE(least, quality.min_lower - rounding) << name(type);
            EXPECT_LE(least, quality.min_upper + rounding) << name(type);
            // The map goes through the nodes.
            EXPECT_LT((sample_jacobian(type, x, reference_nodes(type)).positions - x).cwiseAbs().maxCoeff(), 1e-12);
        }
    EXPECT_THROW(sample_jacobian({Shape::line, 2}, Eigen::MatrixX3d::Zero(3, 3), Eigen::MatrixX3d::Zero(1, 3)),
                 Unsupported);
}

}  // namespace
}  // namespace curvewright
