#pragma once

#include <array>

#include <Eigen/Core>

class vtkActor;

namespace curvewright {

/// Where a mesh stands in the renderer's world: world = (mesh - origin) / size. The world is about 1 across whatever
/// the unit of the mesh, so that camera, clipping range and single precision work alike at 1e-6 and 1e6.
struct WorldFrame {
    Eigen::RowVector3d origin = Eigen::RowVector3d::Zero();
    double size = 1.0;

    Eigen::RowVector3d to_world(const Eigen::RowVector3d& point) const { return (point - origin) / size; }
    Eigen::RowVector3d to_mesh(const Eigen::RowVector3d& world) const { return world * size + origin; }
    /// Places an actor whose points are mesh coordinates relative to points_origin.
    void place(vtkActor* actor, const Eigen::RowVector3d& points_origin) const;
};

/// What the drawing of one frame needs to know of camera and window.
struct ViewMetrics {
    std::array<int, 2> size{1, 1};  ///< of the viewport, device pixels
    int tile_shift = 0;             ///< x + y of the first pixel, where only a part of the viewport is drawn
    double pixel_ratio = 1.0;       ///< device pixels per unit of lines, points and text
    bool is_parallel = true;
    /// Device pixels per world unit: everywhere (parallel), or times the distance from the camera (perspective).
    double pixel_scale = 1.0;
    Eigen::Matrix4d world_to_clip = Eigen::Matrix4d::Identity();

    /// Display position (device pixels, origin bottom left) and depth (-1 near .. 1 far) of a world point; the fourth
    /// is the divisor, positive in front of the camera.
    Eigen::Vector4d project(const Eigen::RowVector3d& world) const;
    double pixels_per_unit(double divisor) const { return is_parallel ? pixel_scale : pixel_scale / divisor; }
};

}  // namespace curvewright
