#pragma once

#include <string>

#include <Eigen/SparseCore>

#include "core/base/task.h"
#include "core/warp/warp.h"

namespace curvewright {

struct SolveReport {
    SolverChoice solver = SolverChoice::iterative;
    std::string note;
    int iterations = 0;
    double residual = 0.0;
};

/// Solves matrix × solution = right_hand_sides for all columns. iterative: BiCGSTAB (van der Vorst 1992), the columns
/// in parallel; the diagonal of the warp's matrices is 1, so Jacobi scaling is built in. direct: SparseLU with COLAMD
/// ordering. automatic: iterative, and direct if that does not reach the tolerance.
/// The iterative solver polls for cancellation at every iteration. A direct factorisation is abandoned when the caller
/// asks to stop: the call returns at once, and a detached thread runs the factorisation to its end and frees its
/// memory. Throws SolverFailure when no solver reaches a usable residual (1e-6), Cancelled.
Eigen::MatrixXd solve_linear(const Eigen::SparseMatrix<double, Eigen::RowMajor>& matrix,
                             const Eigen::MatrixXd& right_hand_sides, const WarpOptions& options, SolveReport& report,
                             const TaskContext& context);

}  // namespace curvewright
