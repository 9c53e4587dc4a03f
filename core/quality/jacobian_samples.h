#pragma once

#include <Eigen/Core>

#include "core/basis/element_type.h"

namespace curvewright {

/// The map of an element and its Jacobian determinant at some points. For looking at; certificates are in quality.h.
struct JacobianSamples {
    Eigen::MatrixX3d positions;
    Eigen::VectorXd determinants;  ///< as numbered: not multiplied with the orientation's sign
};

/// x: nodes × 3. points: n × 3, reference coordinates. Flat elements: z is not read. Throws Unsupported for pyramids
/// and for lines.
JacobianSamples sample_jacobian(ElementType type, const Eigen::MatrixX3d& x, const Eigen::MatrixX3d& points);

}  // namespace curvewright
