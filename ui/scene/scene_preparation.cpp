#include "ui/scene/scene_preparation.h"

namespace curvewright {

ScenePreparation::ScenePreparation(SceneContent content, const MeshDrawing& shown) {
    if (!content.mesh) {
        drawing_ = std::make_unique<MeshDrawing>();
    } else {
        const bool has_same_topology =
            shown.has_mesh() && content.mesh->shared_topology() == shown.mesh().shared_topology();
        std::optional<WorldFrame> frame = content.frame;
        if (!frame && has_same_topology) frame = shown.frame();
        drawing_ = std::make_unique<MeshDrawing>(std::move(content.mesh), std::move(content.quality), frame);
    }
    drawing_->options = std::move(content.options);
    drawing_->painter.set_coloring(content.coloring);
    drawing_->highlighted = std::move(content.highlighted);
    if (drawing_->has_mesh() && shown.has_mesh() &&
        drawing_->mesh().shared_topology() == shown.mesh().shared_topology() &&
        has_same_pieces(drawing_->options, shown.options) &&
        drawing_->painter.is_on_nodes() == shown.painter.is_on_nodes()) {
        drawing_->take_pieces(shown);
        may_move_ = true;
    }
}

void ScenePreparation::run() {
    if (!drawing_->has_mesh()) return;
    drawing_->make(may_move_);
    content_ = drawing_->camera_content();
    labels_ = drawing_->number_labels();
}

}  // namespace curvewright
