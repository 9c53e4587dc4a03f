#pragma once

#include <functional>
#include <optional>
#include <span>
#include <vector>

#include <vtkNew.h>

#include "core/tessellate/plane_cut.h"
#include "core/tessellate/tessellation.h"
#include "ui/palette/color_map.h"
#include "ui/scene/upload_mapper.h"
#include "ui/scene/view_metrics.h"

class vtkActor;
class vtkPolyData;

namespace curvewright {

/// Some of the triangles of a tessellation.
struct TriangleRange {
    std::size_t begin = 0, end = 0;
};

/// The surface of a tessellation or a part of it, one colour per element or those of a field; on request hatched with
/// stripes of constant width on the screen.
class SurfaceActor {
  public:
    SurfaceActor();
    ~SurfaceActor();
    SurfaceActor(const SurfaceActor&) = delete;
    SurfaceActor& operator=(const SurfaceActor&) = delete;

    vtkActor* actor() const { return actor_; }
    /// is_new: the triangles are not those of the call before.
    void set_surface(const Tessellation& tessellation, TriangleRange range, bool is_new);
    /// All of it.
    void set_surface(const Tessellation& tessellation, bool is_new);
    /// Which of the tessellation's points the triangles have.
    std::size_t first_point() const { return first_point_; }
    std::size_t point_count() const { return point_count_; }
    void set_colors(const Tessellation& tessellation, const std::function<Color(Index element)>& color_of);
    /// Instead of a tessellation: the section's inside, of the elements that are wanted. Returns the point of the
    /// section that each of the surface's points is.
    std::vector<Index> set_section(const PlaneCut& section, const std::function<bool(Index element)>& is_wanted,
                                   const std::function<Color(Index element)>& color_of);
    /// values: one per surface point, NaN = none; between the points they, not their colours, are interpolated.
    void set_field(std::span<const double> values, const ColorScale& scale);
    void clear();
    bool is_empty() const;
    /// What lies beyond the plane is left out; none: nothing is. origin: of the points.
    void set_cut(const std::optional<CuttingPlane>& plane, const Eigen::RowVector3d& origin, double mesh_size);

    /// Soft light from the eye (3D), or the colours as they are (2D).
    void set_lit(bool is_lit);
    void set_depth_bias(double bias);
    void set_hatch(const Color& color);
    /// Before every frame.
    void update(const ViewMetrics& view);

  private:
    void find_points(const Tessellation& tessellation);

    bool is_lit_ = false, is_hatched_ = false;
    TriangleRange range_;
    std::size_t first_point_ = 0, point_count_ = 0;
    vtkNew<vtkActor> actor_;
    vtkNew<UploadMapper> mapper_;
    vtkNew<vtkPolyData> data_;
};

}  // namespace curvewright
