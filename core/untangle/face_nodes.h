#pragma once

#include "core/mesh/curved_mesh.h"

namespace curvewright {

/// Puts the interior nodes of a curved triangle (order 3 and up) where its edges ask for; x and y only.
///
/// The mean of the triangle's high-order edge nodes: the thesis's choice for the one face node of order 3 (chapter 4,
/// Alg. 6, second pass).
void place_face_nodes_at_mean(const MeshTopology& topology, Index triangle, Coordinates& x);

/// The straight-sided triangle plus every edge's deviation from its straight line, blended into the triangle: on the
/// edge from corner a to b with deviation d(t), the term la lb d(t) / (t (1 - t)) at t = (1 + lb - la) / 2, la and lb
/// the barycentric coordinates (Szabó, Babuška, "Finite Element Analysis", 1991, 6.2: blending functions). Right for
/// every order: nodes of straight-sided triangles stay, and maps that are quadratic are reproduced.
void blend_face_nodes(const MeshTopology& topology, Index triangle, Coordinates& x);

}  // namespace curvewright
