#pragma once

#include <vtkGenericOpenGLRenderWindow.h>

namespace curvewright {

/// A render window in a context that Qt uses as well. Its frames can be begun without waiting for the graphics.
class DeferringRenderWindow : public vtkGenericOpenGLRenderWindow {
  public:
    static DeferringRenderWindow* New();
    vtkTypeMacro(DeferringRenderWindow, vtkGenericOpenGLRenderWindow)

    /// Draws, whatever state Qt has left the context in. waits: until it can be seen; otherwise Frame() is to follow.
    /// pre: the context is current.
    void draw(bool waits);
    void Frame() override;

  private:
    bool is_deferring_ = false;
};

}  // namespace curvewright
