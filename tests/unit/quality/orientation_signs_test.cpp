#include "core/quality/orientation_signs.h"

#include <gtest/gtest.h>

#include "core/mesh/renumbering.h"
#include "core/quality/quality.h"
#include "tests/support/mesh_factory.h"
#include "tests/unit/mesh/torn_meshes.h"

namespace curvewright {
namespace {

using namespace testing;

const ElementType triangle{Shape::triangle, 1}, tetrahedron{Shape::tetrahedron, 1};

TEST(OrientationSigns, AWholeMeshNumberedTheOtherWayRoundIsNegative) {
    for (const CurvedMesh& mesh : {square_mesh(2, 3), quad_mesh(2, 2), mixed_square_mesh(2, 2), cube_mesh(1, 2),
                                   hex_mesh(2, 1), prism_mesh(2, 2), mixed_cube_mesh(2, 1), pyramid_mesh(1)}) {
        EXPECT_EQ(orientation_signs(mesh), OrientationSigns(1.0));
        EXPECT_EQ(orientation_signs(flip_orientation(mesh)), OrientationSigns(-1.0));
        // Mirrored in space, it is as if numbered the other way round.
        Coordinates x = mesh.coordinates();
        x.col(0) *= -1.0;
        EXPECT_EQ(orientation_signs(mesh.with_coordinates(x)), OrientationSigns(-1.0));
        EXPECT_EQ(find_orientation(mesh.with_coordinates(x)), Orientation::negative);
    }
}

TEST(OrientationSigns, AReversedElementHasTheOtherSignThanItsPart) {
    for (const CurvedMesh& plain : {square_mesh(3, 2), cube_mesh(2, 1), hex_mesh(2, 2), prism_mesh(2, 1)}) {
        const CurvedMesh mesh = renumbered(plain, [](Index element) { return element % 5 == 2; });
        const OrientationSigns signs = orientation_signs(mesh), flipped = orientation_signs(flip_orientation(mesh));
        EXPECT_FALSE(signs.is_mixed());
        for (Index element = 0; element < mesh.topology().element_count(); ++element) {
            EXPECT_EQ(signs.of_part(element), 1.0);
            EXPECT_EQ(signs.of_element(mesh.topology(), element), element % 5 == 2 ? -1.0 : 1.0);
            EXPECT_EQ(flipped.of_part(element), -1.0);
        }
    }
}

TEST(OrientationSigns, AnElementAloneTakesItsOwnOrThatOfWhatItTouches) {
    // Two triangles that share an edge, anticlockwise, and a clockwise one: apart from them, then at node 1.
    for (const bool touches : {false, true}) {
        const CurvedMesh mesh =
            mesh_of_cells({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}, {2, 0, 0}, {2, .5, 0}, {1.5, 0, 0}},
                          {{triangle, {0, 1, 2}}, {triangle, {1, 3, 2}}, {triangle, {touches ? 1 : 6, 5, 4}}});
        const QualityReport report = assess_quality(mesh);
        EXPECT_EQ(report.orientation, touches ? Orientation::positive : Orientation::mixed);
        EXPECT_EQ(report.orientation_sign.of_part(2), touches ? 1.0 : -1.0);
        EXPECT_EQ(report.summary.invalid, touches ? 1 : 0);
        EXPECT_EQ(report.elements[2].validity, touches ? Validity::invalid : Validity::valid);
        EXPECT_EQ(report.summary.reversed, 0);
    }
    // The same of tetrahedra, the third one inside out.
    for (const bool touches : {false, true}) {
        const CurvedMesh mesh = mesh_of_cells(
            {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1}, {3, 0, 0}, {3, 1, 0}, {3, 0, 1}, {2, 0, 0}},
            {{tetrahedron, {0, 1, 2, 3}}, {tetrahedron, {1, 4, 2, 3}}, {tetrahedron, {touches ? 1 : 8, 7, 6, 5}}});
        const QualityReport report = assess_quality(mesh);
        EXPECT_EQ(report.summary.valid, touches ? 2 : 3);
        EXPECT_EQ(report.summary.invalid, touches ? 1 : 0);
        EXPECT_EQ(report.orientation, touches ? Orientation::positive : Orientation::mixed);
    }
}

TEST(OrientationSigns, WhatIsMadeOfAMeshIsJudgedByTheSignsOfTheMesh) {
    // Turned inside out, nothing is valid any more, whatever its own signs would say.
    for (const CurvedMesh& mesh : {square_mesh(2, 2), hex_mesh(1, 2)}) {
        Coordinates x = mesh.coordinates();
        x.col(1) *= -1.0;
        QualityOptions options;
        EXPECT_EQ(assess_quality(mesh.with_coordinates(x), options).summary.invalid, 0);
        options.orientation_sign = orientation_signs(mesh);
        EXPECT_EQ(assess_quality(mesh.with_coordinates(x), options).summary.valid, 0);
    }
}

}  // namespace
}  // namespace curvewright
