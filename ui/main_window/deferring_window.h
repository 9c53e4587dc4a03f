#pragma once

#include <vtkGenericOpenGLRenderWindow.h>

namespace curvewright {

/// A render window whose frames can be left in the framebuffer that they are rendered to: taking them from there waits
/// until they are finished.
class DeferringRenderWindow : public vtkGenericOpenGLRenderWindow {
  public:
    static DeferringRenderWindow* New();
    vtkTypeMacro(DeferringRenderWindow, vtkGenericOpenGLRenderWindow)

        void set_deferring(bool is_deferring) {
        is_deferring_ = is_deferring;
    }
    void Frame() override {
        if (!is_deferring_) vtkGenericOpenGLRenderWindow::Frame();
    }

  private:
    bool is_deferring_ = false;
};

}  // namespace curvewright
