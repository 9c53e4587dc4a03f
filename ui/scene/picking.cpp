#include "ui/scene/picking.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

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

namespace {

bool is_inside(const DisplayPolygon& polygon, double x, double y) {
    bool inside = false;
    for (std::size_t i = 0, j = polygon.size() - 1; i < polygon.size(); j = i++) {
        const auto& [ax, ay] = polygon[i];
        const auto& [bx, by] = polygon[j];
        if ((ay > y) != (by > y) && x < (bx - ax) * (y - ay) / (by - ay) + ax) inside = !inside;
    }
    return inside;
}

void box_of(const DisplayPolygon& polygon, std::array<double, 2>& low, std::array<double, 2>& high) {
    low = high = polygon.front();
    for (const auto& corner : polygon)
        for (std::size_t d = 0; d < 2; ++d) {
            low[d] = std::min(low[d], corner[d]);
            high[d] = std::max(high[d], corner[d]);
        }
}

}  // namespace

DepthMap::DepthMap(const Tessellation& tessellation, const WorldFrame& frame, const ViewMetrics& view,
                   std::array<double, 2> low, std::array<double, 2> high) {
    row_ = view.world_to_clip.row(view.is_parallel ? 2 : 3);
    row_ /= row_.head<3>().norm();
    left_ = std::max(0, static_cast<int>(std::floor(low[0])) - 1);
    bottom_ = std::max(0, static_cast<int>(std::floor(low[1])) - 1);
    width_ = std::min(view.size[0], static_cast<int>(std::ceil(high[0])) + 2) - left_;
    height_ = std::min(view.size[1], static_cast<int>(std::ceil(high[1])) + 2) - bottom_;
    if (width_ <= 0 || height_ <= 0) return;
    depth_.assign(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_),
                  std::numeric_limits<float>::infinity());
    const auto& points = tessellation.surface_points();
    std::vector<std::array<double, 3>> screen(points.size() / 3);
    for (std::size_t i = 0; i < screen.size(); ++i) {
        const Eigen::RowVector3d world = frame.to_world(
            Eigen::RowVector3d(points[3 * i], points[3 * i + 1], points[3 * i + 2]) + tessellation.origin());
        const Eigen::Vector4d at = view.project(world);
        screen[i] = {at[3] > 0.0 ? at[0] - left_ : std::nan(""), at[1] - bottom_, depth_of(world)};
    }
    const auto& triangles = tessellation.triangles();
    for (std::size_t corner = 0; corner + 2 < triangles.size(); corner += 3) {
        const auto &a = screen[triangles[corner]], &b = screen[triangles[corner + 1]],
                   &c = screen[triangles[corner + 2]];
        const double area = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
        if (!(std::abs(area) > 0.0)) continue;
        const auto clip = [](double value, int size) { return std::clamp(static_cast<int>(value), 0, size - 1); };
        const double most_x = std::max({a[0], b[0], c[0]}), least_x = std::min({a[0], b[0], c[0]});
        const double most_y = std::max({a[1], b[1], c[1]}), least_y = std::min({a[1], b[1], c[1]});
        if (most_x < 0.0 || most_y < 0.0 || least_x >= width_ || least_y >= height_) continue;
        for (int y = clip(least_y, height_); y <= clip(most_y + 1.0, height_); ++y)
            for (int x = clip(least_x, width_); x <= clip(most_x + 1.0, width_); ++x) {
                const double wb = ((x - a[0]) * (c[1] - a[1]) - (y - a[1]) * (c[0] - a[0])) / area;
                const double wc = ((b[0] - a[0]) * (y - a[1]) - (b[1] - a[1]) * (x - a[0])) / area;
                if (wb < 0.0 || wc < 0.0 || wb + wc > 1.0) continue;
                float& nearest = depth_[static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
                                        static_cast<std::size_t>(x)];
                nearest = std::min(nearest, static_cast<float>(a[2] + wb * (b[2] - a[2]) + wc * (c[2] - a[2])));
            }
    }
}

double DepthMap::depth_of(const Eigen::RowVector3d& world) const {
    return row_.head<3>().dot(world) + row_[3];
}

bool DepthMap::hides(double x, double y, const Eigen::RowVector3d& world) const {
    const int column = static_cast<int>(std::lround(x)) - left_, line = static_cast<int>(std::lround(y)) - bottom_;
    if (column < 0 || line < 0 || column >= width_ || line >= height_) return false;
    return depth_[static_cast<std::size_t>(line) * static_cast<std::size_t>(width_) +
                  static_cast<std::size_t>(column)] < depth_of(world) - 0.01;
}

std::optional<Index> pick_drawn_node(const CurvedMesh& mesh, const Tessellation& tessellation, const WorldFrame& frame,
                                     const ViewMetrics& view, double x, double y, double radius, bool hides,
                                     const std::function<bool(Index)>& accepts) {
    struct Candidate {
        double distance;
        Index node;
        Eigen::Vector4d at;
    };
    std::vector<Candidate> candidates;
    for (Index node : tessellation.nodes()) {
        const Eigen::Vector4d at = view.project(frame.to_world(mesh.coordinates().row(node)));
        const double distance = std::hypot(at[0] - x, at[1] - y);
        if (at[3] > 0.0 && distance <= radius && accepts(node)) candidates.push_back({distance, node, at});
    }
    if (candidates.empty()) return std::nullopt;
    std::sort(candidates.begin(), candidates.end(), [](const Candidate& a, const Candidate& b) {
        return std::pair(a.distance, a.node) < std::pair(b.distance, b.node);
    });
    if (!hides) return candidates.front().node;
    const DepthMap depth(tessellation, frame, view, {x - radius, y - radius}, {x + radius, y + radius});
    for (const Candidate& candidate : candidates)
        if (!depth.hides(candidate.at[0], candidate.at[1], frame.to_world(mesh.coordinates().row(candidate.node))))
            return candidate.node;
    return std::nullopt;
}

std::vector<Index> pick_nodes_inside(const CurvedMesh& mesh, const Tessellation& tessellation, const WorldFrame& frame,
                                     const ViewMetrics& view, const DisplayPolygon& polygon, bool hides) {
    if (polygon.size() < 3) return {};
    std::optional<DepthMap> depth;
    if (hides) {
        std::array<double, 2> low{}, high{};
        box_of(polygon, low, high);
        depth.emplace(tessellation, frame, view, low, high);
    }
    std::vector<Index> nodes;
    for (Index node : tessellation.nodes()) {
        const Eigen::RowVector3d world = frame.to_world(mesh.coordinates().row(node));
        const Eigen::Vector4d at = view.project(world);
        if (at[3] > 0.0 && is_inside(polygon, at[0], at[1]) && !(depth && depth->hides(at[0], at[1], world)))
            nodes.push_back(node);
    }
    return nodes;
}

std::vector<Index> pick_elements_inside(const Tessellation& tessellation, const WorldFrame& frame,
                                        const ViewMetrics& view, const DisplayPolygon& polygon, bool hides) {
    if (polygon.size() < 3) return {};
    std::optional<DepthMap> depth;
    if (hides) {
        std::array<double, 2> low{}, high{};
        box_of(polygon, low, high);
        depth.emplace(tessellation, frame, view, low, high);
    }
    // The triangles of a face stand together.
    std::vector<Index> elements;
    const auto& owner = tessellation.triangle_elements();
    for (std::size_t first = 0; first < owner.size();) {
        std::size_t end = first;
        Eigen::RowVector3d sum = Eigen::RowVector3d::Zero();
        for (; end < owner.size() && owner[end] == owner[first]; ++end)
            for (std::size_t corner = 0; corner < 3; ++corner) {
                const float* x = tessellation.surface_points().data() + 3 * tessellation.triangles()[3 * end + corner];
                sum += Eigen::RowVector3d(x[0], x[1], x[2]);
            }
        const Eigen::RowVector3d world =
            frame.to_world(sum / (3.0 * static_cast<double>(end - first)) + tessellation.origin());
        const Eigen::Vector4d at = view.project(world);
        if (at[3] > 0.0 && is_inside(polygon, at[0], at[1]) && !(depth && depth->hides(at[0], at[1], world)))
            elements.push_back(owner[first]);
        first = end;
    }
    std::sort(elements.begin(), elements.end());
    elements.erase(std::unique(elements.begin(), elements.end()), elements.end());
    return elements;
}

}  // namespace curvewright
