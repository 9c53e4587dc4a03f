#pragma once

#include <Eigen/Core>

#include "core/deform/deformation.h"

namespace curvewright {

Eigen::RowVector3d to_point(const Vector3& v);

/// Projections of one point onto a shape. Each throws InvalidInput (without naming the node) when the projection is not
/// defined there, for instance on the centre of a circle.
Eigen::RowVector3d project(const SnapToCircle& shape, const Eigen::RowVector3d& x);
Eigen::RowVector3d project(const SnapToSphere& shape, const Eigen::RowVector3d& x);
Eigen::RowVector3d project(const SnapToCylinder& shape, const Eigen::RowVector3d& x);
Eigen::RowVector3d project(const SnapToRevolution& shape, const Eigen::RowVector3d& x);
Eigen::RowVector3d project(const SnapToEllipse& shape, const Eigen::RowVector3d& x);
Eigen::RowVector3d project(const SnapToNaca& shape, const Eigen::RowVector3d& x);

}  // namespace curvewright
