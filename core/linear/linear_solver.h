#pragma once

#include <memory>

#include "core/base/task.h"
#include "core/linear/block_matrix.h"
#include "core/linear/multilevel.h"
#include "core/linear/solver_options.h"

namespace curvewright {

/// matrix x = b, and what a multilevel method needs to know about it.
struct LinearSystem {
    BlockMatrix matrix;         ///< square
    bool is_symmetric = false;  ///< and positive definite
    CoarseSpace coarse;
    SweepOrder sweep;
};

/// A linear system made ready to be solved for many right-hand sides, now and later: the preconditioner or the
/// factorisation is made once and kept. iterative: Krylov methods with the multilevel preconditioner (see
/// solve_krylov). direct: SimplicialLDLT for symmetric, SparseLU for general matrices. automatic: direct for small
/// systems, iterative otherwise, and direct if that does not converge.
class LinearSolver {
  public:
    /// Makes the preconditioner or the factorisation. A factorisation is abandoned when the caller asks to stop: the
    /// call returns at once, and a detached thread ends the work and frees its memory. Throws SolverFailure, Cancelled.
    LinearSolver(LinearSystem system, const SolverOptions& options, const TaskContext& context = {});
    ~LinearSolver();
    LinearSolver(const LinearSolver&) = delete;

    /// b: (rows · block) × any number of right-hand sides. Safe to call from several threads at once.
    /// Throws SolverFailure when no solver reaches a usable residual (1e-6), Cancelled.
    MultiVector solve(const MultiVector& b, SolveReport& report, const TaskContext& context = {}) const;

    const BlockMatrix& matrix() const;

  private:
    class Implementation;
    std::unique_ptr<Implementation> implementation_;
};

}  // namespace curvewright
