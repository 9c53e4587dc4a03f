#pragma once

#include <array>
#include <memory>

#include "ui/scene/overlay_text.h"
#include "ui/scene/stroke_actor.h"

namespace curvewright {

/// Small labelled x, y, z axes in the lower left corner of the view.
class OrientationAxes {
  public:
    explicit OrientationAxes(vtkRenderer* renderer);

    /// Side of the square in the corner that they take up, device pixels; 0 if they are not shown.
    double size(double pixel_ratio) const;
    void set_visible(bool is_visible) { is_visible_ = is_visible; }
    void set_colors(const Color& background, const Color& foreground);
    /// Before every frame.
    void update(const ViewMetrics& view);

  private:
    vtkRenderer* renderer_;
    StrokeActor strokes_;
    std::array<std::unique_ptr<OverlayText>, 3> labels_;
    Color background_{1, 1, 1}, foreground_{0, 0, 0};
    bool is_visible_ = false;
};

}  // namespace curvewright
