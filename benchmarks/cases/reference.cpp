#include "benchmarks/cases/reference.h"

#include <cmath>
#include <vector>

#include <Eigen/LU>
#include <Eigen/QR>
#include <Eigen/SparseLU>

#include "core/base/error.h"
#include "core/base/stopwatch.h"
#include "core/warp/equations.h"

namespace curvewright::benchmarks {
namespace {

using ColumnMatrix = Eigen::SparseMatrix<double, Eigen::ColMajor>;
using SparseLu = Eigen::SparseLU<ColumnMatrix, Eigen::COLAMDOrdering<int>>;

/// The matrix [diag(h) A^T; A 0] of one patch, and how to solve with it.
class KktSystem {
  public:
    KktSystem(const Eigen::MatrixXd& a, KktSolver solver) : solver_(solver) {
        const Eigen::Index m = a.rows(), n = a.cols();
        if (solver == KktSolver::dense_lu) {
            dense_ = Eigen::MatrixXd::Zero(n + m, n + m);
            dense_.topRightCorner(n, m) = a.transpose();
            dense_.bottomLeftCorner(m, n) = a;
            return;
        }
        std::vector<Eigen::Triplet<double>> entries;
        for (Eigen::Index j = 0; j < n; ++j) {
            entries.emplace_back(j, j, 1.0);
            for (Eigen::Index i = 0; i < m; ++i) {
                entries.emplace_back(j, n + i, a(i, j));
                entries.emplace_back(n + i, j, a(i, j));
            }
        }
        sparse_.resize(n + m, n + m);
        sparse_.setFromTriplets(entries.begin(), entries.end());
        sparse_lu_.analyzePattern(sparse_);
    }

    Eigen::VectorXd solve(const Eigen::VectorXd& h, const Eigen::VectorXd& right) {
        if (solver_ == KktSolver::dense_lu) {
            dense_.diagonal().head(h.size()) = h;
            return dense_.partialPivLu().solve(right);
        }
        // The diagonal entry is the first of its column.
        for (Eigen::Index j = 0; j < h.size(); ++j) sparse_.valuePtr()[sparse_.outerIndexPtr()[j]] = h[j];
        sparse_lu_.factorize(sparse_);
        return sparse_lu_.solve(right);
    }

  private:
    KktSolver solver_;
    Eigen::MatrixXd dense_;
    ColumnMatrix sparse_;
    SparseLu sparse_lu_;
};

}  // namespace

KktOutcome kkt_weights(const Eigen::Ref<const Eigen::MatrixXd>& offsets,
                       const Eigen::Ref<const Eigen::VectorXd>& influence, KktSolver solver,
                       Eigen::Ref<Eigen::VectorXd> weights) {
    constexpr double tolerance = 1e-8;
    constexpr int max_iterations = 500;
    const Eigen::Index n = offsets.rows(), m = offsets.cols() + 1;
    Eigen::MatrixXd a(m, n);
    a.topRows(m - 1) = offsets.transpose() / offsets.cwiseAbs().maxCoeff();
    a.row(m - 1).setOnes();
    const Eigen::VectorXd b = Eigen::VectorXd::Unit(m, m - 1);
    KktSystem system(a, solver);
    Eigen::VectorXd w = Eigen::VectorXd::Constant(n, 1.0 / static_cast<double>(n)), nu = Eigen::VectorXd::Zero(m);
    const auto residual = [&](const Eigen::VectorXd& at, const Eigen::VectorXd& multipliers) {
        Eigen::VectorXd r(n + m);
        r.head(n) = a.transpose() * multipliers - influence.cwiseQuotient(at);
        r.tail(m) = a * at - b;
        return r;
    };
    KktOutcome outcome;
    Eigen::VectorXd r = residual(w, nu);
    double norm = r.norm();
    while (norm > tolerance && outcome.iterations < max_iterations) {
        ++outcome.iterations;
        const Eigen::VectorXd step = system.solve(influence.cwiseQuotient(w.cwiseAbs2()), -r);
        double length = 1.0;
        Eigen::VectorXd next_w, next_nu, next_r;
        for (; length > 1e-10; length *= 0.5) {
            next_w = w + length * step.head(n);
            if (!(next_w.minCoeff() > 0.0)) continue;
            next_nu = nu + length * step.tail(m);
            next_r = residual(next_w, next_nu);
            if (next_r.norm() <= (1.0 - 0.01 * length) * norm) break;
        }
        if (length <= 1e-10) break;  // rounding
        w = next_w;
        nu = next_nu;
        r = next_r;
        norm = r.norm();
    }
    outcome.has_converged = norm <= tolerance;
    weights = w;
    return outcome;
}

void qr_weights(const Eigen::Ref<const Eigen::MatrixXd>& offsets, Eigen::Ref<Eigen::VectorXd> weights) {
    const Eigen::Index n = offsets.rows(), m = offsets.cols() + 1;
    Eigen::MatrixXd transposed(n, m);
    transposed.leftCols(m - 1) = offsets / offsets.cwiseAbs().maxCoeff();
    transposed.col(m - 1).setOnes();
    const Eigen::HouseholderQR<Eigen::MatrixXd> qr(transposed);
    Eigen::VectorXd t = Eigen::VectorXd::Zero(n);
    t.head(m) =
        qr.matrixQR().topRows(m).triangularView<Eigen::Upper>().transpose().solve(Eigen::VectorXd::Unit(m, m - 1));
    weights = qr.householderQ() * t;
}

ReferenceSolve solve_by_sparse_lu(const WarpCase& problem, const Coordinates& result) {
    const CurvedMesh& mesh = problem.mesh;
    const int dim = problem.dimension();
    const Numbering numbering = number_nodes(mesh, given_nodes(problem), false);
    const NeighbourSets sets = find_neighbours(mesh.topology(), numbering.free_nodes(), problem.options.neighbours);
    const WarpOptions& options = problem.options;
    const WeightFunction weighting = options.weighting == Weighting::affine
                                         ? affine_weighting(options.distance_power, options.sharing_power)
                                         : convex_weighting(options.distance_power, options.sharing_power);
    const SparseRows all = to_sparse(weight_equations(numbering, sets, compute_weights(mesh, sets, weighting)));
    const ColumnMatrix matrix = all.leftCols(numbering.free);
    Eigen::MatrixXd given(numbering.given(), dim);
    for (Index i = 0; i < numbering.given(); ++i)
        given.row(i) = problem.boundary_positions.row(numbering.nodes[numbering.free + i]).head(dim);
    const Eigen::MatrixXd right = -(all.rightCols(numbering.given()) * given);

    ReferenceSolve reference;
    const Stopwatch watch;
    const SparseLu factorisation(matrix);
    if (factorisation.info() != Eigen::Success) throw SolverFailure("SparseLU could not factor the matrix of a case.");
    const Eigen::MatrixXd solution = factorisation.solve(right);
    reference.seconds = watch.seconds();

    const Eigen::Matrix<double, 2, 3> box = bounding_box(mesh);
    for (Index i = 0; i < numbering.free; ++i)
        reference.difference =
            std::max(reference.difference, (solution.row(i) - result.row(numbering.nodes[i]).head(dim)).norm());
    reference.difference /= (box.row(1) - box.row(0)).maxCoeff();
    return reference;
}

}  // namespace curvewright::benchmarks
