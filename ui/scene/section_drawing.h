#pragma once

#include <array>
#include <memory>
#include <optional>

#include "core/mesh/curved_mesh.h"
#include "core/tessellate/plane_cut.h"
#include "ui/scene/coloring.h"
#include "ui/scene/stroke_actor.h"
#include "ui/scene/surface_actor.h"

namespace curvewright {

/// Where a plane cuts a solid open: its inside and the curves of the elements in it.
class SectionDrawing {
  public:
    std::array<vtkActor*, 2> actors() const { return {surface_.actor(), edges_.actor()}; }
    SurfaceActor& surface() { return surface_; }

    /// Null: nothing is cut.
    const PlaneCut* cut() const { return cut_.get(); }
    std::optional<CuttingPlane> plane() const { return cut_ ? std::optional(cut_->plane()) : std::nullopt; }
    /// visible: one flag per element; empty = all. The picture stays until draw().
    void find(const CurvedMesh& mesh, const CuttingPlane& plane, const std::vector<bool>& visible,
              const PlaneCutOptions& options);
    void forget() { cut_.reset(); }

    /// painter: has painted the mesh.
    void draw(const CurvedMesh& mesh, const SurfacePainter& painter, const WorldFrame& frame);
    void clear();
    void set_edge_style(const StrokeStyle& style) { edges_.set_style(style); }
    void show_edges(bool is_wanted);
    /// Before every frame.
    void update(const ViewMetrics& view);

  private:
    std::unique_ptr<PlaneCut> cut_;
    SurfaceActor surface_;
    StrokeActor edges_;
};

}  // namespace curvewright
