#include "core/mesh/coincident_nodes.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/mesh/elevate.h"
#include "tests/support/mesh_factory.h"
#include "tests/unit/mesh/torn_meshes.h"

namespace curvewright {
namespace {

std::vector<CurvedMesh> meshes_of_order(int order) {
    return {testing::square_mesh(3, order),    testing::quad_mesh(3, order), testing::mixed_square_mesh(4, order),
            testing::cube_mesh(2, order),      testing::hex_mesh(2, order),  testing::prism_mesh(2, order),
            testing::mixed_cube_mesh(2, order)};
}

void expect_same_elements(const CurvedMesh& a, const CurvedMesh& b, double tolerance) {
    ASSERT_EQ(a.topology().element_count(), b.topology().element_count());
    for (Index element = 0; element < a.topology().element_count(); ++element) {
        EXPECT_EQ(a.topology().element_tag(element), b.topology().element_tag(element));
        EXPECT_LE((a.element_coordinates(element) - b.element_coordinates(element)).cwiseAbs().maxCoeff(), tolerance);
    }
}

TEST(CoincidentNodes, CellsWithPointsOfTheirOwnBecomeTheMeshAgain) {
    for (int order = 1; order <= 4; ++order)
        for (const CurvedMesh& mesh : meshes_of_order(order)) {
            const CurvedMesh torn = testing::with_own_points(mesh);
            EXPECT_TRUE(has_separate_elements(torn.topology()));
            EXPECT_FALSE(has_separate_elements(mesh.topology()));
            for (const CoincidenceOptions& options : {CoincidenceOptions{0.0}, cautious_coincidence}) {
                const CoincidentNodes found = find_coincident_nodes(torn, options);
                EXPECT_EQ(found.surplus(), torn.topology().node_count() - mesh.topology().node_count());
                const MergedMesh merged = merge_nodes(torn, found);
                const MeshTopology& topology = merged.mesh.topology();
                EXPECT_EQ(topology.node_count(), mesh.topology().node_count());
                EXPECT_EQ(topology.boundary_nodes().size(), mesh.topology().boundary_nodes().size());
                EXPECT_EQ(topology.boundary_facets().size(), mesh.topology().boundary_facets().size());
                for (const PhysicalGroup& group : mesh.topology().groups())
                    EXPECT_EQ(topology.find_group_nodes(group.name)->size(),
                              mesh.topology().find_group_nodes(group.name)->size());
                expect_same_elements(merged.mesh, mesh, 0.0);
            }
        }
}

TEST(CoincidentNodes, SinglePrecisionIsNearEnough) {
    std::mt19937 random(7);
    for (const CurvedMesh& mesh : meshes_of_order(3)) {
        CurvedMesh torn = testing::with_own_points(mesh);
        Coordinates x = torn.coordinates();
        std::uniform_real_distribution<double> noise(-1e-7, 1e-7);
        for (Eigen::Index i = 0; i < x.size(); ++i) x.data()[i] = static_cast<float>(x.data()[i] + noise(random));
        torn = torn.with_coordinates(x);
        EXPECT_LT(find_coincident_nodes(torn, {0.0}).surplus(), torn.topology().node_count() / 2);
        const MergedMesh merged = merge_nodes(torn, find_coincident_nodes(torn, cautious_coincidence));
        EXPECT_EQ(merged.mesh.topology().node_count(), mesh.topology().node_count());
        expect_same_elements(merged.mesh, mesh, 5e-7);
    }
}

TEST(CoincidentNodes, LayersThinnerThanTheToleranceStay) {
    for (const CurvedMesh& mesh : {testing::quad_mesh(4, 2), testing::hex_mesh(2, 2)}) {
        // One direction shrinks to 1e-7 of the size.
        Coordinates x = mesh.coordinates();
        x.col(1) *= 1e-7;
        const CurvedMesh torn = testing::with_own_points(mesh.with_coordinates(x));
        const CoincidentNodes cautious = find_coincident_nodes(torn, cautious_coincidence);
        EXPECT_EQ(merge_nodes(torn, cautious).mesh.topology().node_count(), mesh.topology().node_count());
        EXPECT_EQ(without_collapsing(torn.topology(), cautious).groups, cautious.groups);
        // Without the share of the spacing the layers collapse, and that is refused.
        EXPECT_THROW(merge_nodes(torn, find_coincident_nodes(torn, {1e-6})), InvalidInput);
    }
}

TEST(CoincidentNodes, ASlitIsFoundAndClosedOnlyWhenAsked) {
    const auto on_half = [](const Eigen::RowVector3d& p) { return std::abs(p[0] - 0.5) < 1e-12 && p[1] < 0.6; };
    const auto behind = [](const Eigen::RowVector3d& p) { return p[0] > 0.5; };
    for (const CurvedMesh& mesh : {testing::square_mesh(4, 3), testing::cube_mesh(2, 2)}) {
        const CurvedMesh slit = testing::with_slit(mesh, on_half, behind);
        EXPECT_FALSE(has_separate_elements(slit.topology()));
        const CoincidentNodes found = find_coincident_nodes(slit);
        EXPECT_EQ(found.surplus(), slit.topology().node_count() - mesh.topology().node_count());
        for (const std::vector<Index>& group : found.groups) {
            ASSERT_EQ(group.size(), 2u);
            EXPECT_EQ(slit.coordinates().row(group[0]), slit.coordinates().row(group[1]));
        }
        const MergedMesh closed = merge_nodes(slit, found);
        EXPECT_EQ(closed.mesh.topology().boundary_nodes().size(), mesh.topology().boundary_nodes().size());
        EXPECT_EQ(closed.mesh.coordinates(), mesh.coordinates());
        for (Index node = 0; node < mesh.topology().node_count(); ++node)
            EXPECT_EQ(closed.mesh.topology().node_tag(node), mesh.topology().node_tag(node));
    }
}

TEST(CoincidentNodes, EqualsComparingAllPairs) {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> place(0.0, 1.0);
    for (const double tolerance : {1e-3, 0.02, 0.1}) {
        std::vector<std::array<double, 3>> points = {{0, 0, 0}, {1, 1, 1}};
        std::vector<testing::Cell> cells = {{{Shape::line, 1}, {0, 1}}};
        for (int i = 0; i < 600; ++i) {
            points.push_back({place(random), place(random), place(random)});
            // Near an earlier one.
            if (i % 3 == 0)
                points.back() = {points[i / 2][0] + tolerance * place(random), points[i / 2][1], points[i / 2][2]};
            cells.push_back({{Shape::vertex, 1}, {static_cast<Index>(points.size()) - 1}});
        }
        const CurvedMesh mesh = testing::mesh_of_cells(points, cells);
        const double distance = tolerance * (bounding_box(mesh).row(1) - bounding_box(mesh).row(0)).norm();
        std::vector<Index> expected(points.size());
        for (std::size_t i = 0; i < points.size(); ++i) expected[i] = static_cast<Index>(i);
        for (bool changes = true; changes;) {
            changes = false;
            for (std::size_t i = 0; i < points.size(); ++i)
                for (std::size_t k = 0; k < i; ++k)
                    if ((mesh.coordinates().row(i) - mesh.coordinates().row(k)).norm() <= distance &&
                        expected[i] != expected[k]) {
                        expected[i] = expected[k] = std::min(expected[i], expected[k]);
                        changes = true;
                    }
        }
        std::vector<Index> found(points.size());
        for (std::size_t i = 0; i < points.size(); ++i) found[i] = static_cast<Index>(i);
        for (const std::vector<Index>& group : find_coincident_nodes(mesh, {tolerance}).groups)
            for (const Index node : group) found[node] = group.front();
        EXPECT_EQ(found, expected) << tolerance;
    }
}

TEST(CoincidentNodes, RefusesToCollapseACell) {
    const CurvedMesh mesh = testing::with_own_points(testing::square_mesh(2, 1));
    const CoincidentNodes found = find_coincident_nodes(mesh, {0.6});
    try {
        merge_nodes(mesh, found);
        FAIL();
    } catch (const InvalidInput& error) {
        EXPECT_NE(std::string(error.what()).find("of element"), std::string::npos) << error.what();
    }
    EXPECT_TRUE(without_collapsing(mesh.topology(), found).groups.empty());
    EXPECT_THROW(find_coincident_nodes(mesh, {-1e-3}), InvalidInput);
    EXPECT_THROW(find_coincident_nodes(mesh, {std::nan("")}), InvalidInput);
}

TEST(CoincidentNodes, ArraysFollow) {
    const CurvedMesh mesh = testing::cube_mesh(2, 2), torn = testing::with_own_points(mesh);
    FieldArray same, different, cells;
    same.name = "same";
    same.components = 2;
    different.name = "different";
    cells.name = "cells";
    cells.place = FieldArray::Place::elements;
    cells.values.assign(static_cast<std::size_t>(torn.topology().element_count()), 3.0);
    for (Index node = 0; node < torn.topology().node_count(); ++node) {
        const auto p = torn.coordinates().row(node);
        same.values.insert(same.values.end(), {p[0] + 2 * p[1], p[2]});
        different.values.push_back(node);
    }
    const MergedMesh merged = merge_nodes(torn, find_coincident_nodes(torn));
    std::vector<std::string> notes;
    const std::vector<FieldArray> fields = merged_fields({same, different, cells}, merged, notes);
    ASSERT_EQ(notes.size(), 1u);
    EXPECT_NE(notes[0].find("Array different has other values"), std::string::npos);
    ASSERT_EQ(fields[0].size(), static_cast<std::size_t>(merged.mesh.topology().node_count()));
    for (Index node = 0; node < merged.mesh.topology().node_count(); ++node) {
        const auto p = merged.mesh.coordinates().row(node);
        EXPECT_EQ(fields[0].values[2 * node], p[0] + 2 * p[1]);
        EXPECT_EQ(fields[0].values[2 * node + 1], p[2]);
        // Of the first node there.
        EXPECT_EQ(fields[1].values[node] + 1, merged.mesh.topology().node_tag(node).value);
    }
    EXPECT_EQ(fields[2].values, cells.values);
}

}  // namespace
}  // namespace curvewright
