#pragma once

#include <array>
#include <optional>

#include "core/tessellate/plane_cut.h"

namespace curvewright {

/// The coefficients (a, b, c, d) with which a shader tells what is cut away: a x + b y + c z + d > 0 for points
/// relative to `origin`. A little room keeps what lies in the plane. None: nothing is cut away.
std::array<float, 4> cut_coefficients(const std::optional<CuttingPlane>& plane, const Eigen::RowVector3d& origin,
                                      double mesh_size);

}  // namespace curvewright
