#include "core/quality/jacobian_samples.h"

#include <Eigen/LU>

#include "core/base/error.h"
#include "core/basis/lagrange.h"

namespace curvewright {

JacobianSamples sample_jacobian(ElementType type, const Eigen::MatrixX3d& x, const Eigen::MatrixX3d& points) {
    const int dim = dimension(type.shape);
    if (dim < 2) throw Unsupported("A " + name(type) + " has no Jacobian determinant.");
    const BasisTable basis = lagrange_basis(type, points);
    JacobianSamples samples{basis.values * x, Eigen::VectorXd(points.rows())};
    for (Eigen::Index point = 0; point < points.rows(); ++point) {
        Eigen::Matrix3d jacobian = Eigen::Matrix3d::Identity();
        for (int direction = 0; direction < dim; ++direction)
            jacobian.row(direction).head(dim) =
                (basis.gradients[static_cast<std::size_t>(direction)].row(point) * x).head(dim);
        samples.determinants[point] = jacobian.determinant();
    }
    return samples;
}

}  // namespace curvewright
