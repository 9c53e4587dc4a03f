#include "ui/main_window/offscreen_graphics.h"

#include <vtkCommand.h>
#include <vtkRenderer.h>
#include <vtkRendererCollection.h>

#include "ui/main_window/picture_drawing.h"

namespace curvewright {

OffscreenGraphics::OffscreenGraphics() {
    surface_.create();
    is_ready_ = context_.create() && context_.makeCurrent(&surface_);
    if (!is_ready_) return;
    largest_side_ = largest_picture_side();
    events_->SetClientData(this);
    events_->SetCallback([](vtkObject*, unsigned long event, void* client, void* answer) {
        auto& own = *static_cast<OffscreenGraphics*>(client);
        if (event == vtkCommand::WindowMakeCurrentEvent) own.context_.makeCurrent(&own.surface_);
        if (event == vtkCommand::WindowIsCurrentEvent)
            *static_cast<bool*>(answer) = QOpenGLContext::currentContext() == &own.context_;
        if (event == vtkCommand::WindowSupportsOpenGLEvent || event == vtkCommand::WindowIsDirectEvent)
            *static_cast<int*>(answer) = 1;
    });
    for (const auto event : {vtkCommand::WindowMakeCurrentEvent, vtkCommand::WindowIsCurrentEvent,
                             vtkCommand::WindowSupportsOpenGLEvent, vtkCommand::WindowIsDirectEvent})
        window_->AddObserver(event, events_);
    window_->SetOwnContext(0);
    window_->SetFrameBlitModeToNoBlit();
    window_->SetMultiSamples(0);
    window_->SetForceMaximumHardwareLineWidth(1);
    window_->SetReadyForRendering(true);
    window_->SetMapped(1);
    window_->OpenGLInitContext();
    context_.doneCurrent();
}

OffscreenGraphics::~OffscreenGraphics() {
    if (!is_ready_) return;
    context_.makeCurrent(&surface_);
    window_->Finalize();
    window_->RemoveObserver(events_);
    while (vtkRenderer* renderer = window_->GetRenderers()->GetFirstRenderer()) window_->RemoveRenderer(renderer);
    context_.doneCurrent();
}

}  // namespace curvewright
