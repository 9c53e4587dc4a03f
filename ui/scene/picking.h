#pragma once

#include <functional>
#include <optional>

#include "core/tessellate/tessellation.h"
#include "ui/scene/view_metrics.h"

namespace curvewright {

struct Pick {
    Index element = 0;
    double depth = 0.0;  ///< -1 near .. 1 far
};

/// The element whose surface is in front at a display position (device pixels). Where surfaces lie at the same depth
/// (2D: tangled elements overlap their neighbours) the one with the higher rank is taken.
std::optional<Pick> pick_surface(const Tessellation& tessellation, const WorldFrame& frame, const ViewMetrics& view,
                                 double x, double y, const std::function<int(Index element)>& rank);

}  // namespace curvewright
