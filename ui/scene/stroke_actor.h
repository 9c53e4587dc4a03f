#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include <vtkNew.h>
#include <vtkSmartPointer.h>

#include "core/tessellate/plane_cut.h"
#include "ui/palette/quality_colors.h"
#include "ui/scene/upload_mapper.h"
#include "ui/scene/view_metrics.h"

class vtkActor;
class vtkFloatArray;
class vtkPolyData;

namespace curvewright {

/// Polylines to be stroked.
struct Polylines {
    std::vector<float> points;      ///< 3 per point
    std::vector<Index> offsets{0};  ///< polyline k is the points offsets[k] .. offsets[k+1] - 1
    /// Per polyline, optional: distance to its neighbours in the unit of the points; see StrokeStyle::fades.
    std::vector<float> spacing;
    /// Per polyline, optional: its own colour (otherwise that of the style).
    std::vector<Color> colors;

    void add(const std::vector<std::array<double, 3>>& line);
    /// The curves of a section that are wanted, by their number. origin: of the points that are here. The spacing, if
    /// there is one for the lines before, has to be added by the caller.
    void add_section(const PlaneCut& section, const Eigen::RowVector3d& origin,
                     const std::function<bool(std::size_t line)>& is_wanted);
    Index count() const { return static_cast<Index>(offsets.size()) - 1; }
};

struct StrokeStyle {
    Color color{0.0, 0.0, 0.0};
    double opacity = 1.0;
    double width = 1.0;       ///< units of the pixel ratio
    double cap = 0.5;         ///< how far ends reach beyond the last point, in half widths
    double dash = 0.0;        ///< period of dots, units of the pixel ratio; 0 = solid
    double depth_bias = 0.0;  ///< towards the eye, in units of the depth range (2)
    bool is_on_top = false;   ///< drawn over everything, within 0.005 of depth 0.01: a bias of 0.01 is over all others
    bool fades = false;       ///< thinner and paler where the spacing of the lines is a few pixels only
    bool is_in_pixels = false;  ///< points are display positions in device pixels instead of mesh coordinates
};

/// Lines of constant width on the screen with smooth edges: every polyline is a ribbon that the vertex shader turns to
/// the eye. Unlike GL lines they look the same with every driver, with and without multisampling.
class StrokeActor {
  public:
    StrokeActor();
    ~StrokeActor();
    StrokeActor(const StrokeActor&) = delete;
    StrokeActor& operator=(const StrokeActor&) = delete;

    vtkActor* actor() const { return actor_; }
    bool is_empty() const { return offsets_.back() == 0; }
    /// length_unit: size of the unit of the points in the world (or 1 for pixels).
    void set_lines(const Polylines& lines, double length_unit);
    void clear() { set_lines({}, 1.0); }
    /// The same lines elsewhere; spacing, colours and the places of dots stay. points: 3 per point, as many as before.
    void move_lines(const std::vector<float>& points);
    /// What lies beyond the plane is left out; none: nothing is. origin: of the points.
    void set_cut(const std::optional<CuttingPlane>& plane, const Eigen::RowVector3d& origin, double mesh_size);
    void set_style(const StrokeStyle& style);
    const StrokeStyle& style() const { return style_; }
    /// Before every frame.
    void update(const ViewMetrics& view);

  private:
    StrokeStyle style_;
    std::vector<Index> offsets_{0};  ///< of the lines
    vtkSmartPointer<vtkFloatArray> here_, previous_, next_;
    vtkNew<vtkActor> actor_;
    vtkNew<UploadMapper> mapper_;
    vtkNew<vtkPolyData> data_;
};

}  // namespace curvewright
