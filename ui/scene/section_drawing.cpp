#include "ui/scene/section_drawing.h"

#include <utility>

#include <vtkActor.h>

#include "ui/scene/element_spacing.h"

namespace curvewright {

void SectionDrawing::find(const CurvedMesh& mesh, const CuttingPlane& plane, const std::vector<bool>& visible,
                          const PlaneCutOptions& options) {
    cut_ = std::make_unique<PlaneCut>(mesh, plane, visible, options);
}

void SectionDrawing::draw(const CurvedMesh& mesh, const SurfacePainter& painter, const WorldFrame& frame) {
    if (!cut_) {
        surface_.clear();
        edges_.clear();
        return;
    }
    surface_.set_lit(true);
    painter.paint_section(surface_, *cut_);
    frame.place(surface_.actor(), cut_->origin());
    Polylines lines;
    std::vector<Index> elements;
    lines.add_section(*cut_, cut_->origin(), [&](std::size_t line) {
        if (cut_->line_is_first()[line]) elements.push_back(cut_->line_elements()[line]);
        return cut_->line_is_first()[line] != 0;
    });
    lines.spacing = line_spacing(mesh, elements);
    edges_.set_lines(lines, 1.0 / frame.size);
    frame.place(edges_.actor(), cut_->origin());
}

void SectionDrawing::clear() {
    cut_.reset();
    surface_.clear();
    edges_.clear();
}

void SectionDrawing::show_edges(bool is_wanted) {
    edges_.actor()->SetVisibility(is_wanted && cut_ && !cut_->line_elements().empty());
}

void SectionDrawing::update(const ViewMetrics& view) {
    surface_.update(view);
    edges_.update(view);
}

}  // namespace curvewright
