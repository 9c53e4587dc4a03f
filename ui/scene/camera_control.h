#pragma once

#include <array>
#include <vector>

#include "ui/scene/mesh_scene.h"
#include "ui/scene/view_metrics.h"

namespace curvewright {

/// All that there is to know about where a camera is, so that it can be put back there. World points.
struct CameraState {
    std::array<double, 3> position{}, focus{}, up{};
    double scale = 1.0;         ///< half the height of the view, in parallel projection
    bool keeps_fitted = false;  ///< nobody has moved it since it was fitted: that is done again for another window
    std::array<int, 2> fitted_size{0, 0};  ///< of the window that it was fitted to
    double fitted_margin = 0.0;
};

/// The camera of one renderer: fits the view, keeps it fitted while the window changes its size and nobody has moved
/// the camera, pans, zooms and turns. All points are world points.
class CameraControl {
  public:
    explicit CameraControl(vtkRenderer* renderer);

    /// Flat meshes are looked at along -z in parallel projection; others in perspective, or orthographically.
    void set_flat(bool is_flat);
    bool is_flat() const { return is_flat_; }
    /// Solid meshes in parallel projection. What is in the focal plane keeps its size.
    void set_orthographic(bool is_orthographic);
    /// Flat or orthographic.
    bool is_parallel() const { return is_flat_ || is_orthographic_; }
    /// What `fit` shows: 3 per point, and the box that the clipping range has to hold.
    void set_content(std::vector<float> points);
    /// Strip at the right of the viewport that the legend covers, device pixels.
    void set_right_margin(double pixels) { right_margin_ = pixels; }

    void look(ViewDirection direction);
    /// The same from anywhere: to_eye points from the mesh to the camera. Solid meshes only.
    void look_from(const Eigen::RowVector3d& to_eye);
    /// Centres a ball of the given radius so that it fills a fifth of the view's height; turns to look along
    /// -facing if that is not zero (3D).
    void focus(const Eigen::RowVector3d& center, double radius, const Eigen::RowVector3d& facing);

    /// Mouse: by device pixels; display positions have their origin bottom left.
    void pan(double from_x, double from_y, double to_x, double to_y);
    void rotate(double pixels_x, double pixels_y);
    /// factor > 1 comes closer; the point under the mouse stays there. depth: of that point (-1..1); focal plane if
    /// none.
    void zoom(double factor, double x, double y, const std::optional<double>& depth);

    CameraState state() const;
    void set_state(const CameraState& state);

    /// Before every frame: refits after a change of the window's size, sets the clipping range.
    void prepare_frame();
    ViewMetrics metrics(double pixel_ratio) const;
    /// From the eye to the focal point, world units; means nothing in parallel projection.
    double distance() const;
    /// World point at a display position and depth.
    Eigen::Vector3d unproject(double x, double y, double depth) const;
    /// Columns: right, up, towards the eye.
    Eigen::Matrix3d axes() const;

    /// Takes over the other camera's position (the frames may differ). is_exact: even if the other is kept fitted.
    void copy_view(const CameraControl& other, const WorldFrame& theirs, const WorldFrame& ours, bool is_exact);

  private:
    void fit();
    void turn_to(const Eigen::Vector3d& backward, const Eigen::Vector3d& up);
    void update_projection();
    /// Half the height of the view over the distance to where it is, in perspective.
    static double slope();
    std::array<int, 2> viewport() const;
    double focal_depth() const;

    vtkRenderer* renderer_;
    bool is_flat_ = true, is_orthographic_ = false;
    bool keeps_fitted_ = true;
    unsigned long fitted_camera_time_ = 0;
    std::array<int, 2> fitted_size_{0, 0};
    double fitted_margin_ = 0.0;
    double right_margin_ = 0.0;
    std::vector<float> points_;
    Eigen::Vector3d low_ = Eigen::Vector3d::Zero(), high_ = Eigen::Vector3d::Zero();
};

}  // namespace curvewright
