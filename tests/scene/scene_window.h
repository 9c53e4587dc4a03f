#pragma once

#include <array>
#include <cmath>

#include <vtkCamera.h>
#include <vtkCommand.h>
#include <vtkGenericOpenGLRenderWindow.h>
#include <vtkNew.h>
#include <vtkRenderWindowInteractor.h>
#include <vtkRenderer.h>

#include "tests/scene/scene_meshes.h"
#include "ui/scene/mesh_scene.h"
#include "ui/scene/view_metrics.h"

namespace curvewright {

inline constexpr int width = 600, height = 400;

/// A scene in a window that is never drawn: the camera needs its size only.
struct Window {
    MeshScene scene;
    CurvedMesh mesh;
    QualityReport report;
    WorldFrame frame;
    vtkNew<vtkGenericOpenGLRenderWindow> window;
    vtkNew<vtkRenderWindowInteractor> interactor;

    explicit Window(const CurvedMesh& shown) : mesh(shown), report(make_report(shown, {})) {
        window->SetReadyForRendering(false);
        window->SetSize(width, height);
        window->AddRenderer(scene.renderer());
        interactor->SetRenderWindow(window);
        interactor->EnableRenderOff();
        scene.attach_interactor(interactor);
        scene.set_mesh(&mesh, &report);
        const auto box = bounding_box(mesh);
        frame = {0.5 * (box.row(0) + box.row(1)), (box.row(1) - box.row(0)).norm()};
        frame_start();
    }
    ~Window() { window->RemoveRenderer(scene.renderer()); }

    /// What a renderer does first in every frame.
    void frame_start() { scene.renderer()->InvokeEvent(vtkCommand::StartEvent); }

    std::array<double, 2> display(const Eigen::RowVector3d& point) {
        const Eigen::RowVector3d world = frame.to_world(point);
        scene.renderer()->SetWorldPoint(world[0], world[1], world[2], 1.0);
        scene.renderer()->WorldToDisplay();
        return {scene.renderer()->GetDisplayPoint()[0], scene.renderer()->GetDisplayPoint()[1]};
    }
    void at(double x, double y, bool shift = false) {
        interactor->SetEventInformation(static_cast<int>(std::lround(x)), static_cast<int>(std::lround(y)), 0, shift);
    }
    void drag(double from_x, double from_y, double to_x, double to_y, bool shift = false) {
        at(from_x, from_y, shift);
        interactor->InvokeEvent(vtkCommand::LeftButtonPressEvent);
        at(to_x, to_y, shift);
        interactor->InvokeEvent(vtkCommand::MouseMoveEvent);
        interactor->InvokeEvent(vtkCommand::LeftButtonReleaseEvent);
        frame_start();
    }
    std::array<double, 10> camera() {
        vtkCamera* its = scene.renderer()->GetActiveCamera();
        std::array<double, 10> values{};
        for (int d = 0; d < 3; ++d) {
            values[d] = its->GetPosition()[d];
            values[3 + d] = its->GetFocalPoint()[d];
            values[6 + d] = its->GetViewUp()[d];
        }
        values[9] = its->GetParallelScale();
        return values;
    }
};

}  // namespace curvewright
