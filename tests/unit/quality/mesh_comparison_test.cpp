#include "core/quality/mesh_comparison.h"

#include <cmath>

#include <gtest/gtest.h>

#include "core/mesh/elevate.h"
#include "tests/support/mesh_factory.h"

namespace curvewright {
namespace {

using namespace testing;

std::vector<CurvedMesh> meshes() {
    std::vector<CurvedMesh> result;
    for (int order = 1; order <= 4; ++order)
        for (const CurvedMesh& mesh : {square_mesh(3, order), quad_mesh(3, order), cube_mesh(2, std::min(order, 3)),
                                       hex_mesh(2, std::min(order, 3)), prism_mesh(2, std::min(order, 3))})
            result.push_back(mesh);
    return result;
}

TEST(MeshComparison, AMeshEqualsItself) {
    for (const CurvedMesh& mesh : meshes()) {
        const MeshComparison found = compare_meshes(mesh, mesh);
        EXPECT_TRUE(found.is_structure_equal());
        EXPECT_EQ(found.all.nodes, mesh.topology().node_count());
        EXPECT_EQ(found.all.moved, 0);
        EXPECT_FALSE(found.all.farthest);
        EXPECT_TRUE(found.elements_moved.empty());
        EXPECT_FALSE(found.most_worsened);
        ASSERT_TRUE(found.quality_after);
        EXPECT_EQ(found.quality_after->valid, mesh.topology().element_count());
    }
}

TEST(MeshComparison, TellsHowFarNodesMoved) {
    for (const CurvedMesh& mesh : meshes()) {
        // Everything with x > 0.5 moves by 0.01 (x - 0.5) along y.
        Coordinates x = mesh.coordinates();
        double sum = 0.0, squares = 0.0;
        Index moved = 0;
        for (Eigen::Index node = 0; node < x.rows(); ++node) {
            const double far = 0.01 * std::max(0.0, x(node, 0) - 0.5), before = x(node, 1);
            x(node, 1) += far;
            moved += x(node, 1) != before ? 1 : 0;
            sum += far;
            squares += far * far;
        }
        const MeshComparison found = compare_meshes(mesh, mesh.with_coordinates(x));
        EXPECT_TRUE(found.is_structure_equal());
        EXPECT_EQ(found.all.moved, moved);
        EXPECT_NEAR(found.all.max, 0.005, 1e-15);
        EXPECT_NEAR(found.all.mean, sum / static_cast<double>(x.rows()), 1e-15);
        EXPECT_NEAR(found.all.rms, std::sqrt(squares / static_cast<double>(x.rows())), 1e-15);
        EXPECT_NEAR(found.size, std::sqrt(static_cast<double>(mesh.topology().dimension())), 1e-14);
        EXPECT_NEAR(found.relative_motion(), 0.005 / found.size, 1e-15);
        ASSERT_TRUE(found.all.farthest);
        EXPECT_EQ(mesh.coordinates()(*mesh.topology().find_node(*found.all.farthest), 0), 1.0);
        EXPECT_EQ(found.all.nodes, found.boundary.nodes + found.interior.nodes);
        EXPECT_EQ(found.all.moved, found.boundary.moved + found.interior.moved);
        for (const GroupMotion& group : found.groups)
            if (group.name == "left" || group.name == "x0") {
                EXPECT_EQ(group.motion.moved, 0) << group.name;
            } else if (group.name == "right" || group.name == "x1") {
                EXPECT_EQ(group.motion.moved, group.motion.nodes) << group.name;
            }
        // Elements are those with a corner or node on the right.
        std::vector<ElementTag> expected;
        for (Index element = 0; element < mesh.topology().element_count(); ++element)
            if (mesh.element_coordinates(element).col(0).maxCoeff() > 0.5 + 1e-12)
                expected.push_back(mesh.topology().element_tag(element));
        EXPECT_EQ(found.elements_moved, expected);
    }
}

TEST(MeshComparison, TellsWhatBecameInvalid) {
    for (const CurvedMesh& mesh : {square_mesh(3, 2), cube_mesh(2, 2)}) {
        // An interior node goes where it tangles its elements.
        Coordinates x = mesh.coordinates();
        const Index node = mesh.topology().interior_nodes().front();
        x(node, 0) += 0.6;
        const CurvedMesh tangled = mesh.with_coordinates(x);
        const QualityReport report = assess_quality(tangled);
        std::vector<ElementTag> expected;
        for (Index element = 0; element < mesh.topology().element_count(); ++element)
            if (report.elements[element].validity == Validity::invalid)
                expected.push_back(mesh.topology().element_tag(element));
        ASSERT_FALSE(expected.empty());
        const MeshComparison found = compare_meshes(mesh, tangled), back = compare_meshes(tangled, mesh);
        EXPECT_EQ(found.became_invalid, expected);
        EXPECT_TRUE(found.became_valid.empty());
        EXPECT_EQ(back.became_valid, expected);
        ASSERT_TRUE(found.most_worsened);
        EXPECT_LE(found.most_worsened->after, 0.0);
        EXPECT_EQ(found.all.moved, 1);
    }
}

TEST(MeshComparison, TellsWhatWasAddedAndRemoved) {
    for (const CurvedMesh& mesh : {square_mesh(2, 2), cube_mesh(1, 2)}) {
        MeshData data = mesh.topology().data();
        // The last element goes, and one group; another is turned round; a node is added.
        ElementBlock& block = data.blocks.back();
        ASSERT_EQ(dimension(block.type.shape), mesh.topology().dimension());
        const ElementTag gone = block.tags.back(), turned = block.tags.front();
        block.tags.pop_back();
        block.nodes.resize(block.nodes.size() - static_cast<std::size_t>(node_count(block.type)));
        std::swap(block.nodes[0], block.nodes[1]);
        const std::string group = MeshTopology::display_name(data.groups.front());
        data.groups.erase(data.groups.begin());
        data.node_tags.push_back({100000});
        Coordinates x(mesh.coordinates().rows() + 1, 3);
        x << mesh.coordinates(), Eigen::RowVector3d(0.5, 0.5, 0.0);
        if (!data.node_entities.empty()) data.node_entities.emplace_back();
        const CurvedMesh other(std::make_shared<const MeshTopology>(std::move(data)), x);

        const MeshComparison found = compare_meshes(mesh, other);
        EXPECT_FALSE(found.is_structure_equal());
        EXPECT_EQ(found.elements_removed, std::vector{gone});
        EXPECT_EQ(found.elements_reconnected, std::vector{turned});
        EXPECT_TRUE(found.elements_added.empty());
        EXPECT_EQ(found.nodes_added, std::vector{NodeTag{100000}});
        EXPECT_EQ(found.groups_removed, std::vector{group});
        EXPECT_EQ(found.lower_cells_added + found.lower_cells_removed, 0);
        const MeshComparison back = compare_meshes(other, mesh);
        EXPECT_EQ(back.elements_added, std::vector{gone});
        EXPECT_EQ(back.groups_added, std::vector{group});
        EXPECT_EQ(back.nodes_removed, std::vector{NodeTag{100000}});
    }
}

TEST(MeshComparison, AnotherOrderIsAnotherMeshOnTheSameCorners) {
    const CurvedMesh low = square_mesh(2, 1), high = elevate(low, 3);
    const MeshComparison found = compare_meshes(low, high);
    EXPECT_EQ(found.all.nodes, low.topology().node_count());
    EXPECT_EQ(found.all.moved, 0);
    EXPECT_EQ(static_cast<Index>(found.elements_reconnected.size()), low.topology().element_count());
    EXPECT_EQ(static_cast<Index>(found.nodes_added.size()), high.topology().node_count() - low.topology().node_count());
    EXPECT_EQ(found.lower_cells_added, 8);
    EXPECT_EQ(found.lower_cells_removed, 8);
}

}  // namespace
}  // namespace curvewright
