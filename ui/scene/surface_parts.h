#pragma once

#include <array>
#include <functional>
#include <optional>
#include <vector>

#include "core/tessellate/plane_cut.h"
#include "core/tessellate/tessellation.h"
#include "ui/palette/color_map.h"
#include "ui/scene/surface_actor.h"
#include "ui/scene/view_metrics.h"

class vtkActor;

namespace curvewright {

/// The surface of a tessellation in several actors, so that none takes long to hand to the graphics or to draw. They
/// draw the triangles in their order, so the picture is that of one.
class SurfaceParts {
  public:
    /// Of so few triangles all are the first one's.
    static inline std::size_t few_triangles = 20000;

    std::vector<vtkActor*> actors() const;
    /// is_new: the connectivity is not that of the call before.
    void set_surface(const Tessellation& tessellation, bool is_new);
    bool is_empty() const { return parts_.front().is_empty(); }
    /// See SurfaceActor.
    void set_colors(const Tessellation& tessellation, const std::function<Color(Index element)>& color_of);
    void set_field(const std::vector<double>& values, const ColorScale& scale);
    void set_cut(const std::optional<CuttingPlane>& plane, const Eigen::RowVector3d& origin, double mesh_size);
    void set_lit(bool is_lit);
    void place(const WorldFrame& frame, const Eigen::RowVector3d& origin);
    void update(const ViewMetrics& view);

  private:
    std::array<SurfaceActor, 6> parts_;
};

}  // namespace curvewright
