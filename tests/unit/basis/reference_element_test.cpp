#include "core/basis/reference_element.h"

#include <algorithm>
#include <set>

#include <gtest/gtest.h>
#include <Eigen/Dense>

#include "tests/unit/basis/element_types.h"

namespace curvewright {
namespace {

Eigen::Vector3d as_vector(LatticePoint point) {
    return Eigen::Vector3i(point.data()).cast<double>();
}

/// Number of edges, faces and facets by shape.
struct Counts {
    Shape shape;
    std::size_t edges, faces, facets;
};

TEST(ReferenceElement, has_all_edges_faces_and_facets) {
    for (const Counts& expected :
         {Counts{Shape::line, 1, 0, 2}, Counts{Shape::triangle, 3, 1, 3}, Counts{Shape::quadrilateral, 4, 1, 4},
          Counts{Shape::tetrahedron, 6, 4, 4}, Counts{Shape::hexahedron, 12, 6, 6}, Counts{Shape::prism, 9, 5, 5},
          Counts{Shape::pyramid, 8, 5, 5}})
        for (int order = 1; order <= max_order; ++order) {
            const auto& element = reference_element({expected.shape, order});
            EXPECT_EQ(element.edges.size(), expected.edges) << name(element.type);
            EXPECT_EQ(element.faces.size(), expected.faces) << name(element.type);
            EXPECT_EQ(element.facets.size(), expected.facets) << name(element.type);
        }
}

TEST(ReferenceElement, sub_elements_are_affine_images_of_their_own_lattice) {
    for (const ElementType type : all_types()) {
        const auto& element = reference_element(type);
        for (const auto* subs : {&element.edges, &element.faces, &element.facets})
            for (const SubElement& sub : *subs) {
                const auto lattice = vtk_node_order(sub.type);
                ASSERT_EQ(sub.nodes.size(), lattice.size());
                if (sub.type.shape == Shape::vertex) continue;
                const auto corner = [&](int i) { return as_vector(element.lattice[sub.nodes[i]]); };
                const int last = corner_count(sub.type.shape) - 1;
                for (std::size_t i = 0; i < lattice.size(); ++i) {
                    const Eigen::Vector3d image = corner(0) + (corner(1) - corner(0)) * lattice[i][0] / type.order +
                                                  (corner(last) - corner(0)) * lattice[i][1] / type.order;
                    EXPECT_LT((image - as_vector(element.lattice[sub.nodes[i]])).norm(), 1e-12) << name(type);
                }
            }
    }
}

TEST(ReferenceElement, facets_hold_exactly_the_nodes_of_their_plane_and_look_outward) {
    for (const ElementType type : all_types()) {
        const auto& element = reference_element(type);
        if (element.dimension < 2) continue;
        Eigen::Vector3d center = Eigen::Vector3d::Zero();
        for (int i = 0; i < corner_count(type.shape); ++i) center += as_vector(element.lattice[i]);
        center /= corner_count(type.shape);
        for (const SubElement& facet : element.facets) {
            const Eigen::Vector3d a = as_vector(element.lattice[facet.nodes[0]]);
            const Eigen::Vector3d u = as_vector(element.lattice[facet.nodes[1]]) - a;
            const int last = corner_count(facet.type.shape) - 1;
            const Eigen::Vector3d v = element.dimension == 3
                                          ? Eigen::Vector3d(as_vector(element.lattice[facet.nodes[last]]) - a)
                                          : Eigen::Vector3d(0, 0, 1);
            const Eigen::Vector3d normal = u.cross(v);  // in 2D: to the right of the edge, which is outward
            EXPECT_LT(normal.dot(center - a), 0.0) << name(type);
            std::set<int> on_plane;
            for (int node = 0; node < element.node_count(); ++node)
                if (std::abs(normal.dot(as_vector(element.lattice[node]) - a)) < 1e-9) on_plane.insert(node);
            EXPECT_EQ(std::set<int>(facet.nodes.begin(), facet.nodes.end()), on_plane) << name(type);
        }
    }
}

TEST(ReferenceElement, every_node_is_interior_or_on_a_facet) {
    for (const ElementType type : all_types()) {
        const auto& element = reference_element(type);
        std::vector<bool> seen(element.lattice.size(), false);
        for (const auto& facet : element.facets)
            for (int node : facet.nodes) seen[node] = true;
        for (int node : element.interior_nodes) {
            EXPECT_FALSE(seen[node]) << name(type);
            seen[node] = true;
        }
        EXPECT_EQ(std::count(seen.begin(), seen.end(), false), 0) << name(type);
    }
}

TEST(ReferenceElement, finds_nodes_by_lattice_point) {
    const auto& element = reference_element({Shape::tetrahedron, 4});
    for (int node = 0; node < element.node_count(); ++node) EXPECT_EQ(element.find_node(element.lattice[node]), node);
    EXPECT_EQ(element.find_node({4, 1, 0}), -1);
}

}  // namespace
}  // namespace curvewright
