#pragma once

// What the files of MeshView share, and nobody else includes.

#include <array>

#include <QElapsedTimer>
#include <QOpenGLFunctions_3_2_Core>
#include <QPointer>
#include <QTimer>
#include <QVariantAnimation>

#include <vtkCallbackCommand.h>
#include <vtkCamera.h>
#include <vtkGenericOpenGLRenderWindow.h>
#include <vtkGenericRenderWindowInteractor.h>
#include <vtkNew.h>

#include "ui/main_window/mesh_view.h"
#include "ui/tools/tool.h"

namespace curvewright {

/// What a fly-to changes of a camera.
struct CameraPose {
    std::array<double, 3> position{}, focus{}, up{};
    double scale = 1.0;
    bool operator==(const CameraPose&) const = default;

    static CameraPose of(vtkCamera* camera) {
        CameraPose pose;
        camera->GetPosition(pose.position.data());
        camera->GetFocalPoint(pose.focus.data());
        camera->GetViewUp(pose.up.data());
        pose.scale = camera->GetParallelScale();
        return pose;
    }
    void apply(vtkCamera* camera) const {
        camera->SetPosition(position.data());
        camera->SetFocalPoint(focus.data());
        camera->SetViewUp(up.data());
        camera->SetParallelScale(scale);
    }
};

/// A render window whose frames can be left in the framebuffer that they are rendered to: taking them from there waits
/// until they are finished.
class DeferringRenderWindow : public vtkGenericOpenGLRenderWindow {
  public:
    static DeferringRenderWindow* New();
    vtkTypeMacro(DeferringRenderWindow, vtkGenericOpenGLRenderWindow)

    void set_deferring(bool is_deferring) { is_deferring_ = is_deferring; }
    void Frame() override {
        if (!is_deferring_) vtkGenericOpenGLRenderWindow::Frame();
    }

  private:
    bool is_deferring_ = false;
};

/// A frame that is drawn while the event loop goes on.
struct FrameBehind {
    DrawingMode mode = DrawingMode::automatic;
    bool is_slow = false;       ///< the last picture took long
    bool is_scheduled = false;  ///< to begin
    bool is_pending = false;    ///< begun, not known to be finished
    bool is_finished = false;   ///< but not shown yet
    bool must_wait = true;      ///< the next one, because there is no picture of the present size
    GLsync fence = nullptr;
    QTimer poll;
    QElapsedTimer clock;
    QPointer<QWidget> held_window;  ///< whose repaints wait for the frame
    bool has_held = false;          ///< a repaint of it

    bool is_on() const { return mode == DrawingMode::behind || (mode == DrawingMode::automatic && is_slow); }
};

struct MeshView::Parts {
    MeshScene scene;
    vtkNew<DeferringRenderWindow> window;
    vtkNew<vtkGenericRenderWindowInteractor> interactor;
    vtkNew<vtkCallbackCommand> events;
    QOpenGLFunctions_3_2_Core* gl = nullptr;
    MeshState state;  ///< keeps alive what the scene shows
    SceneOptions options;
    QVariantAnimation flight;
    CameraPose told_pose;                         ///< that camera_moved() told last, or that was taken over
    std::vector<std::pair<int, QTimer*>> timers;  ///< of the interactor, by platform id
    QPointF press_position;
    int wheel_turned = 0;  ///< eighths of a degree since the last step of the zoom
    bool is_stale = true;
    FrameBehind behind;
    int largest_picture_side = 0;  ///< pixels that the graphics can draw; 0: there are no graphics yet
    bool may_be_click = false;
    bool legend_has_mouse = false;  ///< between a press on the legend and its release
    QPointer<Tool> tool;
    bool tool_has_mouse = false;  ///< between a press that the tool took and its release
};

}  // namespace curvewright
