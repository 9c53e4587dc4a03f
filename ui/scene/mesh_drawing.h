#pragma once

#include <array>
#include <chrono>
#include <memory>
#include <optional>
#include <vector>

#include "core/mesh/curved_mesh.h"
#include "core/quality/quality.h"
#include "core/tessellate/tessellation.h"
#include "ui/scene/coloring.h"
#include "ui/scene/node_actor.h"
#include "ui/scene/number_labels.h"
#include "ui/scene/picking.h"
#include "ui/scene/scene_options.h"
#include "ui/scene/section_drawing.h"
#include "ui/scene/stroke_actor.h"
#include "ui/scene/surface_parts.h"
#include "ui/scene/tangled_marks.h"

namespace curvewright {

/// What is drawn of one mesh in one state, with the colours, the cut and the outlined elements that it is drawn with:
/// the actors and what they were made of. Knows neither camera nor renderer, so it can be made on any thread; only one
/// at a time may use it, and once its actors are in a renderer that is the renderer's.
class MeshDrawing {
  public:
    /// frame: where the mesh stands in the world; of the mesh's own box if none.
    MeshDrawing(std::shared_ptr<const CurvedMesh> mesh, std::shared_ptr<const QualityReport> quality,
                const std::optional<WorldFrame>& frame);
    /// Without a mesh.
    MeshDrawing();

    /// In the order in which they are drawn.
    std::vector<vtkActor*> actors() const;

    // What it is drawn with. Set before make(); what has changed after it says what is to be done anew.
    SceneOptions options;
    SurfacePainter painter;
    std::vector<Index> highlighted;
    /// So many of a flat mesh are outlined each on its own; of more, the regions that they make. Sides of solids are
    /// drawn over each other, so that of more than a few only the rim on the mesh's surface is legible.
    static inline std::size_t most_outlined_singly = 10000, most_solids_outlined_singly = 40;

    bool has_mesh() const { return mesh_ != nullptr; }
    bool is_flat() const { return !mesh_ || mesh_->topology().dimension() < 3; }
    const CurvedMesh& mesh() const { return *mesh_; }
    const std::shared_ptr<const CurvedMesh>& shared_mesh() const { return mesh_; }
    const QualityReport* quality() const { return quality_.get(); }
    const WorldFrame& frame() const { return frame_; }
    const Tessellation& tessellation() const { return *tessellation_; }
    const PlaneCut* section() const { return section_.cut(); }
    std::optional<CuttingPlane> cutting_plane() const { return section_.plane(); }
    DrawnSurface drawn() const { return {*tessellation_, section_.cut()}; }

    /// Another state of the same mesh.
    void set_state(std::shared_ptr<const CurvedMesh> mesh, std::shared_ptr<const QualityReport> quality) {
        mesh_ = std::move(mesh);
        quality_ = std::move(quality);
    }
    /// Takes over the pieces of another drawing of the same topology, to be moved if nothing but positions differs.
    void take_pieces(const MeshDrawing& other);
    /// Everything anew; may_move: pieces that are there may be moved instead, if nothing but positions has changed.
    void make(bool may_move);
    /// The cut and all that depends on it.
    void make_cut();
    void paint();
    void make_highlight();
    void apply_styles();
    /// A frame of a motion: see MeshScene::show_frame. Returns false if everything had to be made anew.
    bool move(const Coordinates& positions, std::shared_ptr<const QualityReport> quality, double pixels_per_unit);

    /// What the camera is to have in view: 3 per point, world.
    std::vector<float> camera_content() const;
    /// Numbers of what is drawn, as the options say.
    std::vector<NumberLabel> number_labels() const;

    /// Before every frame. focal_distance: from the eye, world units.
    void update(const ViewMetrics& view, double focal_distance);

    std::optional<Pick> pick(const ViewMetrics& view, double x, double y) const;

  private:
    TessellationOptions tessellation_options() const;
    void move_pieces();
    void find_section(const CuttingPlane& plane);
    void draw_section();
    void show_edges(bool is_wanted);

    std::shared_ptr<const CurvedMesh> mesh_;
    std::shared_ptr<const QualityReport> quality_;
    WorldFrame frame_;
    std::vector<bool> visible_;
    std::shared_ptr<Tessellation> tessellation_;            ///< another drawing that is being made may read it
    double typical_spacing_ = 0.0;                          ///< world
    int fineness_part_ = 0;                                 ///< of the pieces, looked at last in a motion
    std::chrono::steady_clock::time_point next_section_{};  ///< of a motion

    SurfaceParts surface_;
    SectionDrawing section_;
    /// Several, so that none takes long to hand to the graphics or to draw.
    std::array<StrokeActor, 6> edges_;
    StrokeActor boundary_;
    StrokeActor interfaces_;  ///< over the edges that they are
    TangledMarks marks_;
    NodeActors nodes_;
    StrokeActor highlight_halo_, highlight_;
};

}  // namespace curvewright
