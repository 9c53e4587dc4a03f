#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <vtkNew.h>

#include "core/quality/quality.h"
#include "ui/palette/color_map.h"
#include "ui/scene/overlay_text.h"
#include "ui/scene/view_metrics.h"

class vtkActor2D;
class vtkCellArray;
class vtkPoints;
class vtkPolyData;
class vtkUnsignedCharArray;

namespace curvewright {

/// What a legend tells.
struct LegendContent {
    std::string title, detail;  ///< empty: those of the scaled Jacobian
    ColorScale scale;
    bool is_quality = true;    ///< the scaled Jacobian: with the colours outside of the map and a marker at the minimum
    bool has_bar = false;      ///< there are numbers to show
    bool has_missing = false;  ///< and places without
};

/// The colours at the right of the view: a bar with its range, and below it the alarm colour (and that of undecided
/// elements, if there are any). Of the scaled Jacobian a marker stands at the mesh's minimum.
class Legend {
  public:
    explicit Legend(vtkRenderer* renderer);
    ~Legend();
    Legend(const Legend&) = delete;
    Legend& operator=(const Legend&) = delete;

    void set_content(const LegendContent& content) { content_ = content; }
    /// No summary: nothing is known about the scaled Jacobian.
    void set_summary(const std::optional<QualitySummary>& summary) { summary_ = summary; }
    void set_colors(const Color& background, const Color& foreground);
    void set_font(const TextFont& font) { font_ = font; }
    void set_visible(bool is_visible) { is_visible_ = is_visible; }
    /// Width of the strip that the view should leave free, device pixels.
    double width(double pixel_ratio) const;
    /// Before every frame.
    void update(const ViewMetrics& view);
    /// Whether a display position is on what the last update drew.
    bool contains(double x, double y) const;

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
    /// Numbers beside the bar, but for those too near to `taken` (a height).
    void draw_ticks(const Box& bar, double line, std::optional<double> taken, double ratio);
    bool is_drawn() const;
    bool is_tangled() const {
        return summary_ && (summary_->invalid > 0 || (content_.is_quality && summary_->min <= 0.0));
    }
    OverlayText& next_text();
    void finish();

    vtkRenderer* renderer_;
    LegendContent content_;
    std::optional<QualitySummary> summary_;
    Box panel_{0, 0, 0, 0};
    bool is_visible_ = true;
    TextFont font_;
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
