#include "core/edit/selection.h"

#include <gtest/gtest.h>

#include "tests/support/mesh_factory.h"

namespace curvewright {
namespace {

using namespace curvewright::testing;

TEST(Selection, SetOperations) {
    EXPECT_EQ(united({1, 3, 5}, {2, 3}), (IndexSet{1, 2, 3, 5}));
    EXPECT_EQ(without({1, 3, 5}, {2, 3}), (IndexSet{1, 5}));
    EXPECT_EQ(toggled({1, 3, 5}, {2, 3}), (IndexSet{1, 2, 5}));
}

TEST(Selection, NodesAndElementsOfEachOther) {
    const CurvedMesh mesh = square_mesh(4, 3);
    const MeshTopology& topology = mesh.topology();
    for (Index element = 0; element < topology.element_count(); ++element) {
        const IndexSet nodes = nodes_of_elements(topology, {element});
        EXPECT_EQ(nodes.size(), 10u);
        EXPECT_EQ(elements_with_all_corners(topology, nodes), IndexSet{element});
        const IndexSet around = elements_with_any(topology, nodes);
        EXPECT_GT(around.size(), 3u);
        EXPECT_TRUE(std::binary_search(around.begin(), around.end(), element));
    }
}

TEST(Selection, GrowingElementsTakesThoseThatShareANode) {
    const CurvedMesh mesh = square_mesh(6, 2);
    const MeshTopology& topology = mesh.topology();
    const NodeElements node_elements = elements_of_nodes(topology);
    for (Index seed : {Index{0}, Index{20}, topology.element_count() - 1}) {
        const IndexSet grown = grown_elements(topology, node_elements, {seed});
        for (Index element = 0; element < topology.element_count(); ++element) {
            const IndexSet a = nodes_of_elements(topology, {element}), b = nodes_of_elements(topology, {seed});
            const bool touches = without(a, b).size() < a.size();
            EXPECT_EQ(std::binary_search(grown.begin(), grown.end(), element), touches) << element;
        }
        const IndexSet twice = grown_elements(topology, node_elements, grown);
        EXPECT_EQ(without(grown, shrunk_elements(topology, node_elements, twice)), IndexSet{});
        EXPECT_EQ(shrunk_elements(topology, node_elements, {seed}), IndexSet{});
    }
}

TEST(Selection, InvertingTwiceIsTheSame) {
    const CurvedMesh mesh = cube_mesh(2, 2);
    const MeshTopology& topology = mesh.topology();
    const IndexSet some{0, 5, 7};
    EXPECT_EQ(inverted_elements(topology, inverted_elements(topology, some)), some);
    const IndexSet side = topology.find_group_nodes("x0").value();
    const IndexSet others = inverted_nodes(topology, side);
    EXPECT_EQ(united(side, others), topology.boundary_nodes());
    EXPECT_EQ(inverted_nodes(topology, others), side);
    const IndexSet interior{topology.interior_nodes().front()};
    EXPECT_EQ(inverted_nodes(topology, interior).size() + 1,
              topology.boundary_nodes().size() + topology.interior_nodes().size());
}

TEST(Selection, BoundaryNodesGrowAndShrinkAlongTheBoundary) {
    const CurvedMesh mesh = square_mesh(5, 3);
    const MeshTopology& topology = mesh.topology();
    const NodeElements node_elements = elements_of_nodes(topology);
    const IndexSet side = topology.find_group_nodes("top").value();
    const IndexSet grown = grown_nodes(topology, node_elements, side);
    EXPECT_EQ(grown.size(), side.size() + 6);  // one P3 side more at both ends
    for (Index node : grown) EXPECT_TRUE(topology.is_boundary_node(node));
    EXPECT_EQ(shrunk_nodes(topology, grown), side);
    // An inner node takes what its elements have, boundary or not.
    const IndexSet inner{topology.interior_nodes().front()};
    IndexSet expected = inner;
    for (Index element : node_elements.of(inner.front()))
        expected = united(expected, nodes_of_elements(topology, {element}));
    EXPECT_EQ(grown_nodes(topology, node_elements, inner), expected);
}

TEST(Selection, QualityRangeHoldsItsEnds) {
    QualityReport report;
    for (double value : {-0.5, 0.0, 0.2, 0.9, 1.0}) {
        report.elements.emplace_back();
        report.elements.back().scaled_jacobian = value;
    }
    EXPECT_EQ(elements_in_range(report, 0.0, 0.9), (IndexSet{1, 2, 3}));
    EXPECT_EQ(elements_in_range(report, 0.3, 0.8), IndexSet{});
    EXPECT_EQ(elements_in_range(report, -1.0, 1.0).size(), 5u);
}

}  // namespace
}  // namespace curvewright
