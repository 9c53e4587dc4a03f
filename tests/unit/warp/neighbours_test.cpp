#include "core/warp/neighbours.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <set>

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/mesh/curved_mesh.h"
#include "core/mesh/node_elements.h"
#include "core/warp/weights.h"
#include "tests/support/mesh_factory.h"

namespace curvewright {
namespace {

std::set<Index> set_of(const NeighbourSets& sets, std::size_t i) {
    const auto nodes = sets.of(i);
    std::set<Index> result(nodes.begin(), nodes.end());
    EXPECT_EQ(result.size(), nodes.size());  // no node twice
    return result;
}

std::vector<CurvedMesh> meshes_of_order(int order) {
    return {testing::square_mesh(3, order), testing::quad_mesh(3, order), testing::cube_mesh(2, order),
            testing::hex_mesh(2, order), testing::prism_mesh(2, order)};
}

TEST(Neighbours, AreTheOtherNodesOfTheElementsOfANode) {
    const CurvedMesh mesh = testing::square_mesh(3, 2);
    const MeshTopology& topology = mesh.topology();
    const NeighbourSets sets = find_neighbours(topology, topology.interior_nodes());
    for (std::size_t i = 0; i < topology.interior_nodes().size(); ++i) {
        std::vector<Index> expected;
        for (Index element = 0; element < topology.element_count(); ++element) {
            const auto nodes = topology.element_nodes(element);
            if (std::find(nodes.begin(), nodes.end(), topology.interior_nodes()[i]) == nodes.end()) continue;
            for (Index node : nodes)
                if (node != topology.interior_nodes()[i]) expected.push_back(node);
        }
        std::sort(expected.begin(), expected.end());
        expected.erase(std::unique(expected.begin(), expected.end()), expected.end());
        std::vector<Index> actual(sets.of(i).begin(), sets.of(i).end());
        std::sort(actual.begin(), actual.end());
        EXPECT_EQ(actual, expected);
    }
}

TEST(Neighbours, HighOrderOnesAreThoseThatAreNoVertices) {
    for (const int order : {2, 3})
        for (const CurvedMesh& mesh : meshes_of_order(order)) {
            const MeshTopology& topology = mesh.topology();
            std::set<Index> vertices;
            for (Index element = 0; element < topology.element_count(); ++element) {
                const auto nodes = topology.element_nodes(element);
                vertices.insert(nodes.begin(), nodes.begin() + corner_count(topology.element_type(element).shape));
            }
            const NeighbourSets all = find_neighbours(topology, topology.interior_nodes());
            const NeighbourSets sets = find_neighbours(topology, topology.interior_nodes(), NeighbourKind::high_order);
            for (std::size_t i = 0; i < sets.centers.size(); ++i) {
                std::set<Index> expected;
                for (const Index node : all.of(i))
                    if (!vertices.contains(node)) expected.insert(node);
                EXPECT_EQ(set_of(sets, i), expected);
            }
        }
}

TEST(Neighbours, EdgeConnectedOnesAreOneLatticeStepAway) {
    // On these meshes a step of the lattice is an edge of an element over the order.
    for (const int order : {1, 2, 3, 4})
        for (const CurvedMesh& mesh : meshes_of_order(order)) {
            const MeshTopology& topology = mesh.topology();
            if (topology.dimension() == 3 && order == 4) continue;
            const NeighbourSets sets =
                find_neighbours(topology, topology.interior_nodes(), NeighbourKind::edge_connected);
            const NodeElements elements = elements_of_nodes(topology);
            for (std::size_t i = 0; i < sets.centers.size(); ++i) {
                const Index center = sets.centers[i];
                std::set<Index> expected;
                for (const Index element : elements.of(center)) {
                    const auto nodes = topology.element_nodes(element);
                    const Shape shape = topology.element_type(element).shape;
                    const auto position = [&](std::size_t local) { return mesh.coordinates().row(nodes[local]); };
                    for (const Index node : nodes)
                        for (std::size_t a = 0; a < static_cast<std::size_t>(corner_count(shape)); ++a)
                            for (std::size_t b = 0; b < static_cast<std::size_t>(corner_count(shape)); ++b) {
                                const Eigen::RowVector3d edge = position(b) - position(a);
                                // Diagonals of faces and cells are no edges of the tensor-product shapes.
                                const bool is_diagonal = (edge.array().abs() > 1e-9).count() > 1;
                                if (a == b ||
                                    (is_diagonal && (shape == Shape::quadrilateral || shape == Shape::hexahedron)))
                                    continue;
                                if (shape == Shape::prism && std::abs(edge[2]) > 1e-9 && is_diagonal) continue;
                                const Eigen::RowVector3d step =
                                    mesh.coordinates().row(node) - mesh.coordinates().row(center);
                                if ((step - edge / order).norm() < 1e-9) expected.insert(node);
                            }
                }
                EXPECT_EQ(set_of(sets, i), expected) << name(topology.element_type(0)) << " node " << center;
            }
        }
}

TEST(Neighbours, OfOneNodeCounted) {
    // The middle of 2 × 2 P2 squares of two triangles each: six triangles or eight, by the diagonals.
    const CurvedMesh mesh = testing::square_mesh(2, 2);
    Index center = -1;
    for (Index node = 0; node < mesh.topology().node_count(); ++node)
        if ((mesh.coordinates().row(node) - Eigen::RowVector3d(0.5, 0.5, 0.0)).norm() < 1e-12) center = node;
    ASSERT_GE(center, 0);
    const auto count = [&](NeighbourKind kind) {
        return find_neighbours(mesh.topology(), {center}, kind).nodes.size();
    };
    EXPECT_EQ(count(NeighbourKind::all), 24u);  // all other nodes: every triangle contains the middle
    EXPECT_EQ(count(NeighbourKind::high_order), 16u);
    EXPECT_EQ(count(NeighbourKind::edge_connected), 8u);
}

TEST(Neighbours, ShareAsManyElementsAsContainBoth) {
    for (const CurvedMesh& mesh : meshes_of_order(3)) {
        const NodeElements elements = elements_of_nodes(mesh.topology());
        const NeighbourSets sets = find_neighbours(mesh.topology(), mesh.topology().interior_nodes());
        for (std::size_t i = 0; i < sets.centers.size(); ++i)
            for (std::size_t j = 0; j < sets.of(i).size(); ++j) {
                const auto a = elements.of(sets.centers[i]), b = elements.of(sets.of(i)[j]);
                std::vector<Index> both;
                std::set_intersection(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(both));
                EXPECT_EQ(sets.shared_elements_of(i)[j], both.size());
            }
    }
}

TEST(Neighbours, ConvexWeightsExistForTheSmallerSetsToo) {
    for (const NeighbourKind kind : {NeighbourKind::high_order, NeighbourKind::edge_connected})
        for (const int order : {2, 3, 4})
            for (const CurvedMesh& mesh : meshes_of_order(order)) {
                const bool is_simplicial = is_simplex(mesh.topology().element_type(0).shape);
                if (kind == NeighbourKind::high_order && !is_simplicial && order == 2) continue;
                const NeighbourSets sets = find_neighbours(mesh.topology(), mesh.topology().interior_nodes(), kind);
                const WeightTable table = compute_weights(mesh, sets, convex_weighting(2.0));
                for (std::size_t i = 0; i < sets.centers.size(); ++i) {
                    // Where the diagonals of square_mesh change their direction, two triangles at an edge make a larger
                    // triangle, and the middles of their sides all lie on one side of the edge's.
                    const auto x = mesh.coordinates().row(sets.centers[i]);
                    const bool is_fold = std::abs(x[0] - 1.0 / 3) < 1e-9 || std::abs(x[1] - 1.0 / 3) < 1e-9;
                    if (kind == NeighbourKind::high_order && mesh.topology().dimension() == 2 && is_fold) continue;
                    EXPECT_EQ(table.status[i], PatchStatus::regular)
                        << to_string(kind) << " " << name(mesh.topology().element_type(0)) << " " << sets.centers[i];
                    for (std::size_t k = sets.offsets[i]; k < sets.offsets[i + 1]; ++k)
                        EXPECT_GT(table.weights[k], 0.0);
                }
            }
}

TEST(Neighbours, HighOrderIsRefusedForOrderOneOnly) {
    const CurvedMesh mesh = testing::square_mesh(3, 1);
    EXPECT_THROW(find_neighbours(mesh.topology(), mesh.topology().interior_nodes(), NeighbourKind::high_order),
                 Unsupported);
    EXPECT_NO_THROW(find_neighbours(mesh.topology(), mesh.topology().interior_nodes(), NeighbourKind::edge_connected));
}

TEST(Neighbours, SetsStandInTheOrderOfTheCentresForEveryThreadCount) {
    const CurvedMesh mesh = testing::square_mesh(24, 2);
    std::vector<Index> centers = mesh.topology().interior_nodes();
    std::reverse(centers.begin(), centers.end());
    std::vector<NeighbourSets> results;
    for (const int threads : {1, 2, 4}) {
        set_thread_count(threads);
        results.push_back(find_neighbours(mesh.topology(), centers));
    }
    set_thread_count(0);
    EXPECT_EQ(results[0].centers, centers);
    for (const std::size_t other : {1, 2}) {
        EXPECT_EQ(results[0].nodes, results[other].nodes);
        EXPECT_EQ(results[0].offsets, results[other].offsets);
    }
    for (std::size_t i = 0; i < centers.size(); i += 97) {
        const NeighbourSets alone = find_neighbours(mesh.topology(), {centers[i]});
        EXPECT_EQ(set_of(results[0], i), set_of(alone, 0));
    }
}

}  // namespace
}  // namespace curvewright
