#include "ui/scene/interactor_style.h"

#include <cmath>

#include <vtkCommand.h>
#include <vtkObjectFactory.h>
#include <vtkRenderWindowInteractor.h>

namespace curvewright {
namespace {

constexpr double wheel_step = 1.15;  ///< factor per notch
constexpr double drag_zoom = 1.008;  ///< factor per pixel of a drag that zooms

}  // namespace

vtkStandardNewMacro(SceneInteractorStyle);

void SceneInteractorStyle::connect(CameraControl* camera,
                                   std::function<std::optional<double>(double, double)> depth_at) {
    camera_ = camera;
    depth_at_ = std::move(depth_at);
}

void SceneInteractorStyle::begin(const ButtonMotions& motions) {
    if (!camera_ || drag_) return;
    drag_ = Interactor->GetShiftKey()     ? motions.with_shift
            : Interactor->GetControlKey() ? motions.with_control
                                          : motions.alone;
    if (*drag_ == CameraMotion::turn && camera_->is_flat()) drag_ = CameraMotion::pan;
    const int* at = Interactor->GetEventPosition();
    pressed_at_ = {at[0], at[1]};
    InvokeEvent(vtkCommand::StartInteractionEvent);
}

void SceneInteractorStyle::end() {
    if (!drag_) return;
    drag_.reset();
    InvokeEvent(vtkCommand::EndInteractionEvent);
    redraw();
}

void SceneInteractorStyle::OnLeftButtonDown() {
    begin(map_.left);
}

void SceneInteractorStyle::OnLeftButtonUp() {
    end();
}

void SceneInteractorStyle::OnRightButtonDown() {
    begin(map_.right);
}

void SceneInteractorStyle::OnRightButtonUp() {
    end();
}

void SceneInteractorStyle::OnMiddleButtonDown() {
    begin(map_.middle);
}

void SceneInteractorStyle::OnMiddleButtonUp() {
    end();
}

void SceneInteractorStyle::OnMouseMove() {
    if (!camera_ || !drag_) return;
    const int* to = Interactor->GetEventPosition();
    const int* from = Interactor->GetLastEventPosition();
    switch (*drag_) {
        case CameraMotion::pan:
            camera_->pan(from[0], from[1], to[0], to[1]);
            break;
        case CameraMotion::turn:
            camera_->rotate(to[0] - from[0], to[1] - from[1]);
            break;
        case CameraMotion::zoom:
            zoom(std::pow(drag_zoom, to[1] - from[1]), pressed_at_);
            return;
    }
    redraw();
}

void SceneInteractorStyle::turn_by(double right, double up) {
    if (!camera_) return;
    if (camera_->is_flat())
        camera_->pan(0.0, 0.0, right, up);
    else
        camera_->rotate(right, up);
    redraw();
}

void SceneInteractorStyle::pan_by(double right, double up) {
    if (!camera_) return;
    camera_->pan(0.0, 0.0, right, up);
    redraw();
}

void SceneInteractorStyle::zoom_by(double factor) {
    if (!camera_) return;
    const int* size = Interactor->GetSize();
    camera_->zoom(factor, 0.5 * size[0], 0.5 * size[1], std::nullopt);
    redraw();
}

void SceneInteractorStyle::OnMouseWheelForward() {
    const int* at = Interactor->GetEventPosition();
    zoom(map_.wheel_is_reversed ? 1.0 / wheel_step : wheel_step, {at[0], at[1]});
}

void SceneInteractorStyle::OnMouseWheelBackward() {
    const int* at = Interactor->GetEventPosition();
    zoom(map_.wheel_is_reversed ? wheel_step : 1.0 / wheel_step, {at[0], at[1]});
}

void SceneInteractorStyle::zoom(double factor, std::array<int, 2> at) {
    if (!camera_) return;
    camera_->zoom(factor, at[0], at[1], depth_at_ ? depth_at_(at[0], at[1]) : std::nullopt);
    redraw();
}

void SceneInteractorStyle::redraw() {
    InvokeEvent(vtkCommand::InteractionEvent);
    Interactor->Render();
}

}  // namespace curvewright
