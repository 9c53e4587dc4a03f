#pragma once

#include <memory>
#include <vector>

#include <Eigen/Core>
#include <Eigen/SparseLU>

#include "core/base/task.h"
#include "core/linear/block_matrix.h"

namespace curvewright {

/// Algebraic multigrid by smoothed aggregation (Vanek, Mandel, Brezina, "Algebraic multigrid by smoothed aggregation
/// for second and fourth order elliptic problems", Computing 56, 1996): one V-cycle with Gauss-Seidel, forward before
/// the coarse grid and backward after it, so that it is symmetric for a symmetric matrix. The coarsest level is
/// factored. Sequential: it serves the vertices of a mesh, a small part of its nodes.
class AggregationMultigrid {
  public:
    /// matrix: nonsingular, entries of one node next to each other; block: unknowns per node. near_null: rows × k, the
    /// vectors that the matrix nearly annihilates away from the boundary (constants; rigid motions for elasticity).
    /// Throws Cancelled.
    AggregationMultigrid(SparseRows matrix, int block, Eigen::MatrixXd near_null, const TaskContext& context = {});
    ~AggregationMultigrid();
    AggregationMultigrid(AggregationMultigrid&&) noexcept;

    /// One cycle from zero for matrix x = b; b: rows × any.
    MultiVector apply(const MultiVector& b) const;
    int level_count() const;
    /// Stored entries of all levels over those of the first.
    double operator_complexity() const;

  private:
    struct Level;
    MultiVector cycle(std::size_t level, const MultiVector& b) const;

    std::vector<Level> levels_;
    std::unique_ptr<Eigen::SparseLU<Eigen::SparseMatrix<double>>> coarsest_;
};

}  // namespace curvewright
