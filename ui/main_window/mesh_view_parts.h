#pragma once

// What the files of MeshView share, and nobody else includes.

#include <array>
#include <exception>
#include <thread>

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

#include "ui/main_window/deferring_window.h"
#include "ui/main_window/mesh_view.h"
#include "ui/scene/scene_preparation.h"
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

/// A frame that is drawn while the event loop goes on.
struct FrameBehind {
    DrawingMode mode = DrawingMode::automatic;
    bool is_slow = false;       ///< the last picture took long
    bool is_scheduled = false;  ///< to begin
    bool is_pending = false;    ///< begun, not known to be finished
    bool is_finished = false;   ///< but not shown yet
    bool is_restless = false;   ///< frames of a drag or of steps come: each is drawn as a whole, that is quicker
    bool is_mixed = false;      ///< what is shown has changed since it was begun: it is begun again
    QSize drawn_size;           ///< of the picture that there is, device pixels; none = there is none
    GLsync fence = nullptr;
    QTimer poll;
    QElapsedTimer clock;
    QPointer<QWidget> held_window;  ///< whose repaints wait for the frame
    bool has_held = false;          ///< a repaint of it

    bool is_on() const { return mode == DrawingMode::behind || (mode == DrawingMode::automatic && is_slow); }
};

/// A drawing that is being made on another thread, then handed to the graphics.
struct PreparationWork {
    ScenePreparation preparation;
    MeshState state;
    std::exception_ptr problem;
    bool is_made = false;
};

/// What of a view is being prepared on another thread.
struct PreparingBehind {
    struct LateFrame {
        Coordinates positions;
        std::shared_ptr<const QualityReport> quality;
    };
    std::shared_ptr<PreparationWork> work;  ///< being made, or being handed to the graphics
    std::jthread thread;
    std::vector<std::pair<std::shared_ptr<PreparationWork>, std::jthread>> left_over;  ///< what nobody wants any more
    SceneOptions options;                                                              ///< of the work
    bool is_outdated = false;             ///< there is more to be prepared than the work
    std::optional<LateFrame> late_frame;  ///< of a motion, that came meanwhile
    QTimer explain;
    bool is_told = false;  ///< that it takes long
};

struct MeshView::Parts {
    MeshScene scene;
    vtkNew<DeferringRenderWindow> window;
    vtkNew<vtkGenericRenderWindowInteractor> interactor;
    vtkNew<vtkCallbackCommand> events;
    QOpenGLFunctions_3_2_Core* gl = nullptr;
    MeshState state;   ///< that the scene shows
    MeshState wanted;  ///< that it is to show
    PreparingBehind preparing;
    SceneOptions options;
    Coloring coloring;
    ColorScale wanted_scale;  ///< while that is being prepared
    std::vector<Index> highlighted;
    QVariantAnimation flight;
    CameraPose told_pose;                         ///< that camera_moved() told last, or that was taken over
    std::vector<std::pair<int, QTimer*>> timers;  ///< of the interactor, by platform id
    QPointF press_position;
    int wheel_turned = 0;  ///< eighths of a degree since the last step of the zoom
    bool is_stale = true;
    bool is_being_resized = false;
    FrameBehind behind;
    int largest_picture_side = 0;  ///< pixels that the graphics can draw; 0: there are no graphics yet
    bool may_be_click = false;
    bool legend_has_mouse = false;  ///< between a press on the legend and its release
    QPointer<Tool> tool;
    bool tool_has_mouse = false;  ///< between a press that the tool took and its release
};

}  // namespace curvewright
