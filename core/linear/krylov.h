#pragma once

#include "core/base/task.h"
#include "core/linear/multilevel.h"

namespace curvewright {

/// When a Krylov method stops.
struct KrylovOptions {
    double tolerance = 1e-12;  ///< of the residual relative to the right-hand side, in the 2-norm
    int max_iterations = 500;
};

/// How a Krylov method ended.
struct KrylovResult {
    int iterations = 0;     ///< largest over the right-hand sides
    double residual = 0.0;  ///< largest relative residual, computed from the solution
    bool has_converged =
        false;  ///< all right-hand sides reached the tolerance (a factor of ten is allowed for rounding)
};

/// Solves matrix x = b for all columns of b (1 to 4) at once, from zero: every pass over the matrix serves them all.
/// Conjugate gradients for a symmetric positive definite matrix, BiCGSTAB (van der Vorst 1992) otherwise, both with the
/// preconditioner. Restarts from the true residual when rounding has made the updated one wrong. Progress is reported
/// as "Solving". Same result for every thread count. Throws Cancelled.
KrylovResult solve_krylov(const BlockMatrix& matrix, bool is_symmetric, const MultilevelPreconditioner& preconditioner,
                          const MultiVector& b, MultiVector& x, const KrylovOptions& options,
                          const TaskContext& context);

}  // namespace curvewright
