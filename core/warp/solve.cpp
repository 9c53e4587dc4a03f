#include "core/warp/solve.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <future>
#include <memory>
#include <thread>
#include <vector>

#include <fmt/format.h>
#include <Eigen/IterativeLinearSolvers>
#include <Eigen/SparseLU>

#include "core/base/error.h"
#include "core/base/parallel.h"

namespace curvewright {
namespace {

using RowMatrix = Eigen::SparseMatrix<double, Eigen::RowMajor>;
constexpr double usable_residual = 1e-6;

/// The identity as Eigen's solvers want a preconditioner. They call it in every iteration, which is where a long solve
/// can notice that it is to stop.
class PollingIdentity {
  public:
    using StorageIndex = int;
    enum { ColsAtCompileTime = Eigen::Dynamic, MaxColsAtCompileTime = Eigen::Dynamic };

    PollingIdentity() = default;
    template <class Matrix>
    explicit PollingIdentity(const Matrix&) {}
    template <class Matrix>
    PollingIdentity& analyzePattern(const Matrix&) {
        return *this;
    }
    template <class Matrix>
    PollingIdentity& factorize(const Matrix&) {
        return *this;
    }
    template <class Matrix>
    PollingIdentity& compute(const Matrix&) {
        return *this;
    }
    template <class Vector>
    const Vector& solve(const Vector& b) const {
        context_->check();
        // Nobody knows how many iterations it takes: the fraction approaches 1 as they go on. Only one column reports.
        if (reports_ && ++calls_ % 16 == 0 && context_->progress)
            context_->progress("Solving", 1.0 - 1.0 / (1.0 + calls_ / 200.0));
        return b;
    }
    Eigen::ComputationInfo info() const { return Eigen::Success; }
    void set_context(const TaskContext& context, bool reports) {
        context_ = &context;
        reports_ = reports;
    }

  private:
    const TaskContext* context_ = nullptr;
    bool reports_ = false;
    mutable int calls_ = 0;
};

double relative_residual(const RowMatrix& matrix, const Eigen::MatrixXd& solution, const Eigen::MatrixXd& rhs) {
    double largest = 0.0;
    for (Eigen::Index column = 0; column < rhs.cols(); ++column) {
        const double norm = rhs.col(column).norm();
        if (norm == 0.0) continue;
        const double residual = (rhs.col(column) - matrix * solution.col(column)).norm() / norm;
        largest = std::isfinite(residual) ? std::max(largest, residual) : std::numeric_limits<double>::infinity();
    }
    return largest;
}

Eigen::MatrixXd solve_iteratively(const RowMatrix& matrix, const Eigen::MatrixXd& rhs, const WarpOptions& options,
                                  SolveReport& report, const TaskContext& context) {
    Eigen::MatrixXd solution = Eigen::MatrixXd::Zero(rhs.rows(), rhs.cols());
    std::vector<int> iterations(static_cast<std::size_t>(rhs.cols()), 0);
    context.report("Solving", 0.0);
    const auto caller = std::this_thread::get_id();
    parallel_for(static_cast<std::size_t>(rhs.cols()), 1, context, {}, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const auto column = static_cast<Eigen::Index>(i);
            if (rhs.col(column).isZero(0.0)) continue;
            Eigen::BiCGSTAB<RowMatrix, PollingIdentity> solver;
            // Progress goes out on the caller's thread only.
            solver.preconditioner().set_context(context, std::this_thread::get_id() == caller);
            solver.setTolerance(options.residual_tolerance);
            solver.setMaxIterations(options.max_iterations);
            solver.compute(matrix);
            solution.col(column) = solver.solve(rhs.col(column));
            iterations[i] = static_cast<int>(solver.iterations());
        }
    });
    report.solver = SolverChoice::iterative;
    report.iterations = *std::max_element(iterations.begin(), iterations.end());
    report.residual = relative_residual(matrix, solution, rhs);
    return solution;
}

Eigen::MatrixXd solve_directly(const RowMatrix& matrix, const Eigen::MatrixXd& rhs, SolveReport& report,
                               const TaskContext& context) {
    context.report("Factorising", 0.0);
    // The factorisation cannot be interrupted. It works on data of its own in a thread that is left behind when the
    // caller asks to stop; it then ends by itself and frees what it holds.
    struct Work {
        Eigen::SparseMatrix<double, Eigen::ColMajor> matrix;
        Eigen::MatrixXd rhs, solution;
        bool is_singular = false;
    };
    const auto work = std::make_shared<Work>();
    work->matrix = matrix;
    work->rhs = rhs;
    std::packaged_task<void()> task([work] {
        Eigen::SparseLU<Eigen::SparseMatrix<double, Eigen::ColMajor>> solver(work->matrix);
        work->is_singular = solver.info() != Eigen::Success;
        if (!work->is_singular) work->solution = solver.solve(work->rhs);
    });
    std::future<void> done = task.get_future();
    std::thread(std::move(task)).detach();
    while (done.wait_for(std::chrono::milliseconds(20)) != std::future_status::ready) context.check();
    done.get();
    if (work->is_singular)
        throw SolverFailure(
            "The matrix of the warp is singular: some interior nodes are not tied to the boundary by "
            "their weights.");
    const Eigen::MatrixXd solution = std::move(work->solution);
    report.solver = SolverChoice::direct;
    report.iterations = 0;
    report.residual = relative_residual(matrix, solution, rhs);
    return solution;
}

}  // namespace

Eigen::MatrixXd solve_linear(const RowMatrix& matrix, const Eigen::MatrixXd& rhs, const WarpOptions& options,
                             SolveReport& report, const TaskContext& context) {
    Eigen::MatrixXd solution;
    if (options.solver != SolverChoice::direct) {
        solution = solve_iteratively(matrix, rhs, options, report, context);
        // BiCGSTAB's own residual is updated, not computed; allow it to drift by a factor.
        const bool is_good = report.residual <= 100 * options.residual_tolerance;
        report.note = is_good ? fmt::format("BiCGSTAB converged in {} iterations.", report.iterations)
                              : fmt::format("BiCGSTAB stopped after {} iterations at a residual of {:.1e}.",
                                            report.iterations, report.residual);
        if (options.solver == SolverChoice::iterative || is_good) {
            if (report.residual > usable_residual) throw SolverFailure(report.note + " Try the direct solver.");
            return solution;
        }
        report.note += " The direct solver took over.";
    } else {
        report.note = "Direct solver as asked.";
    }
    const std::string note = report.note;
    solution = solve_directly(matrix, rhs, report, context);
    report.note = note;
    if (!(report.residual <= usable_residual))
        throw SolverFailure(fmt::format("The linear system of the warp could not be solved (relative residual {:.1e}).",
                                        report.residual));
    return solution;
}

}  // namespace curvewright
