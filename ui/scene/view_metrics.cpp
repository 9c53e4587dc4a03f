#include "ui/scene/view_metrics.h"

#include <vtkActor.h>

namespace curvewright {

void WorldFrame::place(vtkActor* actor, const Eigen::RowVector3d& points_origin) const {
    const Eigen::RowVector3d position = to_world(points_origin);
    actor->SetPosition(position[0], position[1], position[2]);
    actor->SetScale(1.0 / size);
}

Eigen::Vector4d ViewMetrics::project(const Eigen::RowVector3d& world) const {
    const Eigen::Vector4d clip = world_to_clip * Eigen::Vector4d(world[0], world[1], world[2], 1.0);
    const double w = clip[3];
    return {0.5 * (clip[0] / w + 1.0) * size[0], 0.5 * (clip[1] / w + 1.0) * size[1], clip[2] / w, w};
}

}  // namespace curvewright
