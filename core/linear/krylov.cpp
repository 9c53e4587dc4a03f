#include "core/linear/krylov.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/base/parallel.h"

namespace curvewright {
namespace {

constexpr std::size_t rows_per_piece = 8192;

/// One number per right-hand side.
template <int Vectors>
using Scalars = std::array<double, Vectors>;

/// Vector operations on all right-hand sides at once, each with a factor of its own.
template <int Vectors>
class Operations {
  public:
    explicit Operations(const TaskContext& context) : context_(context) {}

    /// Sums of products, added up in pieces of fixed size: the same for every number of threads.
    Scalars<Vectors> dot(const MultiVector& a, const MultiVector& b) {
        const auto rows = static_cast<std::size_t>(a.rows());
        partial_.assign((rows + rows_per_piece - 1) / rows_per_piece, {});
        parallel_for(rows, rows_per_piece, context_, {}, [&](std::size_t begin, std::size_t end) {
            Scalars<Vectors> sum{};
            const double *p = a.data(), *q = b.data();
            for (std::size_t row = begin; row < end; ++row)
                for (std::size_t v = 0; v < Vectors; ++v) sum[v] += p[row * Vectors + v] * q[row * Vectors + v];
            partial_[begin / rows_per_piece] = sum;
        });
        Scalars<Vectors> total{};
        for (const auto& sum : partial_)
            for (std::size_t v = 0; v < Vectors; ++v) total[v] += sum[v];
        return total;
    }
    Scalars<Vectors> norm(const MultiVector& a) {
        Scalars<Vectors> result = dot(a, a);
        for (double& value : result) value = std::sqrt(value);
        return result;
    }
    /// body(entry, vector) for all entries, in parallel.
    template <class Body>
    void each(Eigen::Index rows, const Body& body) {
        parallel_for(static_cast<std::size_t>(rows), rows_per_piece, context_, {},
                     [&](std::size_t begin, std::size_t end) {
                         for (std::size_t row = begin; row < end; ++row)
                             for (std::size_t v = 0; v < Vectors; ++v) body(row * Vectors + v, v);
                     });
    }

  private:
    const TaskContext& context_;
    std::vector<Scalars<Vectors>> partial_;
};

/// Which right-hand sides still need work, and how far the worst of them is.
template <int Vectors>
class Convergence {
  public:
    Convergence(const Scalars<Vectors>& norms, const KrylovOptions& options, const TaskContext& context)
        : norms_(norms), options_(options), context_(context) {}

    /// Takes the present norms of the residuals; false when all are small enough. Columns that are done, or not finite,
    /// are active no more.
    bool update(const Scalars<Vectors>& residual_norms) {
        double worst = 0.0;
        for (std::size_t v = 0; v < Vectors; ++v) {
            if (!is_active[v]) continue;
            const double relative = residual_norms[v] / norms_[v];
            is_active[v] = relative > options_.tolerance && std::isfinite(relative);
            if (is_active[v]) worst = std::max(worst, relative);
        }
        if (worst == 0.0) return false;
        const double fraction = std::log(std::min(worst, 1.0)) / std::log(options_.tolerance);
        reported_ = std::max(reported_, fraction);
        context_.report("Solving", std::clamp(reported_, 0.0, 1.0));
        return true;
    }
    std::array<bool, Vectors> is_active{};

  private:
    Scalars<Vectors> norms_;
    const KrylovOptions& options_;
    const TaskContext& context_;
    double reported_ = 0.0;
};

template <int Vectors>
class Solver {
  public:
    Solver(const BlockMatrix& matrix, const MultilevelPreconditioner& preconditioner, const MultiVector& b,
           const KrylovOptions& options, const TaskContext& context)
        : matrix_(matrix),
          preconditioner_(preconditioner),
          b_(b),
          options_(options),
          context_(context),
          ops_(context),
          norms_(ops_.norm(b)) {}

    KrylovResult run(bool is_symmetric, MultiVector& x) {
        KrylovResult result;
        x.setZero(b_.rows(), Vectors);
        residual_ = b_;
        double previous = std::numeric_limits<double>::infinity();
        constexpr int most_restarts = 4;
        for (int start = 0; start <= most_restarts; ++start) {
            Convergence<Vectors> convergence(norms_, options_, context_);
            for (std::size_t v = 0; v < Vectors; ++v) convergence.is_active[v] = norms_[v] != 0.0;
            if (convergence.update(ops_.norm(residual_)))
                is_symmetric ? conjugate_gradients(x, convergence, result.iterations)
                             : bicgstab(x, convergence, result.iterations);
            multiply(matrix_, x, residual_, context_);
            ops_.each(b_.rows(),
                      [&](std::size_t e, std::size_t) { residual_.data()[e] = b_.data()[e] - residual_.data()[e]; });
            const Scalars<Vectors> norms = ops_.norm(residual_);
            result.residual = 0.0;
            for (std::size_t v = 0; v < Vectors; ++v) {
                if (norms_[v] == 0.0) continue;
                const double relative = norms[v] / norms_[v];
                result.residual = std::isfinite(relative) ? std::max(result.residual, relative)
                                                          : std::numeric_limits<double>::infinity();
            }
            if (result.residual <= options_.tolerance || result.iterations >= options_.max_iterations ||
                !(result.residual < 0.5 * previous))
                break;
            previous = result.residual;
        }
        result.has_converged = result.residual <= 10.0 * options_.tolerance;
        return result;
    }

  private:
    void conjugate_gradients(MultiVector& x, Convergence<Vectors>& convergence, int& iterations) {
        const Eigen::Index rows = b_.rows();
        MultiVector z, q(rows, Vectors), p = MultiVector::Zero(rows, Vectors);
        Scalars<Vectors> rho{}, old_rho{}, alpha{}, beta{};
        for (; iterations < options_.max_iterations; ++iterations) {
            preconditioner_.apply(residual_, z, work_, context_);
            rho = ops_.dot(residual_, z);
            for (std::size_t v = 0; v < Vectors; ++v) beta[v] = old_rho[v] > 0.0 ? rho[v] / old_rho[v] : 0.0;
            old_rho = rho;
            ops_.each(rows, [&](std::size_t e, std::size_t v) { p.data()[e] = z.data()[e] + beta[v] * p.data()[e]; });
            multiply(matrix_, p, q, context_);
            const Scalars<Vectors> curvature = ops_.dot(p, q);
            for (std::size_t v = 0; v < Vectors; ++v) {
                const bool is_usable = convergence.is_active[v] && curvature[v] > 0.0 && rho[v] > 0.0;
                if (!is_usable) convergence.is_active[v] = false;
                alpha[v] = is_usable ? rho[v] / curvature[v] : 0.0;
            }
            ops_.each(rows, [&](std::size_t e, std::size_t v) {
                x.data()[e] += alpha[v] * p.data()[e];
                residual_.data()[e] -= alpha[v] * q.data()[e];
            });
            if (!convergence.update(ops_.norm(residual_))) {
                ++iterations;
                return;
            }
        }
    }

    void bicgstab(MultiVector& x, Convergence<Vectors>& convergence, int& iterations) {
        const Eigen::Index rows = b_.rows();
        const MultiVector shadow = residual_;
        MultiVector p = MultiVector::Zero(rows, Vectors), v = p, t(rows, Vectors), p_hat, s_hat;
        Scalars<Vectors> rho{}, old_rho{}, alpha{}, beta{}, omega{};
        for (; iterations < options_.max_iterations; ++iterations) {
            rho = ops_.dot(shadow, residual_);
            for (std::size_t c = 0; c < Vectors; ++c) {
                beta[c] = rho[c] / old_rho[c] * (alpha[c] / omega[c]);
                if (!std::isfinite(beta[c])) beta[c] = 0.0;
            }
            old_rho = rho;
            ops_.each(rows, [&](std::size_t e, std::size_t c) {
                p.data()[e] = residual_.data()[e] + beta[c] * (p.data()[e] - omega[c] * v.data()[e]);
            });
            preconditioner_.apply(p, p_hat, work_, context_);
            multiply(matrix_, p_hat, v, context_);
            const Scalars<Vectors> projection = ops_.dot(shadow, v);
            for (std::size_t c = 0; c < Vectors; ++c) {
                alpha[c] = rho[c] / projection[c];
                if (!convergence.is_active[c] || !std::isfinite(alpha[c])) alpha[c] = 0.0;
            }
            // The residual becomes s.
            ops_.each(rows, [&](std::size_t e, std::size_t c) {
                x.data()[e] += alpha[c] * p_hat.data()[e];
                residual_.data()[e] -= alpha[c] * v.data()[e];
            });
            preconditioner_.apply(residual_, s_hat, work_, context_);
            multiply(matrix_, s_hat, t, context_);
            const Scalars<Vectors> ts = ops_.dot(t, residual_), tt = ops_.dot(t, t);
            for (std::size_t c = 0; c < Vectors; ++c) {
                omega[c] = ts[c] / tt[c];
                if (!convergence.is_active[c] || !std::isfinite(omega[c])) omega[c] = 0.0;
                // Nothing moved: the method broke down, and a restart from the true residual is to help.
                if (alpha[c] == 0.0 && omega[c] == 0.0) convergence.is_active[c] = false;
            }
            ops_.each(rows, [&](std::size_t e, std::size_t c) {
                x.data()[e] += omega[c] * s_hat.data()[e];
                residual_.data()[e] -= omega[c] * t.data()[e];
            });
            if (!convergence.update(ops_.norm(residual_))) {
                ++iterations;
                return;
            }
        }
    }

    const BlockMatrix& matrix_;
    const MultilevelPreconditioner& preconditioner_;
    const MultiVector& b_;
    const KrylovOptions& options_;
    const TaskContext& context_;
    Operations<Vectors> ops_;
    Scalars<Vectors> norms_;
    MultiVector residual_;
    MultilevelPreconditioner::Workspace work_;
};

}  // namespace

KrylovResult solve_krylov(const BlockMatrix& matrix, bool is_symmetric, const MultilevelPreconditioner& preconditioner,
                          const MultiVector& b, MultiVector& x, const KrylovOptions& options,
                          const TaskContext& context) {
    KrylovResult result;
    with_sizes(1, b.cols(), [&]<int, int Vectors>() {
        result = Solver<Vectors>(matrix, preconditioner, b, options, context).run(is_symmetric, x);
    });
    return result;
}

}  // namespace curvewright
