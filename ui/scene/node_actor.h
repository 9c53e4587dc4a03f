#pragma once

#include <vtkNew.h>

#include "core/tessellate/tessellation.h"
#include "ui/palette/quality_colors.h"
#include "ui/scene/view_metrics.h"

class vtkActor;
class vtkOpenGLPolyDataMapper;
class vtkPolyData;

namespace curvewright {

/// The nodes of the drawn faces as round points: corners larger than the nodes of curved sides and interiors, nodes on
/// the mesh's boundary in a tone of their own.
class NodeActors {
  public:
    NodeActors();
    ~NodeActors();
    NodeActors(const NodeActors&) = delete;
    NodeActors& operator=(const NodeActors&) = delete;

    vtkActor* corners() const { return sets_[0].actor; }
    vtkActor* others() const { return sets_[1].actor; }
    void set_nodes(const CurvedMesh& mesh, const Tessellation& tessellation, const WorldFrame& frame);
    /// boundary, interior: fill of the points; rim: their outline.
    void set_colors(const Color& boundary, const Color& interior, const Color& rim);
    void set_visible(bool is_visible);
    /// Before every frame. spacing: typical distance of neighbouring corners, world units.
    void update(const ViewMetrics& view, double spacing, double distance);

  private:
    struct Set {
        vtkNew<vtkActor> actor;
        vtkNew<vtkOpenGLPolyDataMapper> mapper;
        vtkNew<vtkPolyData> data;
    };
    void set_up(Set& set);
    void color_points();

    Set sets_[2];  ///< corners, others
    std::vector<bool> is_boundary_[2];
    Color boundary_{}, interior_{};
    bool is_visible_ = false;
};

}  // namespace curvewright
