#include "ui/scene/camera_control.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <vtkCamera.h>
#include <vtkMatrix4x4.h>
#include <vtkRenderer.h>
#include <Eigen/Geometry>
#include <Eigen/LU>

namespace curvewright {
namespace {

constexpr double fit_margin = 0.05;  ///< free part of the view at each side
constexpr double view_angle = 28.0;  ///< degrees, vertical
/// From the eye to the focal point in parallel projection, where it does not show: outside of the mesh, which is 1
/// across.
constexpr double parallel_distance = 3.0;

Eigen::Vector3d vector(const double* x) {
    return {x[0], x[1], x[2]};
}

/// Right, up and backward of the camera.
Eigen::Matrix3d camera_axes(vtkCamera* camera) {
    const Eigen::Vector3d backward = -vector(camera->GetDirectionOfProjection());
    const Eigen::Vector3d right = vector(camera->GetViewUp()).cross(backward).normalized();
    Eigen::Matrix3d axes;
    axes << right, backward.cross(right), backward;
    return axes;
}

void place(vtkCamera* camera, const Eigen::Vector3d& focal, const Eigen::Vector3d& position,
           const Eigen::Vector3d& up) {
    camera->SetFocalPoint(focal.data());
    camera->SetPosition(position.data());
    camera->SetViewUp(up.data());
}

}  // namespace

CameraControl::CameraControl(vtkRenderer* renderer) : renderer_(renderer) {
    set_flat(true);
}

std::array<int, 2> CameraControl::viewport() const {
    const int* size = renderer_->GetSize();
    return {std::max(1, size[0]), std::max(1, size[1])};
}

double CameraControl::slope() {
    return std::tan(0.5 * view_angle * std::numbers::pi / 180.0);
}

void CameraControl::set_flat(bool is_flat) {
    is_flat_ = is_flat;
    vtkCamera* camera = renderer_->GetActiveCamera();
    camera->SetParallelProjection(is_parallel());
    camera->SetViewAngle(view_angle);
}

void CameraControl::set_orthographic(bool is_orthographic) {
    if (is_orthographic == is_orthographic_) return;
    vtkCamera* camera = renderer_->GetActiveCamera();
    const bool was_fitted = keeps_fitted_ && fitted_camera_time_ == camera->GetMTime();
    is_orthographic_ = is_orthographic;
    if (is_flat_) return;
    camera->SetParallelProjection(is_orthographic);
    const Eigen::Vector3d focal = vector(camera->GetFocalPoint());
    const Eigen::Vector3d backward = camera_axes(camera).col(2);
    const Eigen::Vector3d up = vector(camera->GetViewUp());
    if (is_orthographic) {
        camera->SetParallelScale(camera->GetDistance() * slope());
        place(camera, focal, focal + parallel_distance * backward, up);
    } else {
        place(camera, focal, focal + camera->GetParallelScale() / slope() * backward, up);
    }
    if (was_fitted) fit();
}

void CameraControl::set_content(std::vector<float> points) {
    points_ = std::move(points);
    low_.setZero();
    high_.setZero();
    for (std::size_t i = 0; i + 2 < points_.size(); i += 3) {
        const Eigen::Vector3d x = Eigen::Vector3f(points_[i], points_[i + 1], points_[i + 2]).cast<double>();
        low_ = i == 0 ? x : Eigen::Vector3d(low_.cwiseMin(x));
        high_ = i == 0 ? x : Eigen::Vector3d(high_.cwiseMax(x));
    }
}

void CameraControl::turn_to(const Eigen::Vector3d& backward, const Eigen::Vector3d& up) {
    vtkCamera* camera = renderer_->GetActiveCamera();
    const Eigen::Vector3d focal = vector(camera->GetFocalPoint());
    place(camera, focal, focal + camera->GetDistance() * backward.normalized(), up);
    camera->OrthogonalizeViewUp();
}

void CameraControl::look(ViewDirection direction) {
    if (is_flat_)
        turn_to({0, 0, 1}, {0, 1, 0});
    else
        switch (direction) {
            case ViewDirection::fit:
                break;
            case ViewDirection::plus_x:
                turn_to({1, 0, 0}, {0, 0, 1});
                break;
            case ViewDirection::minus_x:
                turn_to({-1, 0, 0}, {0, 0, 1});
                break;
            case ViewDirection::plus_y:
                turn_to({0, 1, 0}, {0, 0, 1});
                break;
            case ViewDirection::minus_y:
                turn_to({0, -1, 0}, {0, 0, 1});
                break;
            case ViewDirection::plus_z:
                turn_to({0, 0, 1}, {0, 1, 0});
                break;
            case ViewDirection::minus_z:
                turn_to({0, 0, -1}, {0, 1, 0});
                break;
            case ViewDirection::isometric:
                turn_to({1.0, -1.3, 0.85}, {0, 0, 1});
                break;
        }
    keeps_fitted_ = true;
    fit();
}

void CameraControl::look_from(const Eigen::RowVector3d& to_eye) {
    if (!is_flat_ && to_eye.norm() > 0.0) {
        const Eigen::Vector3d backward = to_eye.transpose().normalized();
        const bool is_vertical = std::abs(backward[2]) > 0.999;
        turn_to(backward, is_vertical ? Eigen::Vector3d(0, 1, 0) : Eigen::Vector3d(0, 0, 1));
    }
    keeps_fitted_ = true;
    fit();
}

void CameraControl::fit() {
    vtkCamera* camera = renderer_->GetActiveCamera();
    update_projection();
    const auto [width, height] = viewport();
    const double margin = fit_margin * std::min(width, height);
    // Half extents of the free part of the view, relative to half the height of the whole.
    const double free_x = std::max(0.1 * width, width - right_margin_ - 2.0 * margin) / height;
    const double free_y = (height - 2.0 * margin) / height;
    const Eigen::Matrix3d axes = camera_axes(camera);
    constexpr double infinity = std::numeric_limits<double>::infinity();
    const Eigen::Vector2d steepness(1.0 / (slope() * free_x), 1.0 / (slope() * free_y));
    // Per screen axis: largest of +x and of -x (parallel), or the distances that these ask of the camera (perspective).
    Eigen::Array22d most = Eigen::Array22d::Constant(-infinity);
    double nearest = -infinity, farthest = infinity;
    for (std::size_t i = 0; i + 2 < points_.size(); i += 3) {
        const Eigen::Vector3d view =
            axes.transpose() * Eigen::Vector3f(points_[i], points_[i + 1], points_[i + 2]).cast<double>();
        for (int axis = 0; axis < 2; ++axis)
            for (int side = 0; side < 2; ++side) {
                const double x = side == 0 ? view[axis] : -view[axis];
                most(axis, side) = std::max(most(axis, side), is_parallel() ? x : x * steepness[axis] + view[2]);
            }
        nearest = std::max(nearest, view[2]);
        farthest = std::min(farthest, view[2]);
    }
    if (points_.empty()) {
        most.setConstant(0.5);
        nearest = farthest = 0.0;
    }
    Eigen::Vector3d center(0.0, 0.0, 0.5 * (nearest + farthest));
    double distance = parallel_distance;
    if (is_parallel()) {
        center.head<2>() = 0.5 * (most.col(0) - most.col(1)).matrix();
        const Eigen::Vector2d half = 0.5 * (most.col(0) + most.col(1)).matrix();
        camera->SetParallelScale(std::max({half[0] / free_x, half[1] / free_y, 1e-9}));
    } else {
        for (int axis = 0; axis < 2; ++axis) center[axis] = 0.5 * (most(axis, 0) - most(axis, 1)) / steepness[axis];
        distance = std::max(0.5 * (most.col(0) + most.col(1)).maxCoeff(), nearest + 1e-3) - center[2];
    }
    const Eigen::Vector3d focal = axes * center;
    place(camera, focal, focal + distance * axes.col(2), axes.col(1));
    fitted_size_ = viewport();
    fitted_margin_ = right_margin_;
    fitted_camera_time_ = camera->GetMTime();
}

void CameraControl::focus(const Eigen::RowVector3d& center, double radius, const Eigen::RowVector3d& facing) {
    vtkCamera* camera = renderer_->GetActiveCamera();
    keeps_fitted_ = false;
    Eigen::Vector3d backward = camera_axes(camera).col(2), up = vector(camera->GetViewUp());
    if (!is_flat_ && facing.norm() > 0.0) {
        backward = facing.transpose().normalized();
        if (std::abs(backward.dot(up)) > 0.95) up = backward.unitOrthogonal();
    }
    const double half_height = 5.0 * std::max(radius, 1e-9);
    const double distance = is_parallel() ? parallel_distance : half_height / slope();
    if (is_parallel()) camera->SetParallelScale(half_height);
    place(camera, center.transpose(), center.transpose() + distance * backward, up);
    camera->OrthogonalizeViewUp();
}

void CameraControl::update_projection() {
    // The middle of the free part of the window is the middle of the view.
    renderer_->GetActiveCamera()->SetWindowCenter(right_margin_ / viewport()[0], 0.0);
}

CameraState CameraControl::state() const {
    vtkCamera* camera = renderer_->GetActiveCamera();
    CameraState state;
    camera->GetPosition(state.position.data());
    camera->GetFocalPoint(state.focus.data());
    camera->GetViewUp(state.up.data());
    state.scale = camera->GetParallelScale();
    state.keeps_fitted = keeps_fitted_ && fitted_camera_time_ == camera->GetMTime();
    state.fitted_size = fitted_size_;
    state.fitted_margin = fitted_margin_;
    return state;
}

void CameraControl::set_state(const CameraState& state) {
    vtkCamera* camera = renderer_->GetActiveCamera();
    place(camera, vector(state.focus.data()), vector(state.position.data()), vector(state.up.data()));
    camera->SetParallelScale(state.scale);
    keeps_fitted_ = state.keeps_fitted;
    fitted_size_ = state.fitted_size;
    fitted_margin_ = state.fitted_margin;
    fitted_camera_time_ = camera->GetMTime();
}

void CameraControl::prepare_frame() {
    vtkCamera* camera = renderer_->GetActiveCamera();
    if (fitted_camera_time_ != camera->GetMTime()) keeps_fitted_ = false;
    if (keeps_fitted_ && (fitted_size_ != viewport() || fitted_margin_ != right_margin_)) fit();
    update_projection();
    // Nearest and farthest of the box's corners along the view, with some room.
    const Eigen::Vector3d forward = vector(camera->GetDirectionOfProjection());
    const Eigen::Vector3d eye = vector(camera->GetPosition());
    double nearest = std::numeric_limits<double>::infinity(), farthest = -nearest;
    for (int corner = 0; corner < 8; ++corner) {
        const Eigen::Vector3d x((corner & 1 ? high_ : low_)[0], (corner & 2 ? high_ : low_)[1],
                                (corner & 4 ? high_ : low_)[2]);
        nearest = std::min(nearest, forward.dot(x - eye));
        farthest = std::max(farthest, forward.dot(x - eye));
    }
    const double room = 0.02 + 0.05 * (farthest - nearest);
    farthest = std::max(farthest + room, 1e-6);
    nearest = is_parallel() ? nearest - room : std::max(nearest - room, 5e-4 * farthest);
    camera->SetClippingRange(nearest, farthest);
    if (keeps_fitted_) fitted_camera_time_ = camera->GetMTime();
}

ViewMetrics CameraControl::metrics(double pixel_ratio) const {
    vtkCamera* camera = renderer_->GetActiveCamera();
    ViewMetrics view;
    view.size = viewport();
    view.pixel_ratio = pixel_ratio;
    view.is_parallel = is_parallel();
    view.pixel_scale = 0.5 * view.size[1] / (is_parallel() ? camera->GetParallelScale() : slope());
    const double aspect = static_cast<double>(view.size[0]) / view.size[1];
    const vtkMatrix4x4* matrix = camera->GetCompositeProjectionTransformMatrix(aspect, -1.0, 1.0);
    for (int i = 0; i < 4; ++i)
        for (int j = 0; j < 4; ++j) view.world_to_clip(i, j) = matrix->GetElement(i, j);
    return view;
}

double CameraControl::distance() const {
    return renderer_->GetActiveCamera()->GetDistance();
}

Eigen::Matrix3d CameraControl::axes() const {
    return camera_axes(renderer_->GetActiveCamera());
}

Eigen::Vector3d CameraControl::unproject(double x, double y, double depth) const {
    const ViewMetrics view = metrics(1.0);
    const Eigen::Vector4d clip(2.0 * x / view.size[0] - 1.0, 2.0 * y / view.size[1] - 1.0, depth, 1.0);
    const Eigen::Vector4d world = view.world_to_clip.inverse() * clip;
    return world.head<3>() / world[3];
}

double CameraControl::focal_depth() const {
    return metrics(1.0).project(vector(renderer_->GetActiveCamera()->GetFocalPoint()).transpose())[2];
}

void CameraControl::pan(double from_x, double from_y, double to_x, double to_y) {
    vtkCamera* camera = renderer_->GetActiveCamera();
    const double depth = focal_depth();
    const Eigen::Vector3d shift = unproject(from_x, from_y, depth) - unproject(to_x, to_y, depth);
    place(camera, vector(camera->GetFocalPoint()) + shift, vector(camera->GetPosition()) + shift,
          vector(camera->GetViewUp()));
}

void CameraControl::rotate(double pixels_x, double pixels_y) {
    if (is_flat_) return;
    vtkCamera* camera = renderer_->GetActiveCamera();
    const auto [width, height] = viewport();
    const double degrees_per_pixel = 200.0 / std::min(width, height);
    camera->Azimuth(-degrees_per_pixel * pixels_x);
    camera->Elevation(-degrees_per_pixel * pixels_y);
    camera->OrthogonalizeViewUp();
}

void CameraControl::zoom(double factor, double x, double y, const std::optional<double>& depth) {
    vtkCamera* camera = renderer_->GetActiveCamera();
    const Eigen::Vector3d fixed = unproject(x, y, depth.value_or(focal_depth()));
    Eigen::Vector3d focal = vector(camera->GetFocalPoint()), position = vector(camera->GetPosition());
    if (is_parallel()) {
        const double scale = std::clamp(camera->GetParallelScale() / factor, 1e-7, 1e2);
        const double ratio = scale / camera->GetParallelScale();
        Eigen::Vector3d shift = (1.0 - ratio) * (fixed - focal);
        if (is_flat_) shift[2] = 0.0;
        camera->SetParallelScale(scale);
        place(camera, focal + shift, position + shift, vector(camera->GetViewUp()));
        return;
    }
    const double distance = std::clamp(camera->GetDistance() / factor, 1e-5, 1e2);
    const double ratio = distance / camera->GetDistance();
    focal = fixed + ratio * (focal - fixed);
    position = fixed + ratio * (position - fixed);
    place(camera, focal, position, vector(camera->GetViewUp()));
}

void CameraControl::copy_view(const CameraControl& other, const WorldFrame& theirs, const WorldFrame& ours,
                              bool is_exact) {
    vtkCamera* camera = renderer_->GetActiveCamera();
    vtkCamera* source = other.renderer_->GetActiveCamera();
    const double scale = theirs.size / ours.size;
    const auto convert = [&](const double* x) {
        const Eigen::RowVector3d world = vector(x).transpose();
        return Eigen::Vector3d(ours.to_world(world * theirs.size + theirs.origin).transpose());
    };
    place(camera, convert(source->GetFocalPoint()), convert(source->GetPosition()), vector(source->GetViewUp()));
    camera->SetParallelScale(source->GetParallelScale() * scale);
    if (is_parallel() != other.is_parallel()) {
        const Eigen::Vector3d focal = vector(camera->GetFocalPoint());
        const double distance = is_parallel() ? parallel_distance : camera->GetParallelScale() / slope();
        if (is_parallel()) camera->SetParallelScale(camera->GetDistance() * slope());
        place(camera, focal, focal + distance * camera_axes(camera).col(2), vector(camera->GetViewUp()));
    }
    keeps_fitted_ = !is_exact && other.keeps_fitted_ && other.fitted_camera_time_ == source->GetMTime();
    fitted_size_ = {0, 0};
    fitted_camera_time_ = camera->GetMTime();
}

}  // namespace curvewright
