#pragma once

#include <random>
#include <vector>

#include "core/mesh/curved_mesh.h"

namespace curvewright::testing {

/// One element with the given node positions (node_count × 3, this program's order); tags 1, 2, ….
CurvedMesh single_element(ElementType type, const Eigen::MatrixX3d& x);

/// The unit square as n × n squares of two triangles each, straight-sided of the given order. Boundary lines are in the
/// groups "bottom", "right", "top", "left", triangles in "domain". Node and element tags start at 11 and 101.
CurvedMesh square_mesh(int n, int order);

/// The same mesh with the edges of its bottom side bent into it by `height`; their corners stay. 2D, of order 2 and up.
/// Enough height (some 0.1 for n = 3) tangles the triangles there.
CurvedMesh bulged_square_mesh(int n, int order, double height);

/// The unit cube as n × n × n cubes of six tetrahedra each; boundary triangles in the groups "x0", "x1", "y0", …, "z1".
CurvedMesh cube_mesh(int n, int order);

/// The unit square as n × n quadrilaterals; boundary lines in groups like those of square_mesh.
CurvedMesh quad_mesh(int n, int order);

/// The unit cube as n × n × n hexahedra, as twice as many prisms (axis along z), or, of order 1 only, as six pyramids
/// per cube with their apices in its middle. One group, "domain".
CurvedMesh hex_mesh(int n, int order);
CurvedMesh prism_mesh(int n, int order);
CurvedMesh pyramid_mesh(int n);

/// The unit square of order 1 or more whose left half consists of quadrilaterals and whose right half of triangles, and
/// the unit cube of hexahedra on the left and prisms on the right. n: even. Groups like those of quad_mesh and
/// hex_mesh.
CurvedMesh mixed_square_mesh(int n, int order);
CurvedMesh mixed_cube_mesh(int n, int order);

/// The same mesh with its corners moved at random by up to ±amplitude (2D: in the plane; boundary corners too), and of
/// the given order: general elements with straight edges.
CurvedMesh with_shaken_corners(const CurvedMesh& linear, double amplitude, int order, std::mt19937& random);

/// Moves every interior node by a uniformly random vector of components within ±amplitude (2D: in the plane).
CurvedMesh shaken(const CurvedMesh& mesh, double amplitude, std::mt19937& random);

/// A random well-shaped element: an affine image of the reference element whose nodes (not those of a simplex of order
/// 1) are moved at random by about amplitude / order^2.
Eigen::MatrixX3d random_element(ElementType type, double amplitude, std::mt19937& random);

}  // namespace curvewright::testing
