#pragma once

#include <memory>

#include "ui/palette/marks.h"
#include "ui/scene/overlay_text.h"
#include "ui/scene/point_actor.h"
#include "ui/scene/stroke_actor.h"

class vtkRenderer;

namespace curvewright {

/// What tools draw over the mesh: nodes that are hovered, selected, softly selected or pinned; handles; rubber bands;
/// what explains a step of an untangling.
class MarkActors {
  public:
    explicit MarkActors(vtkRenderer* renderer);

    void set_marks(const Marks& marks, const WorldFrame& frame);
    /// Nodes beyond the plane are left out (handles are not).
    void set_cut(const std::optional<CuttingPlane>& plane, const WorldFrame& frame) {
        for (PointActor* points : {&small_, &pins_}) points->set_cut(plane, frame.origin, frame.size);
    }
    /// ground: of the view; accent: selection; ink: rubber bands and spokes.
    void set_colors(const Color& ground, const Color& accent, const Color& ink);
    void set_font(const TextFont& font) { font_ = font; }
    /// Before every frame.
    void update(const ViewMetrics& view);

  private:
    Color color_of(MarkRole role, double share) const;
    void draw();
    void place_texts(const ViewMetrics& view);

    /// A text with a halo of the ground's colour: it is written eight times around before it is written.
    struct Text {
        explicit Text(vtkRenderer* renderer);
        void hide();
        std::vector<OverlayText> halo;
        OverlayText text;
    };

    vtkRenderer* renderer_;
    TextFont font_;
    Marks marks_;
    std::vector<std::unique_ptr<Text>> texts_;
    WorldFrame frame_;
    Color ground_{1.0, 1.0, 1.0}, accent_{0.1, 0.4, 0.9}, ink_{0.1, 0.1, 0.1};
    PointActor small_, large_, pins_;
    StrokeActor halo_, lines_, thin_lines_, rubber_halo_, rubber_;
};

}  // namespace curvewright
