#pragma once

#include <functional>

#include <vtkInteractorStyle.h>

#include "ui/scene/camera_control.h"

namespace curvewright {

/// How the mouse moves the camera. 2D: any drag pans, the wheel zooms to the pointer. 3D: left or right drag turns,
/// middle or shift + left drag pans, the wheel zooms to the pointer. No keys.
class SceneInteractorStyle : public vtkInteractorStyle {
  public:
    static SceneInteractorStyle* New();

    /// depth_at: depth of what is drawn at a display position, if there is anything. camera null: does nothing any
    /// more.
    void connect(CameraControl* camera, std::function<std::optional<double>(double x, double y)> depth_at);

    void OnLeftButtonDown() override;
    void OnLeftButtonUp() override;
    void OnMiddleButtonDown() override;
    void OnMiddleButtonUp() override;
    void OnRightButtonDown() override;
    void OnRightButtonUp() override;
    void OnMouseMove() override;
    void OnMouseWheelForward() override;
    void OnMouseWheelBackward() override;
    void OnChar() override {}
    void OnKeyPress() override {}
    void OnKeyRelease() override {}

  private:
    enum class Drag { none, pan, rotate };
    void begin(Drag drag);
    void end();
    void zoom(double factor);
    void redraw();

    CameraControl* camera_ = nullptr;
    std::function<std::optional<double>(double, double)> depth_at_;
    Drag drag_ = Drag::none;

    vtkTypeMacro(SceneInteractorStyle, vtkInteractorStyle)
};

}  // namespace curvewright
