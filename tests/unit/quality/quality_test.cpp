#include "core/quality/quality.h"

#include <gtest/gtest.h>
#include <algorithm>

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "tests/support/mesh_factory.h"

namespace curvewright {
namespace {

using testing::cube_mesh;
using testing::shaken;
using testing::square_mesh;

TEST(AssessQuality, StraightMeshesAreValidWithScaledJacobianOne) {
    for (int order = 1; order <= 4; ++order)
        for (const CurvedMesh& mesh : {square_mesh(3, order), cube_mesh(2, order), testing::quad_mesh(3, order),
                                       testing::hex_mesh(2, order), testing::prism_mesh(2, order),
                                       testing::mixed_square_mesh(2, order), testing::mixed_cube_mesh(2, order)}) {
            const QualityReport report = assess_quality(mesh);
            EXPECT_EQ(report.summary.valid, mesh.topology().element_count());
            EXPECT_NEAR(report.summary.min, 1.0, 1e-10);
            EXPECT_NEAR(report.summary.mean, 1.0, 1e-10);
            EXPECT_EQ(report.orientation, Orientation::positive);
        }
}

TEST(AssessQuality, ReportIsTheSameForEveryThreadCount) {
    std::mt19937 random(7);
    const CurvedMesh mesh = shaken(cube_mesh(3, 2), 0.05, random);
    set_thread_count(1);
    const QualityReport one = assess_quality(mesh);
    set_thread_count(4);
    const QualityReport four = assess_quality(mesh);
    set_thread_count(0);
    EXPECT_EQ(one.summary.mean, four.summary.mean);
    for (std::size_t i = 0; i < one.elements.size(); ++i) {
        EXPECT_EQ(one.elements[i].scaled_jacobian, four.elements[i].scaled_jacobian);
        EXPECT_EQ(one.elements[i].min_lower, four.elements[i].min_lower);
    }
}

TEST(AssessQuality, SummaryCountsAndWorstListAgreeWithTheElements) {
    std::mt19937 random(9);
    const CurvedMesh mesh = shaken(square_mesh(6, 3), 0.04, random);
    const QualityReport report = assess_quality(mesh);
    EXPECT_GT(report.summary.invalid, 0);
    EXPECT_GT(report.summary.valid, 0);
    EXPECT_EQ(report.summary.elements(), mesh.topology().element_count());
    const auto worst = report.worst(5);
    ASSERT_EQ(worst.size(), 5u);
    EXPECT_EQ(report.elements[worst[0]].scaled_jacobian, report.summary.min);
    for (std::size_t i = 1; i < worst.size(); ++i)
        EXPECT_LE(report.elements[worst[i - 1]].scaled_jacobian, report.elements[worst[i]].scaled_jacobian);
}

TEST(Orientation, ClockwiseMeshIsJudgedTheOtherWayRoundAndCanBeFlipped) {
    std::mt19937 random(11);
    for (const CurvedMesh& mesh :
         {shaken(square_mesh(4, 3), 0.02, random), shaken(cube_mesh(2, 3), 0.02, random),
          shaken(testing::quad_mesh(4, 3), 0.02, random), shaken(testing::hex_mesh(2, 2), 0.04, random),
          shaken(testing::prism_mesh(2, 2), 0.04, random), shaken(testing::mixed_square_mesh(4, 2), 0.04, random),
          shaken(testing::mixed_cube_mesh(2, 1), 0.04, random)}) {
        const CurvedMesh clockwise = flip_orientation(mesh);
        const QualityReport original = assess_quality(mesh), report = assess_quality(clockwise);
        EXPECT_EQ(report.orientation, Orientation::negative);
        EXPECT_EQ(report.summary.invalid, original.summary.invalid);
        EXPECT_NEAR(report.summary.min, original.summary.min, 1e-3);
        EXPECT_EQ(assess_quality(flip_orientation(clockwise)).orientation, Orientation::positive);
    }
}

/// A quadrilateral with a reflex corner counts by its area, not by the sign of J at the first corner.
TEST(Orientation, ConcaveQuadrilateralIsNotClockwise) {
    Eigen::MatrixX3d x(4, 3);
    x << 0.2, 0.2, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0;  // J < 0 at node 0
    const QualityReport report = assess_quality(testing::single_element({Shape::quadrilateral, 1}, x));
    EXPECT_EQ(report.orientation, Orientation::positive);
    EXPECT_EQ(report.summary.invalid, 1);
}

TEST(Orientation, MeshTurnedInsideOutIsInvalidForTheOriginalsSign) {
    const CurvedMesh mesh = square_mesh(2, 2);
    Coordinates mirrored = mesh.coordinates();
    mirrored.col(0) *= -1;
    QualityOptions options;
    options.orientation_sign = assess_quality(mesh).orientation_sign;
    EXPECT_EQ(assess_quality(mesh.with_coordinates(mirrored)).summary.valid, 8);
    EXPECT_EQ(assess_quality(mesh.with_coordinates(mirrored), options).summary.invalid, 8);
}

TEST(Orientation, OneReversedElementIsValid) {
    MeshData data = square_mesh(2, 1).topology().data();
    for (ElementBlock& block : data.blocks)
        if (block.type.shape == Shape::triangle) std::swap(block.nodes[0], block.nodes[1]);
    const CurvedMesh mesh(std::make_shared<const MeshTopology>(data), square_mesh(2, 1).coordinates());
    const QualityReport report = assess_quality(mesh);
    EXPECT_EQ(report.orientation, Orientation::positive);
    EXPECT_EQ(report.summary.reversed, 1);
    EXPECT_EQ(report.summary.valid, 8);
}

TEST(AssessQuality, RefusesWhatItCannotJudge) {
    const QualityReport pyramids = assess_quality(testing::pyramid_mesh(1));
    EXPECT_EQ(pyramids.summary.not_assessed, 6);
    EXPECT_EQ(pyramids.summary.assessed(), 0);
    for (const ElementQuality& quality : pyramids.elements) {
        EXPECT_EQ(quality.validity, Validity::not_assessed);
        EXPECT_TRUE(std::isnan(quality.scaled_jacobian));
    }
    Coordinates bent = square_mesh(2, 1).coordinates();
    bent(0, 2) = 0.5;
    EXPECT_THROW(assess_quality(square_mesh(2, 1).with_coordinates(bent)), Unsupported);
    EXPECT_THROW(assess_quality(square_mesh(2, 1), {0.0, 10, {}}), InvalidInput);
}

TEST(AssessQuality, StopsWhenAsked) {
    std::stop_source source;
    TaskContext context{source.get_token(), {}};
    source.request_stop();
    EXPECT_THROW(assess_quality(square_mesh(4, 2), {}, context), Cancelled);
}

TEST(Histogram, EveryElementIsInOneBin) {
    std::mt19937 random(13);
    const QualityReport report = assess_quality(shaken(square_mesh(6, 2), 0.05, random));
    const Histogram histogram = make_histogram(report, 0.0, 1.0, 20);
    Index total = 0;
    for (Index count : histogram.counts) total += count;
    EXPECT_EQ(total, report.summary.elements());
    EXPECT_EQ(histogram.bin_of(-5.0), 0);
    EXPECT_EQ(histogram.bin_of(0.0), 0);
    EXPECT_EQ(histogram.bin_of(0.05), 1);
    EXPECT_EQ(histogram.bin_of(1.0), 19);
    EXPECT_EQ(histogram.bin_of(std::numeric_limits<double>::quiet_NaN()), 0);
}

}  // namespace
}  // namespace curvewright
