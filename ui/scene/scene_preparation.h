#pragma once

#include <memory>
#include <vector>

#include "ui/scene/coloring.h"
#include "ui/scene/mesh_drawing.h"
#include "ui/scene/scene_options.h"

namespace curvewright {

/// All that a scene shows of a mesh. No mesh: nothing.
struct SceneContent {
    std::shared_ptr<const CurvedMesh> mesh;
    std::shared_ptr<const QualityReport> quality;  ///< of this very mesh; null = neutral colours
    SceneOptions options;
    Coloring coloring;
    std::vector<Index> highlighted;   ///< outlined elements
    std::optional<WorldFrame> frame;  ///< where it stands; none: as what is shown, if that is the same mesh
};

/// A drawing that a scene is to show later: MeshScene::prepare begins it, run() makes it, and MeshScene::show takes it
/// over. The scene goes on undisturbed meanwhile.
class ScenePreparation {
  public:
    /// Makes the drawing, on any thread, while nobody else uses this object.
    void run();

  private:
    friend class MeshScene;
    /// shown: of the scene now; of another state of the same mesh it lends its pieces.
    ScenePreparation(SceneContent content, const MeshDrawing& shown);

    std::unique_ptr<MeshDrawing> drawing_;
    std::vector<float> content_;  ///< of the camera
    std::vector<NumberLabel> labels_;
    bool may_move_ = false;
    std::size_t uploaded_ = 0;  ///< actors
};

}  // namespace curvewright
