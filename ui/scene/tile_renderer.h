#pragma once

#include <vtkOpenGLRenderer.h>
#include <vtkSmartPointer.h>

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

    /// The next frame is drawn in parts, one per Render() of the window, so that each takes little time to hand over.
    /// All of them are seen from where the camera was for the first one. most_points: of the actors of a part, if one
    /// alone does not have more.
    void begin_parts(vtkIdType most_points);
    /// Gives up what is left of the frame: the next Render() draws all of one.
    void end_parts();
    /// Whether the frame that was begun has parts that are not drawn yet; but for the camera nothing of what is on the
    /// mesh may change until they are.
    bool has_more_parts() const { return is_in_parts_ && first_of_part_ > 0; }

    void GetTiledSizeAndOrigin(int* width, int* height, int* left, int* bottom) override {
        vtkOpenGLRenderer::GetTiledSizeAndOrigin(width, height, left, bottom);
        *left -= x_;
        *bottom -= y_;
    }

    void DeviceRender() override;
    int UpdateGeometry(vtkFrameBufferObjectBase* buffer) override;

  private:
    int x_ = 0, y_ = 0;
    bool is_in_parts_ = false;
    vtkIdType most_points_of_part_ = 0;
    int first_of_part_ = 0;                    ///< among the visible actors
    vtkSmartPointer<vtkCamera> first_camera_;  ///< a copy of that of the first part
};

}  // namespace curvewright
