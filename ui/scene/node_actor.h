#pragma once

#include <array>
#include <vector>

#include "core/tessellate/tessellation.h"
#include "ui/scene/point_actor.h"

namespace curvewright {

/// The nodes of the drawn faces as round points: corners larger than the nodes of curved sides and interiors, nodes on
/// the mesh's boundary in a tone of their own.
class NodeActors {
  public:
    /// As they are to be drawn: corners last.
    std::vector<vtkActor*> actors() const;
    void set_nodes(const CurvedMesh& mesh, const Tessellation& tessellation, const WorldFrame& frame);
    /// boundary, interior: fill of the points; rim: their outline.
    void set_colors(const Color& boundary, const Color& interior, const Color& rim);
    /// See PointActor::set_cut. origin: of the tessellation that they were set with.
    void set_cut(const std::optional<CuttingPlane>& plane, const Eigen::RowVector3d& origin, double mesh_size) {
        for (PointActor& set : sets_) set.set_cut(plane, origin, mesh_size);
    }
    void set_visible(bool is_visible);
    /// Before every frame. spacing: typical distance of neighbouring corners, world units.
    void update(const ViewMetrics& view, double spacing, double distance);

  private:
    void color_points();

    /// Corners, and the others in three parts, so that none takes long to hand to the graphics.
    std::array<PointActor, 4> sets_;
    std::array<std::vector<bool>, 4> is_boundary_;
    Color boundary_{0.0, 0.0, 0.0}, interior_{1.0, 1.0, 1.0};
    bool is_visible_ = false;
};

}  // namespace curvewright
