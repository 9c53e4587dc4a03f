#include <gtest/gtest.h>

#include "core/basis/element_type.h"
#include "tests/unit/basis/element_types.h"

namespace curvewright {
namespace {

TEST(ElementType, counts_nodes_of_full_lagrange_elements) {
    EXPECT_EQ(node_count({Shape::vertex, 1}), 1);
    EXPECT_EQ(node_count({Shape::line, 7}), 8);
    EXPECT_EQ(node_count({Shape::triangle, 3}), 10);
    EXPECT_EQ(node_count({Shape::triangle, 10}), 66);
    EXPECT_EQ(node_count({Shape::quadrilateral, 2}), 9);
    EXPECT_EQ(node_count({Shape::tetrahedron, 3}), 20);
    EXPECT_EQ(node_count({Shape::tetrahedron, 10}), 286);
    EXPECT_EQ(node_count({Shape::hexahedron, 3}), 64);
    EXPECT_EQ(node_count({Shape::prism, 2}), 18);
    EXPECT_EQ(node_count({Shape::prism, 3}), 40);
    EXPECT_EQ(node_count({Shape::pyramid, 2}), 14);
    EXPECT_EQ(node_count({Shape::pyramid, 3}), 30);
}

TEST(ElementType, order_one_has_the_corners_only) {
    for (const Shape shape : all_shapes) EXPECT_EQ(node_count({shape, 1}), corner_count(shape)) << name(shape);
}

TEST(ElementType, speaks_english) {
    EXPECT_EQ(name(ElementType{Shape::triangle, 3}), "P3 triangle");
    EXPECT_EQ(counted_name(Shape::triangle, 1), "1 triangle");
    EXPECT_EQ(counted_name(Shape::prism, 3), "3 prisms");
    EXPECT_EQ(counted_name(Shape::tetrahedron, 2), "2 tetrahedra");
    EXPECT_EQ(counted_name(Shape::hexahedron, 0), "0 hexahedra");
    EXPECT_EQ(counted_name(Shape::vertex, 5), "5 vertices");
}

TEST(ElementType, knows_dimensions_and_simplices) {
    for (const Shape shape : all_shapes)
        EXPECT_EQ(is_simplex(shape), corner_count(shape) == dimension(shape) + 1) << name(shape);
}

}  // namespace
}  // namespace curvewright
