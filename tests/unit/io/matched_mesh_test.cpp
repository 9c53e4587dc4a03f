#include "core/io/matched_mesh.h"

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "tests/support/mesh_factory.h"
#include "tests/unit/mesh/torn_meshes.h"

namespace curvewright {
namespace {

using namespace testing;

ReadResult as_read(CurvedMesh mesh) {
    return {std::move(mesh), MeshFormat::vtu, {}, {}};
}

bool has_note(const ReadResult& read, const std::string& fragment) {
    for (const std::string& note : read.notes)
        if (note.find(fragment) != std::string::npos) return true;
    return false;
}

TEST(MatchedMesh, AConnectedMeshIsLeftAlone) {
    for (const CurvedMesh& mesh : {square_mesh(3, 3), cube_mesh(2, 2), hex_mesh(2, 2), mixed_cube_mesh(2, 2)}) {
        ReadResult read = as_read(mesh);
        match_nodes(read);
        EXPECT_TRUE(read.notes.empty());
        EXPECT_EQ(read.mesh.shared_topology(), mesh.shared_topology());
        match_nodes(read, 1e-9);
        EXPECT_TRUE(has_note(read, "No nodes lie within 1e-09"));
        EXPECT_EQ(read.mesh.shared_topology(), mesh.shared_topology());
    }
}

TEST(MatchedMesh, SeparateElementsAreConnectedAndArraysFollow) {
    for (const CurvedMesh& mesh : {square_mesh(3, 3), cube_mesh(2, 2), prism_mesh(1, 2)}) {
        ReadResult read = as_read(with_own_points(mesh));
        FieldArray field;
        field.name = "height";
        for (Index node = 0; node < read.mesh.topology().node_count(); ++node)
            field.values.push_back(read.mesh.coordinates()(node, 1));
        read.fields = {field};
        match_nodes(read);
        ASSERT_EQ(read.mesh.topology().node_count(), mesh.topology().node_count());
        ASSERT_EQ(read.notes.size(), 1u) << read.notes.back();
        EXPECT_TRUE(has_note(read, "Every element has nodes of its own"));
        for (Index node = 0; node < mesh.topology().node_count(); ++node)
            EXPECT_EQ(read.fields[0].values[node], read.mesh.coordinates()(node, 1));
    }
}

TEST(MatchedMesh, ACollapsedElementKeepsItsNodes) {
    // A quadrilateral with two corners at one place, beside another one; each has its own points.
    ReadResult read =
        as_read(mesh_of_cells({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {1, 1, 0}, {1, 0, 0}, {2, 0, 0}, {2, 1, 0}, {1, 1, 0}},
                              {{{Shape::quadrilateral, 1}, {0, 1, 2, 3}}, {{Shape::quadrilateral, 1}, {4, 5, 6, 7}}}));
    match_nodes(read);
    EXPECT_EQ(read.mesh.topology().node_count(), 7);
    EXPECT_TRUE(has_note(read, "1 node at the places of others (within 1e-06 of the mesh's size) was merged"))
        << read.notes.front();
    EXPECT_TRUE(has_note(read, "because an element has several nodes there"));
    EXPECT_THROW(match_nodes(read, 1e-9), InvalidInput);
}

TEST(MatchedMesh, ASlitIsToldAndMergedWhenAsked) {
    const auto is_on_slit = [](const Eigen::RowVector3d& x) { return x[0] == 0.5 && x[1] < 0.6; };
    const auto is_behind = [](const Eigen::RowVector3d& center) { return center[0] > 0.5; };
    for (const CurvedMesh& mesh : {square_mesh(4, 2), cube_mesh(2, 2)}) {
        const CurvedMesh slit = with_slit(mesh, is_on_slit, is_behind);
        const Index doubled = slit.topology().node_count() - mesh.topology().node_count();
        ReadResult read = as_read(slit);
        match_nodes(read);
        EXPECT_EQ(read.mesh.shared_topology(), slit.shared_topology());
        EXPECT_TRUE(has_note(read, std::to_string(doubled) + " nodes lie at the places of others"));
        match_nodes(read, 1e-12);
        EXPECT_EQ(read.mesh.topology().node_count(), mesh.topology().node_count());
        EXPECT_TRUE(has_note(read, std::to_string(doubled) + " nodes within 1e-12"));
    }
}

TEST(MatchedMesh, HangingNodesAndTouchingBodiesAreTold) {
    ReadResult hanging = as_read(hanging_cubes());
    match_nodes(hanging);
    ASSERT_EQ(hanging.notes.size(), 1u);
    EXPECT_TRUE(has_note(hanging, "commands that move nodes refuse it"));
    // With points of their own they are connected first; then the nodes hang.
    ReadResult torn = as_read(with_own_points(hanging_cubes()));
    match_nodes(torn);
    EXPECT_EQ(torn.notes.size(), 2u);
    EXPECT_TRUE(has_note(torn, "hangs on"));
    ReadResult bodies = as_read(
        mesh_of_cells({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {1, -.5, 0}, {2, 0, 0}, {2, .5, 0}, {1, .5, 0}},
                      {{{Shape::quadrilateral, 1}, {0, 1, 2, 3}}, {{Shape::quadrilateral, 1}, {4, 5, 6, 7}}}));
    match_nodes(bodies);
    ASSERT_EQ(bodies.notes.size(), 1u);
    EXPECT_TRUE(has_note(bodies, "Bodies touch without having a node in common")) << bodies.notes[0];
}

}  // namespace
}  // namespace curvewright
