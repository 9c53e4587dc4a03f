#pragma once

#include <vector>

#include "core/tessellate/tessellation.h"

namespace curvewright {

/// Per polyline of the tessellation, in the mesh's unit: how far it is from its neighbours, judged by the
/// straight-sided element that it belongs to (2D: the height on the longest side; 3D: the shortest side).
std::vector<float> line_spacing(const CurvedMesh& mesh, const Tessellation& tessellation);

/// The same for elements told by their numbers.
std::vector<float> line_spacing(const CurvedMesh& mesh, const std::vector<Index>& elements);

/// Median of the values; 0 if there are none.
double median(std::vector<float> values);

}  // namespace curvewright
