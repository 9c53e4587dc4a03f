#pragma once

#include <memory>
#include <optional>
#include <vector>

#include <vtkNew.h>

#include "core/quality/quality.h"
#include "ui/scene/overlay_text.h"
#include "ui/scene/view_metrics.h"

class vtkActor2D;
class vtkCellArray;
class vtkPoints;
class vtkPolyData;
class vtkUnsignedCharArray;

namespace curvewright {

/// The colours of the scaled Jacobian at the right of the view: a bar from 0 to 1, below it the alarm colour (and that
/// of undecided elements, if there are any), and a marker at the mesh's minimum.
class Legend {
  public:
    explicit Legend(vtkRenderer* renderer);
    ~Legend();
    Legend(const Legend&) = delete;
    Legend& operator=(const Legend&) = delete;

    /// No summary: nothing is drawn.
    void set_summary(const std::optional<QualitySummary>& summary) { summary_ = summary; }
    void set_colors(const Color& background, const Color& foreground);
    void set_visible(bool is_visible) { is_visible_ = is_visible; }
    /// Width of the strip that the view should leave free, device pixels.
    double width(double pixel_ratio) const;
    /// Before every frame.
    void update(const ViewMetrics& view);

  private:
    struct Box {
        double left, bottom, right, top;
    };
    void begin();
    void add_polygon(const std::vector<std::array<double, 2>>& corners, const Color& color, double opacity = 1.0);
    void add_box(const Box& box, const Color& color, double opacity = 1.0);
    void add_frame(const Box& box, double line);
    void add_hatch(const Box& box, double ratio);
    void add_dots(const Box& box, double ratio);
    void draw_marker(double left, double height, double ratio);
    OverlayText& next_text();
    void finish();

    vtkRenderer* renderer_;
    std::optional<QualitySummary> summary_;
    bool is_visible_ = true;
    Color background_{1, 1, 1}, foreground_{0, 0, 0};
    vtkNew<vtkActor2D> actor_;
    vtkNew<vtkPolyData> data_;
    vtkNew<vtkPoints> points_;
    vtkNew<vtkCellArray> cells_;
    vtkNew<vtkUnsignedCharArray> colors_;
    std::vector<std::unique_ptr<OverlayText>> texts_;
    std::size_t used_texts_ = 0;
};

}  // namespace curvewright
