#pragma once

#include <vtkOpenGLRenderer.h>

namespace curvewright {

/// A renderer that can draw a part of a picture that is larger than its window's framebuffer: all of the picture is its
/// viewport, and what of it is in the framebuffer begins at a pixel of it. The size of the picture is that of the
/// window with its tile scale; the tile viewport of the window stays whole.
class TileRenderer : public vtkOpenGLRenderer {
  public:
    static TileRenderer* New();
    vtkTypeMacro(TileRenderer, vtkOpenGLRenderer)

        void set_first_pixel(int x, int y) {
        x_ = x;
        y_ = y;
        Modified();
    }
    int first_x() const { return x_; }
    int first_y() const { return y_; }

    void GetTiledSizeAndOrigin(int* width, int* height, int* left, int* bottom) override {
        vtkOpenGLRenderer::GetTiledSizeAndOrigin(width, height, left, bottom);
        *left -= x_;
        *bottom -= y_;
    }

  private:
    int x_ = 0, y_ = 0;
};

}  // namespace curvewright
