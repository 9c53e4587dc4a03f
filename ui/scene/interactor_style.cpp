#include "ui/scene/interactor_style.h"

#include <vtkCommand.h>
#include <vtkObjectFactory.h>
#include <vtkRenderWindowInteractor.h>

namespace curvewright {
namespace {

constexpr double wheel_step = 1.15;  ///< factor per notch

}  // namespace

vtkStandardNewMacro(SceneInteractorStyle);

void SceneInteractorStyle::connect(CameraControl* camera,
                                   std::function<std::optional<double>(double, double)> depth_at) {
    camera_ = camera;
    depth_at_ = std::move(depth_at);
}

void SceneInteractorStyle::begin(Drag drag) {
    if (!camera_ || drag_ != Drag::none) return;
    drag_ = drag;
    InvokeEvent(vtkCommand::StartInteractionEvent);
}

void SceneInteractorStyle::end() {
    if (drag_ == Drag::none) return;
    drag_ = Drag::none;
    InvokeEvent(vtkCommand::EndInteractionEvent);
    redraw();
}

void SceneInteractorStyle::OnLeftButtonDown() {
    if (!camera_) return;
    const bool pans = camera_->is_flat() || Interactor->GetShiftKey();
    begin(pans ? Drag::pan : Drag::rotate);
}

void SceneInteractorStyle::OnLeftButtonUp() {
    end();
}

void SceneInteractorStyle::OnRightButtonDown() {
    OnLeftButtonDown();
}

void SceneInteractorStyle::OnRightButtonUp() {
    end();
}

void SceneInteractorStyle::OnMiddleButtonDown() {
    begin(Drag::pan);
}

void SceneInteractorStyle::OnMiddleButtonUp() {
    end();
}

void SceneInteractorStyle::OnMouseMove() {
    if (!camera_ || drag_ == Drag::none) return;
    const int* to = Interactor->GetEventPosition();
    const int* from = Interactor->GetLastEventPosition();
    if (drag_ == Drag::pan)
        camera_->pan(from[0], from[1], to[0], to[1]);
    else
        camera_->rotate(to[0] - from[0], to[1] - from[1]);
    redraw();
}

void SceneInteractorStyle::OnMouseWheelForward() {
    zoom(wheel_step);
}

void SceneInteractorStyle::OnMouseWheelBackward() {
    zoom(1.0 / wheel_step);
}

void SceneInteractorStyle::zoom(double factor) {
    if (!camera_) return;
    const int* at = Interactor->GetEventPosition();
    camera_->zoom(factor, at[0], at[1], depth_at_ ? depth_at_(at[0], at[1]) : std::nullopt);
    redraw();
}

void SceneInteractorStyle::redraw() {
    InvokeEvent(vtkCommand::InteractionEvent);
    Interactor->Render();
}

}  // namespace curvewright
