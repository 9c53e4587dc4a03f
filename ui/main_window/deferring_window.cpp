#include "ui/main_window/deferring_window.h"

#include <vtkObjectFactory.h>
#include <vtkOpenGLState.h>
#include <vtk_glew.h>

namespace curvewright {

vtkStandardNewMacro(DeferringRenderWindow);

void DeferringRenderWindow::draw(bool waits) {
    vtkOpenGLState* state = GetState();
    state->Reset();
    state->Push();
    // Qt leaves GL_LESS, with which what VTK draws flat and in order (the legend) hides itself.
    state->vtkglDepthFunc(GL_LEQUAL);
    // VTK does it where it clears the picture, which it does not do for further parts of a frame.
    state->vtkglEnable(GL_DEPTH_TEST);
    is_deferring_ = !waits;
    Render();
    is_deferring_ = false;
    state->Pop();
}

void DeferringRenderWindow::Frame() {
    if (!is_deferring_) vtkGenericOpenGLRenderWindow::Frame();
}

}  // namespace curvewright
