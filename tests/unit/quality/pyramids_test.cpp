// Pyramids among other elements: told as not assessed, and no reason to refuse the others.

#include <cmath>

#include <gtest/gtest.h>

#include "core/mesh/conformity.h"
#include "core/quality/element_size.h"
#include "core/quality/quality.h"
#include "core/quality/shape_quality.h"
#include "core/untangle/guaranteed.h"
#include "core/warp/warp.h"
#include "tests/support/mesh_factory.h"
#include "tests/support/pyramid_layer.h"

namespace curvewright {
namespace {

using namespace testing;

bool is_pyramid(const CurvedMesh& mesh, Index element) {
    return mesh.topology().element_type(element).shape == Shape::pyramid;
}

/// The layer with a node moved.
CurvedMesh layer_with(Index node, const Eigen::RowVector3d& place) {
    const CurvedMesh mesh = pyramid_layer_mesh();
    Coordinates x = mesh.coordinates();
    x.row(node) = place;
    return mesh.with_coordinates(x);
}

TEST(Pyramids, TheMeshOfTheseTestsConformsAndFillsItsHull) {
    const CurvedMesh mesh = pyramid_layer_mesh();
    EXPECT_TRUE(find_nonconformity(mesh).conforms());
    EXPECT_EQ(mesh.topology().interior_nodes(), (std::vector<Index>{node_of_hexahedra, node_of_pyramids}));
    EXPECT_EQ(mesh.topology().reversed_count(), 0);
    EXPECT_EQ(mesh.topology().winding().part_count, 1);
}

TEST(Pyramids, AreCountedAsNotAssessedAndLeftOutOfTheFigures) {
    // One tetrahedron is worse than the others' 1, hexahedra around the moved node too: figures that can be wrong.
    const CurvedMesh mesh = layer_with(node_of_hexahedra, {1.2, 0.9, 1.1});
    const QualityReport report = assess_quality(mesh);
    EXPECT_EQ(report.summary.not_assessed, 5);
    EXPECT_EQ(report.summary.valid, 12);
    EXPECT_EQ(report.summary.assessed(), 12);
    EXPECT_EQ(report.summary.elements(), 17);
    double least = 2.0, sum = 0.0;
    for (Index element = 0; element < 17; ++element) {
        const ElementQuality& quality = report.elements[element];
        EXPECT_EQ(std::isnan(quality.scaled_jacobian), is_pyramid(mesh, element));
        EXPECT_EQ(quality.validity == Validity::not_assessed, is_pyramid(mesh, element));
        if (is_pyramid(mesh, element)) continue;
        least = std::min(least, quality.scaled_jacobian);
        sum += quality.scaled_jacobian;
    }
    EXPECT_LT(least, 0.95);
    EXPECT_EQ(report.summary.min, least);
    EXPECT_NEAR(report.summary.mean, sum / 12.0, 1e-14);
    EXPECT_EQ(report.summary.max, 1.0);

    const std::vector<Index> worst = report.worst(17);
    ASSERT_EQ(worst.size(), 17u);
    EXPECT_EQ(report.elements[worst[0]].scaled_jacobian, least);
    for (std::size_t i = 0; i < 17; ++i) EXPECT_EQ(is_pyramid(mesh, worst[i]), i >= 12) << i;
    Index counted = 0;
    for (const Index count : make_histogram(report, 0.0, 1.0, 10).counts) counted += count;
    EXPECT_EQ(counted, 12);
}

TEST(Pyramids, HaveNoShapeAndNoSize) {
    const CurvedMesh mesh = layer_with(node_of_hexahedra, {1.2, 0.9, 1.1});
    const Coordinates ideal = pyramid_layer_mesh().coordinates();
    const std::vector<double> shapes = element_shapes(mesh, ideal), sizes = element_sizes(mesh);
    const ShapeSummary summary = assess_shape(mesh, ideal);
    double least = 2.0, sum = 0.0, volume = 0.0;
    for (Index element = 0; element < 17; ++element) {
        EXPECT_EQ(std::isnan(shapes[element]), is_pyramid(mesh, element));
        EXPECT_EQ(std::isnan(sizes[element]), is_pyramid(mesh, element));
        if (is_pyramid(mesh, element)) continue;
        least = std::min(least, shapes[element]);
        sum += shapes[element];
        volume += sizes[element];
    }
    EXPECT_LT(least, 0.99);
    EXPECT_EQ(summary.min, least);
    EXPECT_NEAR(summary.mean, sum / 12.0, 1e-14);
    // Eight unit cubes, and tetrahedra of a sixth on edges of 1 with apices 1 apart.
    EXPECT_NEAR(volume, 8.0 + 4.0 / 6.0, 1e-12);
}

TEST(Pyramids, StayWhereTheyAreWhileTheOthersAreUntangled) {
    const CurvedMesh mesh = layer_with(node_of_hexahedra, {2.3, 1.9, 1.2});
    const QualityReport before = assess_quality(mesh);
    ASSERT_GT(before.summary.invalid, 0);
    EXPECT_EQ(before.summary.not_assessed, 5);
    const GuaranteedResult result = untangle_guaranteed(mesh);
    EXPECT_EQ(assess_quality(mesh.with_coordinates(result.coordinates)).summary.valid, 12);
    EXPECT_TRUE(result.unmended.empty());
    EXPECT_NE(result.coordinates.row(node_of_hexahedra), mesh.coordinates().row(node_of_hexahedra));
    for (Index node = 0; node < mesh.topology().node_count(); ++node)
        if (node != node_of_hexahedra) {
            EXPECT_EQ(result.coordinates.row(node), mesh.coordinates().row(node)) << node;
        }
}

TEST(Pyramids, FollowInAWarp) {
    const CurvedMesh mesh = pyramid_layer_mesh();
    // What an affine motion does to the boundary it does to the nodes inside.
    Coordinates target = mesh.coordinates();
    target.col(0) += 0.2 * mesh.coordinates().col(2);
    target.col(2) *= 1.5;
    Coordinates boundary = mesh.coordinates();
    for (const Index node : mesh.topology().boundary_nodes()) boundary.row(node) = target.row(node);
    for (const Weighting weighting : {Weighting::convex, Weighting::affine}) {
        WarpOptions options;
        options.weighting = weighting;
        const Coordinates moved = warp(mesh, boundary, options).coordinates;
        EXPECT_LT((moved - target).cwiseAbs().maxCoeff(), 1e-9);
    }
}

}  // namespace
}  // namespace curvewright
