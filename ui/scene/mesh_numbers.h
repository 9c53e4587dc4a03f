#pragma once

#include <vector>

#include "ui/scene/number_labels.h"
#include "ui/scene/picking.h"
#include "ui/scene/scene_options.h"

namespace curvewright {

/// Numbers of the drawn elements and nodes, as the options want them, where they belong.
std::vector<NumberLabel> find_number_labels(const CurvedMesh& mesh, const DrawnSurface& drawn, const WorldFrame& frame,
                                            const SceneOptions& options);

}  // namespace curvewright
