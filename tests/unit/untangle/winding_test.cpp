// A mesh is worked on as if its reversed elements were renumbered: not a bit of the result depends on the numbering.

#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "core/mesh/renumbering.h"
#include "core/quality/element_size.h"
#include "core/quality/quality.h"
#include "core/untangle/guaranteed.h"
#include "core/untangle/improve.h"
#include "core/untangle/signed_angles.h"
#include "core/untangle/unsigned_angles.h"
#include "core/warp/warp.h"
#include "tests/support/mesh_factory.h"

namespace curvewright {
namespace {

using namespace testing;

CurvedMesh turned(const CurvedMesh& mesh) {
    return renumbered(mesh, [](Index element) { return element % 4 == 1; });
}

TEST(ReversedElements, AreJudgedAsIfTheyWereRenumbered) {
    std::mt19937 random(3);
    for (const CurvedMesh& plain :
         {square_mesh(3, 3), quad_mesh(3, 2), cube_mesh(2, 2), hex_mesh(2, 2), prism_mesh(2, 2)}) {
        const CurvedMesh mesh = shaken(plain, 0.05, random);
        const QualityReport expected = assess_quality(mesh), found = assess_quality(turned(mesh));
        ASSERT_GT(found.summary.reversed, 0);
        EXPECT_EQ(expected.summary.reversed, 0);
        EXPECT_EQ(found.orientation, Orientation::positive);
        for (std::size_t i = 0; i < expected.elements.size(); ++i) {
            EXPECT_NEAR(found.elements[i].scaled_jacobian, expected.elements[i].scaled_jacobian, 1e-3);
            EXPECT_EQ(found.elements[i].validity, expected.elements[i].validity);
            EXPECT_EQ(found.elements[i].is_reversed, i % 4 == 1);
        }
        // Renumbered for good, nothing is left to tell.
        const Reorientation reoriented = reorient(turned(mesh));
        EXPECT_EQ(reoriented.renumbered, found.summary.reversed);
        EXPECT_EQ(assess_quality(reoriented.mesh).summary.reversed, 0);
        EXPECT_EQ(reoriented.mesh.coordinates(), mesh.coordinates());
        EXPECT_EQ(reoriented.mesh.topology().data().node_tags, mesh.topology().data().node_tags);
    }
}

TEST(ReversedElements, DoNotChangeABitOfAnUntangling) {
    std::mt19937 random(5);
    for (const CurvedMesh& plain : {square_mesh(4, 2), square_mesh(4, 3)}) {
        const CurvedMesh mesh = shaken(plain, 0.14, random), other = turned(mesh);
        ASSERT_GT(assess_quality(mesh).summary.invalid, 0);
        EXPECT_EQ(untangle_guaranteed(other).coordinates, untangle_guaranteed(mesh).coordinates);
        EXPECT_EQ(untangle_signed_angles(other).coordinates, untangle_signed_angles(mesh).coordinates);
        EXPECT_EQ(untangle_unsigned_angles(other).coordinates, untangle_unsigned_angles(mesh).coordinates);
    }
    for (const CurvedMesh& plain : {cube_mesh(2, 2), hex_mesh(2, 2), prism_mesh(2, 2)}) {
        const CurvedMesh mesh = shaken(plain, 0.14, random);
        EXPECT_EQ(untangle_guaranteed(turned(mesh)).coordinates, untangle_guaranteed(mesh).coordinates);
    }
}

TEST(ReversedElements, DoNotChangeABitOfAWarpNorOfImproving) {
    std::mt19937 random(7);
    for (const CurvedMesh& plain : {square_mesh(4, 3), cube_mesh(2, 2)}) {
        const CurvedMesh mesh = shaken(plain, 0.004, random), other = turned(mesh);
        ASSERT_EQ(assess_quality(mesh).summary.invalid, 0);
        EXPECT_EQ(improve(other).coordinates, improve(mesh).coordinates);
        Coordinates target = mesh.coordinates();
        for (const Index node : mesh.topology().boundary_nodes())
            target(node, 1) += 0.1 * target(node, 0) * target(node, 0);
        for (const Weighting weighting : {Weighting::convex, Weighting::affine, Weighting::elastic}) {
            WarpOptions options;
            options.weighting = weighting;
            EXPECT_EQ(warp(other, target, options).coordinates, warp(mesh, target, options).coordinates);
        }
    }
}

TEST(ReversedElements, AreNotFolded) {
    // Half of a rectangle numbered against the other half, as two CAD faces are: perfect, and left alone.
    const CurvedMesh mesh = renumbered(square_mesh(4, 2), [](Index element) { return element >= 16; });
    ASSERT_EQ(mesh.topology().reversed_count(), 16);
    const GuaranteedResult result = untangle_guaranteed(mesh);
    EXPECT_EQ(result.coordinates, mesh.coordinates());
    EXPECT_TRUE(result.unmended.empty());
}

TEST(ReversedElements, PartsOfEitherOrientationAreJudgedByTheirOwn) {
    // The square beside its mirror image.
    const CurvedMesh one = square_mesh(2, 2);
    MeshData data = one.topology().data();
    const auto count = static_cast<Index>(data.node_tags.size());
    for (Index node = 0; node < count; ++node) data.node_tags.push_back({10000 + node});
    const std::size_t blocks = data.blocks.size();
    for (std::size_t b = 0; b < blocks; ++b) {
        ElementBlock block = data.blocks[b];
        for (Index& node : block.nodes) node += count;
        for (ElementTag& tag : block.tags) tag.value += 10000;
        data.blocks.push_back(std::move(block));
    }
    data.node_entities.clear();
    Coordinates x(2 * count, 3);
    x << one.coordinates(), one.coordinates();
    x.bottomRows(count).col(0) *= -1.0;
    x.bottomRows(count).col(0).array() -= 1.0;
    const CurvedMesh both(std::make_shared<const MeshTopology>(std::move(data)), std::move(x));
    const QualityReport report = assess_quality(both);
    EXPECT_EQ(report.orientation, Orientation::mixed);
    EXPECT_EQ(report.summary.valid, 16);
    EXPECT_EQ(report.summary.reversed, 0);
    EXPECT_EQ(reorient(both).renumbered, 8);
    EXPECT_EQ(assess_quality(reorient(both).mesh).orientation, Orientation::positive);
}

}  // namespace
}  // namespace curvewright
