#pragma once

#include <vector>

#include "core/quality/quality.h"
#include "ui/scene/stroke_actor.h"
#include "ui/scene/surface_actor.h"

class vtkActor;

namespace curvewright {

/// What makes tangled and undecided elements stand out without any sense of colour: tangled ones are hatched and
/// outlined with a halo, and while they are only a few pixels large each has a ring of constant size; undecided ones
/// have a dotted outline.
class TangledMarks {
  public:
    TangledMarks();

    /// In the order in which they are drawn.
    std::vector<vtkActor*> actors() const;

    /// visible: one flag per element; empty = all. drawn: the surface of the visible elements. A tangled element that
    /// has no part in it lies inside the mesh: its ring is dotted and always there. section: where the mesh is cut,
    /// null = nowhere; elements beyond it have no marks.
    void set_mesh(const CurvedMesh& mesh, const QualityReport& quality, const std::vector<bool>& visible,
                  const Tessellation& drawn, const PlaneCut* section, const WorldFrame& frame);
    void clear();
    /// Before every frame.
    void update(const ViewMetrics& view);

  private:
    struct Mark {
        Eigen::RowVector3d center;  ///< world
        double radius = 0.0;        ///< world
        bool is_inside = false;     ///< hidden by other elements from every side
    };
    void draw_rings(const ViewMetrics& view);

    SurfaceActor hatched_, hatched_section_;
    StrokeActor halo_, outline_, undecided_halo_, undecided_, ring_halo_, ring_, inside_ring_;
    std::vector<Mark> marks_;  ///< of tangled elements, worst first
};

}  // namespace curvewright
