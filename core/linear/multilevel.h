#pragma once

#include <optional>
#include <vector>

#include "core/base/task.h"
#include "core/linear/aggregation_multigrid.h"
#include "core/linear/block_matrix.h"

namespace curvewright {

/// A space of few unknowns in which the smooth part of a solution is well represented: for a mesh of order p, the
/// linear functions on its vertices.
struct CoarseSpace {
    SparseRows prolongation;  ///< block rows × coarse nodes, the same for each unknown of a node
    /// Block rows: factors that make the matrix nearly symmetric when its rows are multiplied with them; the
    /// restriction to the coarse space is the transposed prolongation times them. Empty = ones.
    Eigen::VectorXd row_scale;
    Eigen::MatrixXd near_null;  ///< (coarse nodes · block) × k, see AggregationMultigrid
};

/// The order of a Gauss-Seidel sweep: rows in their order, cut into pieces; consecutive pieces form a stage, within
/// which no two pieces are coupled, so that they can be swept at the same time. Empty = one piece.
struct SweepOrder {
    std::vector<Index> pieces;  ///< first row of every piece, then the number of rows
    std::vector<Index> stages;  ///< first piece of every stage, then the number of pieces
};

/// Preconditioner of two levels: Gauss-Seidel on all nodes (forward before, backward after the coarse correction), and
/// aggregation multigrid on the vertices. The number of Krylov iterations with it hardly depends on the number of
/// nodes. The sweeps are those of a single thread whatever the number of threads. Symmetric (positive definite) if the
/// matrix is.
class MultilevelPreconditioner {
  public:
    /// matrix must outlive this. Throws SolverFailure when a diagonal block is singular or pieces of a stage are
    /// coupled, Cancelled.
    MultilevelPreconditioner(const BlockMatrix& matrix, const CoarseSpace& coarse, SweepOrder order = {},
                             const TaskContext& context = {});

    /// z = approximate solution of matrix z = r. work: scratch that calls of one solve share.
    struct Workspace {
        MultiVector residual, restricted;
    };
    void apply(const MultiVector& r, MultiVector& z, Workspace& work, const TaskContext& context) const;

    /// "Gauss-Seidel and 3 levels over 4012 vertices".
    std::string description() const;

  private:
    const BlockMatrix& matrix_;
    SweepOrder order_;
    std::vector<double> inverse_diagonal_;  ///< rows · block²
    std::vector<std::size_t> diagonal_;     ///< per row: where its diagonal block is stored
    SparseRows prolongation_, restriction_;
    std::optional<AggregationMultigrid> coarse_;
};

}  // namespace curvewright
