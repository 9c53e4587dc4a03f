#pragma once

#include "core/mesh/curved_mesh.h"
#include "core/quality/quality.h"

namespace curvewright {

/// Three quarters of a ring (radii 1 and 2) of 2 × 9 × 2 triangles of order 3; the side of one element next to the hole
/// is pushed through its opposite corner's neighbourhood, so that the element is tangled. Times unit, plus offset.
CurvedMesh make_ring(double unit = 1.0, const Eigen::RowVector3d& offset = Eigen::RowVector3d::Zero());
/// The element of make_ring that is tangled.
inline constexpr Index tangled_ring_element = 8;

/// A ball of radius 1 of 4^3 × 6 tetrahedra of order 2.
CurvedMesh make_ball();

/// A report made up for drawing: values from a few numbers, the given elements tangled or undecided.
QualityReport make_report(const CurvedMesh& mesh, const std::vector<Index>& tangled,
                          const std::vector<Index>& undecided = {});

}  // namespace curvewright
