#pragma once

#include <optional>
#include <vector>

#include <vtkNew.h>

#include "core/tessellate/plane_cut.h"
#include "ui/palette/quality_colors.h"
#include "ui/scene/upload_mapper.h"
#include "ui/scene/view_metrics.h"

class vtkActor;
class vtkPolyData;

namespace curvewright {

/// Round points of constant size on the screen, each with a fill of its own and a common rim.
class PointActor {
  public:
    PointActor();
    ~PointActor();
    PointActor(const PointActor&) = delete;
    PointActor& operator=(const PointActor&) = delete;

    vtkActor* actor() const { return actor_; }
    /// points: 3 per point, mesh coordinates relative to `origin`.
    void set_points(const std::vector<float>& points, const Eigen::RowVector3d& origin, const WorldFrame& frame);
    /// One fill per point.
    void set_colors(const std::vector<Color>& colors);
    void set_rim(const Color& rim);
    /// Points beyond the plane are left out; none: none are. origin: of the points.
    void set_cut(const std::optional<CuttingPlane>& plane, const Eigen::RowVector3d& origin, double mesh_size);
    /// Drawn over everything.
    void set_on_top();
    bool is_empty() const;
    /// diameter: device pixels. Before every frame.
    void set_diameter(double diameter);

  private:
    vtkNew<vtkActor> actor_;
    vtkNew<UploadMapper> mapper_;
    vtkNew<vtkPolyData> data_;
};

}  // namespace curvewright
