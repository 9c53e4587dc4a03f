#pragma once

#include <array>
#include <functional>
#include <optional>

#include <vtkInteractorStyle.h>

#include "ui/scene/camera_control.h"
#include "ui/scene/mouse_map.h"

namespace curvewright {

/// How the mouse moves the camera: drags as the MouseMap says, the wheel zooms to the pointer. Keys do so through the
/// functions for them.
class SceneInteractorStyle : public vtkInteractorStyle {
  public:
    static SceneInteractorStyle* New();

    /// depth_at: depth of what is drawn at a display position, if there is anything. camera null: does nothing any
    /// more.
    void connect(CameraControl* camera, std::function<std::optional<double>(double x, double y)> depth_at);

    void set_mouse_map(const MouseMap& map) { map_ = map; }

    /// As a drag by so many device pixels would: to the right and up.
    void turn_by(double right, double up);
    void pan_by(double right, double up);
    /// factor > 1: closer to the middle of the view.
    void zoom_by(double factor);

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
    void begin(const ButtonMotions& motions);
    void end();
    void zoom(double factor, std::array<int, 2> at);
    void redraw();

    CameraControl* camera_ = nullptr;
    std::function<std::optional<double>(double, double)> depth_at_;
    MouseMap map_;
    std::optional<CameraMotion> drag_;
    std::array<int, 2> pressed_at_{};  ///< device pixels: what a zooming drag comes closer to

    vtkTypeMacro(SceneInteractorStyle, vtkInteractorStyle)
};

}  // namespace curvewright
