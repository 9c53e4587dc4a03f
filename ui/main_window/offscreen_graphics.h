#pragma once

#include <QOffscreenSurface>
#include <QOpenGLContext>

#include <vtkCallbackCommand.h>
#include <vtkNew.h>

#include "ui/main_window/deferring_window.h"

namespace curvewright {

/// A render window of VTK with a context of its own that nobody sees. For the window's thread.
class OffscreenGraphics {
  public:
    OffscreenGraphics();
    ~OffscreenGraphics();
    OffscreenGraphics(const OffscreenGraphics&) = delete;
    OffscreenGraphics& operator=(const OffscreenGraphics&) = delete;

    bool is_ready() const { return is_ready_; }
    bool make_current() { return is_ready_ && context_.makeCurrent(&surface_); }
    void done_current() { context_.doneCurrent(); }
    QOpenGLContext& context() { return context_; }
    DeferringRenderWindow* window() { return window_; }
    /// Pixels that a side of a picture can have.
    int largest_side() const { return largest_side_; }

  private:
    QOffscreenSurface surface_;
    QOpenGLContext context_;
    vtkNew<vtkCallbackCommand> events_;
    vtkNew<DeferringRenderWindow> window_;
    bool is_ready_ = false;
    int largest_side_ = 0;
};

}  // namespace curvewright
