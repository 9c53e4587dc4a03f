#include "core/basis/node_ordering.h"

#include <algorithm>
#include <fstream>
#include <set>
#include <sstream>

#include <gtest/gtest.h>
#include <vtkHigherOrderHexahedron.h>
#include <vtkHigherOrderQuadrilateral.h>
#include <vtkHigherOrderTetra.h>
#include <vtkHigherOrderTriangle.h>
#include <vtkHigherOrderWedge.h>

#include "tests/unit/basis/element_types.h"

namespace curvewright {
namespace {

/// All lattice points of the element, in no particular order, from the definition of the lattice.
std::set<LatticePoint> lattice_of(ElementType type) {
    const int p = type.order;
    std::set<LatticePoint> points;
    for (int k = 0; k <= p; ++k)
        for (int j = 0; j <= p; ++j)
            for (int i = 0; i <= p; ++i) {
                bool is_inside = true;
                switch (type.shape) {
                    case Shape::vertex:
                        is_inside = i + j + k == 0;
                        break;
                    case Shape::line:
                        is_inside = j + k == 0;
                        break;
                    case Shape::triangle:
                        is_inside = k == 0 && i + j <= p;
                        break;
                    case Shape::quadrilateral:
                        is_inside = k == 0;
                        break;
                    case Shape::tetrahedron:
                        is_inside = i + j + k <= p;
                        break;
                    case Shape::hexahedron:
                        break;
                    case Shape::prism:
                        is_inside = i + j <= p;
                        break;
                    case Shape::pyramid:
                        is_inside = i <= p - k && j <= p - k;
                        break;
                }
                if (is_inside) points.insert({i, j, k});
            }
    return points;
}

/// Where VTK itself puts a lattice point.
int position_in_vtk(ElementType type, LatticePoint point) {
    const int p = type.order;
    const auto [i, j, k] = point;
    switch (type.shape) {
        case Shape::line:
            return i == 0 ? 0 : i == p ? 1 : i + 1;
        case Shape::triangle: {
            const vtkIdType b[3] = {i, j, p - i - j};
            return static_cast<int>(vtkHigherOrderTriangle::Index(b, p));
        }
        case Shape::tetrahedron: {
            const vtkIdType b[4] = {i, j, k, p - i - j - k};
            return static_cast<int>(vtkHigherOrderTetra::Index(b, p));
        }
        case Shape::quadrilateral: {
            const int order[2] = {p, p};
            return vtkHigherOrderQuadrilateral::PointIndexFromIJK(i, j, order);
        }
        case Shape::hexahedron: {
            const int order[3] = {p, p, p};
            return vtkHigherOrderHexahedron::PointIndexFromIJK(i, j, k, order);
        }
        case Shape::prism: {
            const int order[4] = {p, p, p, p};
            return vtkHigherOrderWedge::PointIndexFromIJK(i, j, k, order);
        }
        default:
            return 0;
    }
}

TEST(NodeOrdering, every_lattice_point_occurs_once) {
    for (const ElementType type : all_types()) {
        const auto expected = lattice_of(type);
        for (const auto& nodes : {vtk_node_order(type), gmsh_node_order(type)}) {
            EXPECT_EQ(nodes.size(), expected.size()) << name(type);
            EXPECT_EQ(std::set<LatticePoint>(nodes.begin(), nodes.end()), expected) << name(type);
            EXPECT_EQ(static_cast<int>(nodes.size()), node_count(type)) << name(type);
        }
    }
}

TEST(NodeOrdering, is_that_of_vtk) {
    for (const ElementType type : all_types()) {
        if (type.shape == Shape::pyramid) continue;  // VTK 9.1 has no Lagrange pyramid
        const auto nodes = vtk_node_order(type);
        int wrong = 0;
        for (std::size_t i = 0; i < nodes.size(); ++i) wrong += position_in_vtk(type, nodes[i]) != static_cast<int>(i);
        EXPECT_EQ(wrong, 0) << name(type);
    }
}

TEST(NodeOrdering, of_gmsh_is_what_gmsh_says) {
    std::ifstream file(CURVEWRIGHT_TEST_DATA "/basis/gmsh_node_order.txt");
    ASSERT_TRUE(file);
    const auto digit = [](char c) { return c <= '9' ? c - '0' : c - 'a' + 10; };
    int types = 0;
    for (std::string line; std::getline(file, line); ++types) {
        std::istringstream words(line);
        std::string shape_name, word;
        ElementType type;
        words >> shape_name >> type.order;
        for (const Shape shape : all_shapes)
            if (name(shape) == shape_name) type.shape = shape;
        std::vector<LatticePoint> expected;
        while (words >> word) expected.push_back({digit(word[0]), digit(word[1]), digit(word[2])});
        EXPECT_EQ(gmsh_node_order(type), expected) << name(type);
    }
    EXPECT_EQ(types, 3 * 10 + 10 + 3 * 9);
}

TEST(NodeOrdering, permutation_leads_from_gmsh_to_ours) {
    for (const ElementType type : all_types()) {
        const auto ours = vtk_node_order(type), gmsh = gmsh_node_order(type);
        const auto& permutation = gmsh_permutation(type);
        ASSERT_EQ(permutation.size(), ours.size());
        for (std::size_t i = 0; i < ours.size(); ++i) EXPECT_EQ(ours[i], gmsh[permutation[i]]) << name(type);
    }
    const std::vector<int> p3_tetrahedron = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 11, 10, 15, 14, 13, 12, 17, 19, 18, 16};
    EXPECT_EQ(gmsh_permutation({Shape::tetrahedron, 3}), p3_tetrahedron);
}

}  // namespace
}  // namespace curvewright
