#pragma once

#include <Eigen/Core>

#include "core/deform/deformation.h"

namespace curvewright {

/// The same vector as a row of coordinates.
Eigen::RowVector3d to_point(const Vector3& v);

/// Projection of one point onto a circle. Each of the projections throws InvalidInput (without naming the node) when it
/// is not defined there, for instance on the centre of a circle.
Eigen::RowVector3d project(const SnapToCircle& shape, const Eigen::RowVector3d& x);
/// Onto a sphere.
Eigen::RowVector3d project(const SnapToSphere& shape, const Eigen::RowVector3d& x);
/// Onto a cylinder.
Eigen::RowVector3d project(const SnapToCylinder& shape, const Eigen::RowVector3d& x);
/// Onto a surface of revolution.
Eigen::RowVector3d project(const SnapToRevolution& shape, const Eigen::RowVector3d& x);
/// Onto an ellipse.
Eigen::RowVector3d project(const SnapToEllipse& shape, const Eigen::RowVector3d& x);
/// Onto a NACA profile.
Eigen::RowVector3d project(const SnapToNaca& shape, const Eigen::RowVector3d& x);

}  // namespace curvewright
