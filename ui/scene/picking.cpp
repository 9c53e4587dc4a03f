#include "ui/scene/picking.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <Eigen/Geometry>

namespace curvewright {

namespace {

/// A distance from the plane that counts as none, as in what is drawn.
double drawing_room(const WorldFrame& frame) {
    return 2e-6 * frame.size;
}

bool is_cut_away(const CuttingPlane* plane, const Eigen::RowVector3d& point, const WorldFrame& frame) {
    return plane && plane->distance(point) > drawing_room(frame);
}

const CuttingPlane* plane_of(const DrawnSurface& surface) {
    return surface.section ? &surface.section->plane() : nullptr;
}

/// One of the two sets of triangles that a surface consists of.
struct TriangleSet {
    const std::vector<float>& points;
    const std::vector<Index>&triangles, &elements;
    const Eigen::RowVector3d& origin;
    const CuttingPlane* plane;  ///< null = all of it is drawn
};

void pick_triangle(const TriangleSet& set, const WorldFrame& frame, const ViewMetrics& view, double x, double y,
                   const std::function<int(Index)>& rank, std::optional<Pick>& best, int& best_rank) {
    const std::size_t count = set.points.size() / 3;
    // Display position relative to the picked one, depth and divisor; behind the eye: not finite.
    std::vector<std::array<double, 4>> screen(count);
    Eigen::Matrix4d matrix = view.world_to_clip;
    const Eigen::RowVector3d offset = frame.to_world(set.origin);
    matrix.col(3) += matrix.leftCols<3>() * offset.transpose();
    matrix.leftCols<3>() /= frame.size;
    for (std::size_t i = 0; i < count; ++i) {
        const Eigen::Vector4d clip =
            matrix * Eigen::Vector4d(set.points[3 * i], set.points[3 * i + 1], set.points[3 * i + 2], 1.0);
        const double w = clip[3] > 0.0 ? clip[3] : std::nan("");
        screen[i] = {0.5 * (clip[0] / w + 1.0) * view.size[0] - x, 0.5 * (clip[1] / w + 1.0) * view.size[1] - y,
                     clip[2] / w, w};
    }
    const auto point = [&set](Index i) {
        return Eigen::RowVector3d(set.points[3 * i], set.points[3 * i + 1], set.points[3 * i + 2]);
    };
    for (std::size_t triangle = 0; triangle < set.elements.size(); ++triangle) {
        const Index* corners = set.triangles.data() + 3 * triangle;
        const auto &a = screen[corners[0]], &b = screen[corners[1]], &c = screen[corners[2]];
        const double wa = b[0] * c[1] - b[1] * c[0], wb = c[0] * a[1] - c[1] * a[0], wc = a[0] * b[1] - a[1] * b[0];
        const double sum = wa + wb + wc;
        const bool is_inside = (wa >= 0.0 && wb >= 0.0 && wc >= 0.0) || (wa <= 0.0 && wb <= 0.0 && wc <= 0.0);
        if (!is_inside || !(std::abs(sum) > 0.0)) continue;
        const double depth = (wa * a[2] + wb * b[2] + wc * c[2]) / sum;
        constexpr double same_depth = 1e-9;
        if (best && depth > best->depth + same_depth) continue;
        if (set.plane) {
            const double va = wa / a[3], vb = wb / b[3], vc = wc / c[3];  // weights in space
            const Eigen::RowVector3d at =
                (va * point(corners[0]) + vb * point(corners[1]) + vc * point(corners[2])) / (va + vb + vc);
            if (is_cut_away(set.plane, at + set.origin, frame)) continue;
        }
        const Index element = set.elements[triangle];
        const int its_rank = rank(element);
        if (best && depth > best->depth - same_depth && its_rank <= best_rank) continue;
        best = Pick{element, depth};
        best_rank = its_rank;
    }
}

}  // namespace

std::optional<Pick> pick_surface(const DrawnSurface& surface, const WorldFrame& frame, const ViewMetrics& view,
                                 double x, double y, const std::function<int(Index)>& rank) {
    std::optional<Pick> best;
    int best_rank = 0;
    const Tessellation& skin = surface.skin;
    pick_triangle({skin.surface_points(), skin.triangles(), skin.triangle_elements(), skin.origin(), plane_of(surface)},
                  frame, view, x, y, rank, best, best_rank);
    if (const PlaneCut* section = surface.section)
        pick_triangle(
            {section->points(), section->triangles(), section->triangle_elements(), section->origin(), nullptr}, frame,
            view, x, y, rank, best, best_rank);
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

DepthMap::DepthMap(const DrawnSurface& surface, const WorldFrame& frame, const ViewMetrics& view,
                   std::array<double, 2> low, std::array<double, 2> high) {
    is_parallel_ = view.is_parallel;
    row_ = view.world_to_clip.row(view.is_parallel ? 2 : 3);
    row_ /= row_.head<3>().norm();
    left_ = std::max(0, static_cast<int>(std::floor(low[0])) - 1);
    bottom_ = std::max(0, static_cast<int>(std::floor(low[1])) - 1);
    width_ = std::min(view.size[0], static_cast<int>(std::ceil(high[0])) + 2) - left_;
    height_ = std::min(view.size[1], static_cast<int>(std::ceil(high[1])) + 2) - bottom_;
    if (width_ <= 0 || height_ <= 0) return;
    depth_.assign(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_),
                  std::numeric_limits<float>::infinity());
    add(surface.skin.surface_points(), surface.skin.triangles(), surface.skin.origin(), plane_of(surface), frame, view);
    if (surface.section)
        add(surface.section->points(), surface.section->triangles(), surface.section->origin(), nullptr, frame, view);
}

void DepthMap::add(const std::vector<float>& points, const std::vector<Index>& triangles,
                   const Eigen::RowVector3d& origin, const CuttingPlane* plane, const WorldFrame& frame,
                   const ViewMetrics& view) {
    std::vector<std::array<double, 3>> screen(points.size() / 3);
    std::vector<double> beyond(plane ? screen.size() : 0);
    for (std::size_t i = 0; i < screen.size(); ++i) {
        const Eigen::RowVector3d point =
            Eigen::RowVector3d(points[3 * i], points[3 * i + 1], points[3 * i + 2]) + origin;
        const Eigen::RowVector3d world = frame.to_world(point);
        const Eigen::Vector4d at = view.project(world);
        // In perspective the reciprocal of the depth is what changes evenly over the screen.
        const double depth = depth_of(world);
        screen[i] = {at[3] > 0.0 ? at[0] - left_ : std::nan(""), at[1] - bottom_, is_parallel_ ? depth : 1.0 / depth};
        if (plane) beyond[i] = plane->distance(point) - drawing_room(frame);
    }
    for (std::size_t corner = 0; corner + 2 < triangles.size(); corner += 3) {
        const auto &a = screen[triangles[corner]], &b = screen[triangles[corner + 1]],
                   &c = screen[triangles[corner + 2]];
        const double area = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
        if (!(std::abs(area) > 0.0)) continue;
        const auto clip = [](double value, int size) { return std::clamp(static_cast<int>(value), 0, size - 1); };
        const double most_x = std::max({a[0], b[0], c[0]}), least_x = std::min({a[0], b[0], c[0]});
        const double most_y = std::max({a[1], b[1], c[1]}), least_y = std::min({a[1], b[1], c[1]});
        if (most_x < 0.0 || most_y < 0.0 || least_x >= width_ || least_y >= height_) continue;
        std::array<double, 3> over{-1.0, -1.0, -1.0};
        if (plane)
            for (std::size_t i = 0; i < 3; ++i) over[i] = beyond[triangles[corner + i]];
        if (std::min({over[0], over[1], over[2]}) > 0.0) continue;
        for (int y = clip(least_y, height_); y <= clip(most_y + 1.0, height_); ++y)
            for (int x = clip(least_x, width_); x <= clip(most_x + 1.0, width_); ++x) {
                const double wb = ((x - a[0]) * (c[1] - a[1]) - (y - a[1]) * (c[0] - a[0])) / area;
                const double wc = ((b[0] - a[0]) * (y - a[1]) - (b[1] - a[1]) * (x - a[0])) / area;
                if (wb < 0.0 || wc < 0.0 || wb + wc > 1.0) continue;
                if (over[0] + wb * (over[1] - over[0]) + wc * (over[2] - over[0]) > 0.0) continue;
                float& nearest = depth_[static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
                                        static_cast<std::size_t>(x)];
                const double here = a[2] + wb * (b[2] - a[2]) + wc * (c[2] - a[2]);
                nearest = std::min(nearest, static_cast<float>(is_parallel_ ? here : 1.0 / here));
            }
    }
}

bool DepthMap::is_behind(double x, double y, const Eigen::RowVector3d& world, double distance) const {
    const int left = static_cast<int>(std::floor(x)) - left_, bottom = static_cast<int>(std::floor(y)) - bottom_;
    if (left < 0 || bottom < 0 || left + 1 >= width_ || bottom + 1 >= height_) return false;
    float farthest = 0.0f;
    for (int line = bottom; line < bottom + 2; ++line)
        for (int column = left; column < left + 2; ++column)
            farthest = std::max(farthest, depth_[static_cast<std::size_t>(line) * static_cast<std::size_t>(width_) +
                                                 static_cast<std::size_t>(column)]);
    return farthest < depth_of(world) - distance;
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

std::optional<Index> pick_drawn_node(const CurvedMesh& mesh, const DrawnSurface& surface, const WorldFrame& frame,
                                     const ViewMetrics& view, double x, double y, double radius, bool hides,
                                     const std::function<bool(Index)>& accepts) {
    struct Candidate {
        double distance;
        Index node;
        Eigen::Vector4d at;
    };
    std::vector<Candidate> candidates;
    for (Index node : surface.skin.nodes()) {
        if (is_cut_away(plane_of(surface), mesh.coordinates().row(node), frame)) continue;
        const Eigen::Vector4d at = view.project(frame.to_world(mesh.coordinates().row(node)));
        const double distance = std::hypot(at[0] - x, at[1] - y);
        if (at[3] > 0.0 && distance <= radius && accepts(node)) candidates.push_back({distance, node, at});
    }
    if (candidates.empty()) return std::nullopt;
    std::sort(candidates.begin(), candidates.end(), [](const Candidate& a, const Candidate& b) {
        return std::pair(a.distance, a.node) < std::pair(b.distance, b.node);
    });
    if (!hides) return candidates.front().node;
    const DepthMap depth(surface, frame, view, {x - radius, y - radius}, {x + radius, y + radius});
    for (const Candidate& candidate : candidates)
        if (!depth.hides(candidate.at[0], candidate.at[1], frame.to_world(mesh.coordinates().row(candidate.node))))
            return candidate.node;
    return std::nullopt;
}

std::vector<Index> pick_nodes_inside(const CurvedMesh& mesh, const DrawnSurface& surface, const WorldFrame& frame,
                                     const ViewMetrics& view, const DisplayPolygon& polygon, bool hides) {
    if (polygon.size() < 3) return {};
    std::optional<DepthMap> depth;
    if (hides) {
        std::array<double, 2> low{}, high{};
        box_of(polygon, low, high);
        depth.emplace(surface, frame, view, low, high);
    }
    std::vector<Index> nodes;
    for (Index node : surface.skin.nodes()) {
        if (is_cut_away(plane_of(surface), mesh.coordinates().row(node), frame)) continue;
        const Eigen::RowVector3d world = frame.to_world(mesh.coordinates().row(node));
        const Eigen::Vector4d at = view.project(world);
        if (at[3] > 0.0 && is_inside(polygon, at[0], at[1]) && !(depth && depth->hides(at[0], at[1], world)))
            nodes.push_back(node);
    }
    return nodes;
}

std::vector<Index> pick_elements_inside(const DrawnSurface& surface, const WorldFrame& frame, const ViewMetrics& view,
                                        const DisplayPolygon& polygon, bool hides) {
    if (polygon.size() < 3) return {};
    std::optional<DepthMap> depth;
    if (hides) {
        std::array<double, 2> low{}, high{};
        box_of(polygon, low, high);
        depth.emplace(surface, frame, view, low, high);
    }
    std::vector<Index> elements;
    for (const FaceMiddle& middle : face_middles(surface)) {
        const Eigen::RowVector3d world = frame.to_world(middle.at);
        const Eigen::Vector4d at = view.project(world);
        if (at[3] > 0.0 && is_inside(polygon, at[0], at[1]) && !(depth && depth->hides(at[0], at[1], world)))
            elements.push_back(middle.element);
    }
    std::sort(elements.begin(), elements.end());
    elements.erase(std::unique(elements.begin(), elements.end()), elements.end());
    return elements;
}

std::vector<FaceMiddle> face_middles(const DrawnSurface& surface) {
    std::vector<FaceMiddle> middles;
    const auto add = [&middles](const std::vector<float>& points, const std::vector<Index>& triangles,
                                const std::vector<Index>& owner, const Eigen::RowVector3d& origin,
                                const CuttingPlane* plane, bool has_own_points) {
        // The triangles of a face stand together; faces of the skin share no points.
        for (std::size_t first = 0; first < owner.size();) {
            std::size_t end = first;
            Eigen::RowVector3d sum = Eigen::RowVector3d::Zero();
            double total = 0.0;
            Index last_point = triangles[3 * first];
            for (; end < owner.size() && owner[end] == owner[first]; ++end) {
                const Index* corners = triangles.data() + 3 * end;
                if (has_own_points && std::min({corners[0], corners[1], corners[2]}) > last_point) break;
                last_point = std::max({last_point, corners[0], corners[1], corners[2]});
                Eigen::RowVector3d x[3];
                for (std::size_t corner = 0; corner < 3; ++corner) {
                    const float* at = points.data() + 3 * corners[corner];
                    x[corner] = Eigen::RowVector3d(at[0], at[1], at[2]);
                }
                const double area = (x[1] - x[0]).cross(x[2] - x[0]).norm();
                sum += area / 3.0 * (x[0] + x[1] + x[2]);
                total += area;
            }
            const Eigen::RowVector3d at = sum / total + origin;
            if (total > 0.0 && !(plane && plane->distance(at) > 0.0)) middles.push_back({owner[first], at});
            first = end;
        }
    };
    const Tessellation& skin = surface.skin;
    add(skin.surface_points(), skin.triangles(), skin.triangle_elements(), skin.origin(), plane_of(surface), true);
    if (const PlaneCut* section = surface.section)
        add(section->points(), section->triangles(), section->triangle_elements(), section->origin(), nullptr, false);
    return middles;
}

}  // namespace curvewright
