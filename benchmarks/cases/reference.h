#pragma once

#include <Eigen/Core>

#include "benchmarks/cases/warp_case.h"

namespace curvewright::benchmarks {

/// How the KKT system of Algorithm 3 is solved.
enum class KktSolver {
    dense_lu,   ///< Eigen::PartialPivLU
    sparse_lu,  ///< Eigen::SparseLU with COLAMD, the pattern analysed once per node
};

struct KktOutcome {
    int iterations = 0;
    bool has_converged = false;
};

/// Algorithm 3 of M. Stees's thesis: maximises sum c_j log w_j subject to sum w_j y_j = 0, sum w_j = 1 by Newton's
/// method with an infeasible start (w = 1 / neighbours) on the full KKT system of n + d + 1 unknowns, with backtracking
/// on the residual (Boyd, Vandenberghe, "Convex Optimization", Alg. 10.2), to a residual of 1e-8, at most 500
/// iterations. offsets: neighbours × dimension; influence: c, ones in the thesis. The offsets are scaled to the size of
/// the patch, which spares the reference trouble.
KktOutcome kkt_weights(const Eigen::Ref<const Eigen::MatrixXd>& offsets,
                       const Eigen::Ref<const Eigen::VectorXd>& influence, KktSolver solver,
                       Eigen::Ref<Eigen::VectorXd> weights);

/// Algorithm 2 of the thesis: weights of least 2-norm by a reduced QR factorisation of A^T (Householder). offsets:
/// neighbours × dimension, scaled to the size of the patch like above.
void qr_weights(const Eigen::Ref<const Eigen::MatrixXd>& offsets, Eigen::Ref<Eigen::VectorXd> weights);

struct ReferenceSolve {
    double seconds = 0.0;     ///< factorisation and solution, without the assembly
    double difference = 0.0;  ///< largest distance of a node from where the warp put it, over the size of the mesh
};

/// Eigen's SparseLU with COLAMD on the matrix D_I of all interior nodes, nothing condensed: what the thesis does.
/// The weights are those of the case; result: where the warp put the nodes.
ReferenceSolve solve_by_sparse_lu(const WarpCase& problem, const Coordinates& result);

}  // namespace curvewright::benchmarks
