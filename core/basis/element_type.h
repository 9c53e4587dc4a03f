#pragma once

#include <compare>
#include <string>
#include <vector>

namespace curvewright {

/// Shape of a reference element. "Prism" is VTK's wedge.
enum class Shape { vertex, line, triangle, quadrilateral, tetrahedron, hexahedron, prism, pyramid };

/// Highest order that the library knows.
inline constexpr int max_order = 10;

/// A Lagrange element on equispaced nodes: shape and order (polynomial degree), 1 to max_order.
struct ElementType {
    Shape shape = Shape::vertex;
    int order = 1;
    friend auto operator<=>(const ElementType&, const ElementType&) = default;
};

/// Dimension of the reference element, 0 to 3.
int dimension(Shape shape);
/// Number of corners.
int corner_count(Shape shape);
/// Number of nodes of the full (not serendipity) Lagrange element; pyramids have sum of (k+1)^2, k = 0..order.
int node_count(ElementType type);
/// Whether it is a line, triangle or tetrahedron.
bool is_simplex(Shape shape);
/// Dimensions of the simplices whose product the reference element is, in the order of the reference axes: {3} for a
/// tetrahedron, {2, 1} for a prism, {1, 1, 1} for a hexahedron. Empty for vertices and pyramids.
std::vector<int> simplex_factors(Shape shape);
/// Line, triangle or tetrahedron. dimension: 1 to 3.
Shape simplex(int dimension);
/// Singular English name ("triangle"); plural with count ("1 triangle", "3 prisms").
std::string name(Shape shape);
/// "1 triangle", "3 prisms".
std::string counted_name(Shape shape, long count);
/// "P3 triangle".
std::string name(ElementType type);

}  // namespace curvewright
