#include "core/linear/linear_solver.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <future>
#include <iostream>  // Eigen/MetisSupport forgets it
#include <limits>
#include <mutex>
#include <thread>

#include <fmt/format.h>
#include <Eigen/MetisSupport>
#include <Eigen/OrderingMethods>
#include <Eigen/SparseCholesky>
#include <Eigen/SparseLU>

#include "core/base/error.h"
#include "core/linear/krylov.h"

namespace curvewright {
namespace {

constexpr double usable_residual = 1e-6;
/// Unknowns below which a factorisation is as quick as making a preconditioner.
constexpr Eigen::Index small_system = 400;

using ColumnMatrix = Eigen::SparseMatrix<double, Eigen::ColMajor>;

/// A factored matrix, whatever the method.
class Factorisation {
  public:
    virtual ~Factorisation() = default;
    virtual MultiVector solve(const MultiVector& b) const = 0;
    bool is_regular = false;
};

template <class Method>
class FactorisationBy final : public Factorisation {
  public:
    explicit FactorisationBy(const ColumnMatrix& matrix) : method_(matrix) {
        is_regular = method_.info() == Eigen::Success;
    }
    MultiVector solve(const MultiVector& b) const override {
        return Eigen::MatrixXd(method_.solve(Eigen::MatrixXd(b)));
    }

  private:
    Method method_;
};

/// Eigen's METIS ordering gives new positions to old ones, as SimplicialLDLT takes it; SparseLU wants the inverse.
struct DissectionForLu {
    using PermutationType = Eigen::MetisOrdering<int>::PermutationType;
    void operator()(const ColumnMatrix& matrix, PermutationType& permutation) const {
        PermutationType inverse;
        Eigen::MetisOrdering<int>()(matrix, inverse);
        permutation = inverse.inverse();
    }
};

std::unique_ptr<Factorisation> factorise(const ColumnMatrix& matrix, bool is_symmetric, Ordering ordering) {
    // Small graphs have nothing to be dissected; METIS does not take those without edges.
    constexpr Eigen::Index smallest = 2000;
    const bool dissects =
        ordering == Ordering::nested_dissection && matrix.rows() > smallest && matrix.nonZeros() > 2 * matrix.rows();
    if (is_symmetric) {
        if (dissects)
            return std::make_unique<
                FactorisationBy<Eigen::SimplicialLDLT<ColumnMatrix, Eigen::Lower, Eigen::MetisOrdering<int>>>>(matrix);
        return std::make_unique<FactorisationBy<Eigen::SimplicialLDLT<ColumnMatrix>>>(matrix);
    }
    if (dissects) return std::make_unique<FactorisationBy<Eigen::SparseLU<ColumnMatrix, DissectionForLu>>>(matrix);
    return std::make_unique<FactorisationBy<Eigen::SparseLU<ColumnMatrix>>>(matrix);
}

double relative_residual(const BlockMatrix& matrix, const MultiVector& x, const MultiVector& b) {
    MultiVector product;
    multiply(matrix, x, product);
    double largest = 0.0;
    for (Eigen::Index column = 0; column < b.cols(); ++column) {
        const double norm = b.col(column).norm();
        if (norm == 0.0) continue;
        const double residual = (b.col(column) - product.col(column)).norm() / norm;
        largest = std::isfinite(residual) ? std::max(largest, residual) : std::numeric_limits<double>::infinity();
    }
    return largest;
}

}  // namespace

class LinearSolver::Implementation {
  public:
    Implementation(LinearSystem given, const SolverOptions& solver_options, const TaskContext& context)
        : system(std::move(given)), options(solver_options) {
        const Eigen::Index unknowns = static_cast<Eigen::Index>(system.matrix.rows) * system.matrix.block;
        is_direct = options.choice == SolverChoice::direct ||
                    (options.choice == SolverChoice::automatic && unknowns <= small_system);
        if (is_direct) {
            reason = options.choice == SolverChoice::direct
                         ? fmt::format("Direct solver, as asked, for {} unknowns.", unknowns)
                         : fmt::format("Direct solver: {} unknowns are few enough to be factored at once.", unknowns);
            factor(context);
            return;
        }
        context.report("Preparing the solver", 0.0);
        try {
            preconditioner =
                std::make_unique<MultilevelPreconditioner>(system.matrix, system.coarse, system.sweep, context);
        } catch (const SolverFailure& failure) {
            if (options.choice == SolverChoice::iterative) throw;
            reason = fmt::format("Direct solver for {} unknowns, because the iterative one cannot be prepared: {}",
                                 unknowns, failure.what());
            is_direct = true;
            factor(context);
            return;
        }
        reason = fmt::format("{} with {} for {} unknowns{}", system.is_symmetric ? "Conjugate gradients" : "BiCGSTAB",
                             preconditioner->description(), unknowns,
                             options.choice == SolverChoice::iterative ? ", as asked" : "");
    }

    /// Makes the factorisation if it is not there yet.
    const Factorisation& factor(const TaskContext& context) {
        const std::lock_guard lock(mutex);
        if (factorisation) return *factorisation;
        context.report("Factorising", 0.0);
        // The work cannot be interrupted. It is done on data of its own in a thread that is left behind when the caller
        // asks to stop; it then ends by itself and frees what it holds.
        struct Work {
            ColumnMatrix matrix;
            std::unique_ptr<Factorisation> result;
        };
        const auto work = std::make_shared<Work>();
        work->matrix = to_sparse(system.matrix);
        std::packaged_task<void()> task([work, is_symmetric = system.is_symmetric, ordering = options.ordering] {
            work->result = factorise(work->matrix, is_symmetric, ordering);
            work->matrix.resize(0, 0);
        });
        std::future<void> done = task.get_future();
        std::thread(std::move(task)).detach();
        while (done.wait_for(std::chrono::milliseconds(20)) != std::future_status::ready) context.check();
        context.check();
        try {
            done.get();
        } catch (const std::bad_alloc&) {
            throw SolverFailure("The factorisation needs more memory than there is; use the iterative solver.");
        }
        if (!work->result->is_regular)
            throw SolverFailure(
                "The matrix of the warp is singular: some interior nodes are not tied to the boundary by their "
                "weights.");
        factorisation = std::move(work->result);
        return *factorisation;
    }

    LinearSystem system;
    SolverOptions options;
    bool is_direct = false;
    std::string reason;
    std::unique_ptr<MultilevelPreconditioner> preconditioner;

  private:
    std::mutex mutex;
    std::unique_ptr<Factorisation> factorisation;
};

LinearSolver::LinearSolver(LinearSystem system, const SolverOptions& options, const TaskContext& context)
    : implementation_(std::make_unique<Implementation>(std::move(system), options, context)) {}
LinearSolver::~LinearSolver() = default;

const BlockMatrix& LinearSolver::matrix() const {
    return implementation_->system.matrix;
}

MultiVector LinearSolver::solve(const MultiVector& b, SolveReport& report, const TaskContext& context) const {
    Implementation& data = *implementation_;
    report = {};
    report.note = data.reason;
    if (!data.is_direct) {
        MultiVector solution(b.rows(), b.cols());
        KrylovResult worst;
        worst.has_converged = true;
        constexpr Eigen::Index at_once = 4;
        for (Eigen::Index first = 0; first < b.cols(); first += at_once) {
            const Eigen::Index count = std::min(at_once, b.cols() - first);
            MultiVector part;
            const KrylovResult result = solve_krylov(data.system.matrix, data.system.is_symmetric, *data.preconditioner,
                                                     b.middleCols(first, count), part,
                                                     {data.options.tolerance, data.options.max_iterations}, context);
            solution.middleCols(first, count) = part;
            worst.iterations = std::max(worst.iterations, result.iterations);
            worst.residual = std::max(worst.residual, result.residual);
            worst.has_converged = worst.has_converged && result.has_converged;
        }
        report.solver = SolverChoice::iterative;
        report.iterations = worst.iterations;
        report.residual = worst.residual;
        report.note += worst.has_converged
                           ? fmt::format(": {} iterations.", worst.iterations)
                           : fmt::format(": stopped after {} iterations at a relative residual of {:.1e}.",
                                         worst.iterations, worst.residual);
        if (worst.has_converged) return solution;
        if (data.options.choice == SolverChoice::iterative) {
            if (!(worst.residual <= usable_residual)) throw SolverFailure(report.note + " Try the direct solver.");
            return solution;
        }
        report.note += " The direct solver took over.";
    }
    const Factorisation& factorisation = data.factor(context);
    MultiVector solution = factorisation.solve(b);
    report.solver = SolverChoice::direct;
    report.iterations = 0;
    report.residual = relative_residual(data.system.matrix, solution, b);
    if (!(report.residual <= usable_residual))
        throw SolverFailure(fmt::format("The linear system of the warp could not be solved (relative residual {:.1e}).",
                                        report.residual));
    return solution;
}

}  // namespace curvewright
