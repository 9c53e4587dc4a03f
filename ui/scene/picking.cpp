#include "ui/scene/picking.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace curvewright {

std::optional<Pick> pick_surface(const Tessellation& tessellation, const WorldFrame& frame, const ViewMetrics& view,
                                 double x, double y, const std::function<int(Index)>& rank) {
    const auto& points = tessellation.surface_points();
    const std::size_t count = points.size() / 3;
    // Display position relative to the picked one, and depth; behind the eye: not finite.
    std::vector<std::array<double, 3>> screen(count);
    Eigen::Matrix4d matrix = view.world_to_clip;
    const Eigen::RowVector3d offset = frame.to_world(tessellation.origin());
    matrix.col(3) += matrix.leftCols<3>() * offset.transpose();
    matrix.leftCols<3>() /= frame.size;
    for (std::size_t i = 0; i < count; ++i) {
        const Eigen::Vector4d clip = matrix * Eigen::Vector4d(points[3 * i], points[3 * i + 1], points[3 * i + 2], 1.0);
        const double w = clip[3] > 0.0 ? clip[3] : std::nan("");
        screen[i] = {0.5 * (clip[0] / w + 1.0) * view.size[0] - x, 0.5 * (clip[1] / w + 1.0) * view.size[1] - y,
                     clip[2] / w};
    }
    std::optional<Pick> best;
    int best_rank = 0;
    const auto& triangles = tessellation.triangles();
    for (std::size_t triangle = 0; triangle < tessellation.triangle_elements().size(); ++triangle) {
        const auto& a = screen[triangles[3 * triangle]];
        const auto& b = screen[triangles[3 * triangle + 1]];
        const auto& c = screen[triangles[3 * triangle + 2]];
        const double wa = b[0] * c[1] - b[1] * c[0], wb = c[0] * a[1] - c[1] * a[0], wc = a[0] * b[1] - a[1] * b[0];
        const double sum = wa + wb + wc;
        const bool is_inside = (wa >= 0.0 && wb >= 0.0 && wc >= 0.0) || (wa <= 0.0 && wb <= 0.0 && wc <= 0.0);
        if (!is_inside || !(std::abs(sum) > 0.0)) continue;
        const double depth = (wa * a[2] + wb * b[2] + wc * c[2]) / sum;
        const Index element = tessellation.triangle_elements()[triangle];
        constexpr double same_depth = 1e-9;
        if (best && depth > best->depth + same_depth) continue;
        const int its_rank = rank(element);
        if (best && depth > best->depth - same_depth && its_rank <= best_rank) continue;
        best = Pick{element, depth};
        best_rank = its_rank;
    }
    return best;
}

}  // namespace curvewright
