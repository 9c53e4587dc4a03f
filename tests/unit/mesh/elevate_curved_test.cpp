#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/basis/lagrange.h"
#include "core/mesh/elevate.h"
#include "tests/support/mesh_factory.h"
#include "tests/unit/mesh/torn_meshes.h"

namespace curvewright {
namespace {

using testing::mesh_of_cells;

std::vector<CurvedMesh> curved_meshes(int order) {
    std::mt19937 random(11);
    std::vector<CurvedMesh> meshes;
    for (const CurvedMesh& straight :
         {testing::square_mesh(2, order), testing::quad_mesh(2, order), testing::mixed_square_mesh(2, order),
          testing::cube_mesh(1, order), testing::hex_mesh(2, order), testing::prism_mesh(1, order),
          testing::mixed_cube_mesh(2, order)}) {
        // Every node on its own, those of the boundary too: nothing smooth about it.
        Coordinates x = straight.coordinates();
        std::uniform_real_distribution<double> away(-0.05, 0.05);
        for (Eigen::Index i = 0; i < x.size(); ++i)
            if (i % 3 < straight.topology().dimension()) x.data()[i] += away(random);
        meshes.push_back(straight.with_coordinates(x));
    }
    return meshes;
}

/// Largest distance between the images of random reference points.
double distance(const CurvedMesh& a, const CurvedMesh& b) {
    std::mt19937 random(5);
    std::uniform_real_distribution<double> place(0.0, 1.0);
    double largest = 0.0;
    for (Index element = 0; element < a.topology().element_count(); ++element) {
        const ElementType from = a.topology().element_type(element), to = b.topology().element_type(element);
        Eigen::MatrixX3d points(20, 3);
        for (Eigen::Index i = 0; i < 20; ++i) points.row(i) << place(random), place(random), place(random);
        points.rightCols(3 - dimension(from.shape)).setZero();
        // Into the simplex, or the prism's.
        if (is_simplex(from.shape) || from.shape == Shape::prism) points.leftCols(3) /= 3.0;
        largest = std::max(largest, (lagrange_basis(from, points).values * a.element_coordinates(element) -
                                     lagrange_basis(to, points).values * b.element_coordinates(element))
                                        .rowwise()
                                        .norm()
                                        .maxCoeff());
    }
    return largest;
}

TEST(ElevateCurved, ARaisedOrderKeepsTheGeometry) {
    for (int order = 2; order <= 4; ++order)
        for (const CurvedMesh& mesh : curved_meshes(order))
            for (int raised = order; raised <= order + 3; ++raised) {
                const ElevateResult result = elevate(mesh, ElevateOptions{raised});
                EXPECT_FALSE(result.distance);
                EXPECT_LT(distance(mesh, result.mesh), 2e-13) << order << " to " << raised;
                // The same nodes are shared as in a straight mesh of that order.
                EXPECT_EQ(result.mesh.topology().node_count(),
                          elevate(elevate(mesh, 1), raised).topology().node_count());
                EXPECT_EQ(result.mesh.topology().boundary_facets().size(), mesh.topology().boundary_facets().size());
                // And it comes down again as it was.
                const CurvedMesh back = elevate(result.mesh, order);
                EXPECT_LT(distance(mesh, back), 1e-12);
            }
}

TEST(ElevateCurved, TheSameOrderChangesNothing) {
    for (const CurvedMesh& mesh : curved_meshes(3)) {
        const CurvedMesh same = elevate(mesh, 3);
        EXPECT_EQ(same.coordinates(), mesh.coordinates());
        EXPECT_EQ(same.topology().data().node_tags, mesh.topology().data().node_tags);
        for (std::size_t b = 0; b < mesh.topology().blocks().size(); ++b)
            EXPECT_EQ(same.topology().blocks()[b].nodes, mesh.topology().blocks()[b].nodes);
    }
}

TEST(ElevateCurved, NodesOfBothLatticesStayToTheBit) {
    for (const CurvedMesh& mesh : curved_meshes(2)) {
        const ElevateResult result = elevate(mesh, ElevateOptions{4});
        const MeshTopology& topology = result.mesh.topology();
        for (Index node = 0; node < mesh.topology().node_count(); ++node) {
            const auto found = topology.find_node(mesh.topology().node_tag(node));
            ASSERT_TRUE(found);
            EXPECT_EQ(result.mesh.coordinates().row(*found), mesh.coordinates().row(node));
        }
        const CurvedMesh back = elevate(result.mesh, 2);
        EXPECT_EQ(back.coordinates(), mesh.coordinates());
        EXPECT_EQ(back.topology().data().node_tags, mesh.topology().data().node_tags);
    }
}

TEST(ElevateCurved, ALoweredOrderTellsTheDistance) {
    // One edge of a P2 triangle bulges by h: the chord misses it by h, nowhere more.
    Eigen::MatrixX3d x = reference_nodes({Shape::triangle, 2});
    const double h = 0.125;
    x(3, 1) -= h;
    const CurvedMesh mesh = testing::single_element({Shape::triangle, 2}, x);
    const ElevateResult lowered = elevate(mesh, ElevateOptions{1});
    ASSERT_TRUE(lowered.distance);
    EXPECT_NEAR(lowered.distance->absolute, h, 1e-14);
    const auto box = bounding_box(mesh);
    EXPECT_NEAR(lowered.distance->relative, h / (box.row(1) - box.row(0)).norm(), 1e-14);
    // A straight-sided mesh of the same order is as far.
    const ElevateResult straight = elevate(mesh, ElevateOptions{2, ElevatedGeometry::straight});
    ASSERT_TRUE(straight.distance);
    EXPECT_NEAR(straight.distance->absolute, h, 1e-14);
    for (const CurvedMesh& curved : curved_meshes(4)) {
        const ElevateResult result = elevate(curved, ElevateOptions{3});
        ASSERT_TRUE(result.distance);
        const double sampled = distance(curved, result.mesh);
        EXPECT_GT(sampled, 0.0);
        EXPECT_LT(sampled, 1.1 * result.distance->absolute);
        EXPECT_GT(sampled, 0.2 * result.distance->absolute);
    }
}

TEST(ElevateCurved, StraightIsWhatTheCornersGive) {
    for (const CurvedMesh& mesh : curved_meshes(3)) {
        const CurvedMesh straight = elevate(mesh, ElevateOptions{4, ElevatedGeometry::straight}).mesh;
        EXPECT_EQ(straight.coordinates(), elevate(elevate(mesh, 1), 4).coordinates());
    }
}

TEST(ElevateCurved, ArraysAreInterpolated) {
    for (const CurvedMesh& mesh : curved_meshes(3)) {
        const auto value = [](const Eigen::RowVector3d& p) { return 1.0 + 2.0 * p[0] - p[1] + 3.0 * p[2]; };
        FieldArray numbers, labels, places;
        numbers.components = 2;
        labels.is_integer = true;
        places.place = FieldArray::Place::elements;
        places.values.assign(static_cast<std::size_t>(mesh.topology().element_count()), 4.0);
        for (Index node = 0; node < mesh.topology().node_count(); ++node) {
            const Eigen::RowVector3d p = mesh.coordinates().row(node);
            numbers.values.insert(numbers.values.end(), {value(p), -p[0]});
            labels.values.push_back(100.0 + node);
        }
        for (const int order : {2, 5}) {
            const ElevateResult result = elevate(mesh, ElevateOptions{order});
            const auto fields = carried_over({numbers, labels, places}, result.sources);
            const Index count = result.mesh.topology().node_count();
            ASSERT_EQ(fields[0].size(), static_cast<std::size_t>(count));
            for (Index node = 0; node < count; ++node) {
                // Linear in the positions, which are interpolated by the same functions.
                const Eigen::RowVector3d p = result.mesh.coordinates().row(node);
                EXPECT_NEAR(fields[0].values[2 * node], value(p), 1e-12);
                EXPECT_NEAR(fields[0].values[2 * node + 1], -p[0], 1e-12);
                // A label is some old node's, and its own where the node stayed.
                const auto old = static_cast<Index>(std::lround(fields[1].values[node] - 100.0));
                ASSERT_GE(old, 0);
                ASSERT_LT(old, mesh.topology().node_count());
                EXPECT_EQ(fields[1].values[node], 100.0 + old);
                const NodeTag tag = result.mesh.topology().node_tag(node);
                if (mesh.topology().find_node(tag)) {
                    EXPECT_EQ(mesh.topology().node_tag(old), tag);
                }
            }
            EXPECT_EQ(fields[2].values, places.values);
        }
    }
}

TEST(ElevateCurved, TheSidesOfASlitStayTwo) {
    // Two P2 triangles with both corners of an edge in common and a node of their own on it: a lens lies between.
    const CurvedMesh mesh =
        mesh_of_cells({{0, 0, 0},
                       {1, 0, 0},
                       {.5, 1, 0},
                       {.5, -1, 0},
                       {.5, .1, 0},
                       {.75, .5, 0},
                       {.25, .5, 0},
                       {.5, -.1, 0},
                       {.25, -.5, 0},
                       {.75, -.5, 0}},
                      {{{Shape::triangle, 2}, {0, 1, 2, 4, 5, 6}}, {{Shape::triangle, 2}, {1, 0, 3, 7, 8, 9}}});
    const CurvedMesh raised = elevate(mesh, 3);
    EXPECT_EQ(raised.topology().node_count(), 2 * 10 - 2);
    EXPECT_LT(distance(mesh, raised), 1e-14);
    EXPECT_EQ(raised.topology().boundary_facets().size(), 6u);
}

TEST(ElevateCurved, NeighboursOfTwoOrdersBecomeOneMesh) {
    const auto points = [](double bulge) {
        return std::vector<std::array<double, 3>>{{0, 0, 0},    {1, 0, 0},          {1, 1, 0},  {0, 1, 0},
                                                  {.5, -.2, 0}, {1 + bulge, .5, 0}, {.5, 1, 0}, {0, .5, 0},
                                                  {.5, .5, 0},  {2, 0, 0},          {2, 1, 0}};
    };
    const std::vector<testing::Cell> cells = {{{Shape::quadrilateral, 2}, {0, 1, 2, 3, 4, 5, 6, 7, 8}},
                                              {{Shape::quadrilateral, 1}, {1, 9, 10, 2}}};
    const CurvedMesh mesh = mesh_of_cells(points(0.0), cells);
    for (const int order : {2, 3, 4}) {
        const CurvedMesh raised = elevate(mesh, order);
        EXPECT_EQ(raised.topology().node_count(), (2 * order + 1) * (order + 1));
        EXPECT_EQ(raised.topology().boundary_facets().size(), 6u);
        EXPECT_LT(distance(mesh, raised), 1e-14);
    }
    // They disagree: nothing can keep both.
    const CurvedMesh open = mesh_of_cells(points(0.1), cells);
    EXPECT_THROW(elevate(open, 2), Unsupported);
    EXPECT_EQ(elevate(open, ElevateOptions{2, ElevatedGeometry::straight}).mesh.topology().node_count(), 15);
}

}  // namespace
}  // namespace curvewright
