#pragma once

#include <Eigen/Core>

namespace curvewright {

/// Several vectors side by side: entries × vectors, row-major, so that one pass over a matrix serves them all.
using MultiVector = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

}  // namespace curvewright
