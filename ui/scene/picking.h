#pragma once

#include <array>
#include <functional>
#include <optional>
#include <vector>

#include "core/tessellate/plane_cut.h"
#include "core/tessellate/tessellation.h"
#include "ui/scene/view_metrics.h"

namespace curvewright {

/// What is drawn of a mesh: its surface, and if it is cut only what is on this side of the plane, and the section.
struct DrawnSurface {
    const Tessellation& skin;
    const PlaneCut* section = nullptr;
};

struct Pick {
    Index element = 0;
    double depth = 0.0;  ///< -1 near .. 1 far
};

/// The element whose surface is in front at a display position (device pixels). Where surfaces lie at the same depth
/// (2D: tangled elements overlap their neighbours) the one with the higher rank is taken.
std::optional<Pick> pick_surface(const DrawnSurface& surface, const WorldFrame& frame, const ViewMetrics& view,
                                 double x, double y, const std::function<int(Index element)>& rank);

/// How far from the eye the drawn surface is within a box of the display: tells what it hides.
class DepthMap {
  public:
    /// low, high: corners of the box, device pixels.
    DepthMap(const DrawnSurface& surface, const WorldFrame& frame, const ViewMetrics& view, std::array<double, 2> low,
             std::array<double, 2> high);
    /// Whether the surface lies before a world point that shows at the display position (x, y) of the box, by more than
    /// a hundredth of the mesh's size.
    bool hides(double x, double y, const Eigen::RowVector3d& world) const;
    /// Whether it lies there before the point by more than a distance (world units) all around: on steep surfaces and
    /// at their rims one sample says little.
    bool is_behind(double x, double y, const Eigen::RowVector3d& world, double distance) const;

  private:
    double depth_of(const Eigen::RowVector3d& world) const;
    void add(const std::vector<float>& points, const std::vector<Index>& triangles, const Eigen::RowVector3d& origin,
             const CuttingPlane* plane, const WorldFrame& frame, const ViewMetrics& view);

    bool is_parallel_ = true;
    Eigen::RowVector4d row_;  ///< world point -> distance from the eye along the view
    int left_ = 0, bottom_ = 0, width_ = 0, height_ = 0;
    std::vector<float> depth_;  ///< height × width
};

/// The drawn node nearest to a display position within a radius that `accepts`; nodes that the surface hides are passed
/// over if hides.
std::optional<Index> pick_drawn_node(const CurvedMesh& mesh, const DrawnSurface& surface, const WorldFrame& frame,
                                     const ViewMetrics& view, double x, double y, double radius, bool hides,
                                     const std::function<bool(Index node)>& accepts);

/// The middle of a drawn face, or of an element's part of the section, in mesh coordinates.
struct FaceMiddle {
    Index element = 0;
    Eigen::RowVector3d at;
};
/// Those that are not cut away.
std::vector<FaceMiddle> face_middles(const DrawnSurface& surface);

using DisplayPolygon = std::vector<std::array<double, 2>>;  ///< device pixels, origin bottom left

/// Drawn nodes that show in a polygon, ascending.
std::vector<Index> pick_nodes_inside(const CurvedMesh& mesh, const DrawnSurface& surface, const WorldFrame& frame,
                                     const ViewMetrics& view, const DisplayPolygon& polygon, bool hides);
/// Elements with a drawn face (or piece of the section) whose middle shows in a polygon, ascending.
std::vector<Index> pick_elements_inside(const DrawnSurface& surface, const WorldFrame& frame, const ViewMetrics& view,
                                        const DisplayPolygon& polygon, bool hides);

}  // namespace curvewright
