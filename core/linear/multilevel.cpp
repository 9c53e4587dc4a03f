#include "core/linear/multilevel.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <Eigen/LU>

#include "core/base/error.h"
#include "core/base/parallel.h"

namespace curvewright {
namespace {

constexpr std::size_t rows_per_piece = 2048;

/// target += source times the inverse diagonal block.
template <int Block, int Vectors>
void add_scaled(const double* inverse, const double* source, double* target) {
    for (int r = 0; r < Block; ++r)
        for (int c = 0; c < Block; ++c)
            for (int v = 0; v < Vectors; ++v)
                target[r * Vectors + v] += inverse[r * Block + c] * source[c * Vectors + v];
}

/// rows × coarse times vectors, by rows and in parallel; block unknowns per row side by side.
void multiply_coarse(const SparseRows& matrix, Eigen::Index width, const double* x, double* y, bool adds,
                     const TaskContext& context) {
    parallel_for(static_cast<std::size_t>(matrix.rows()), rows_per_piece, context, {},
                 [&](std::size_t begin, std::size_t end) {
                     for (auto row = static_cast<Eigen::Index>(begin); row < static_cast<Eigen::Index>(end); ++row) {
                         double* target = y + row * width;
                         if (!adds) std::fill_n(target, width, 0.0);
                         for (SparseRows::InnerIterator it(matrix, row); it; ++it) {
                             const double* source = x + it.col() * width;
                             for (Eigen::Index v = 0; v < width; ++v) target[v] += it.value() * source[v];
                         }
                     }
                 });
}

}  // namespace

MultilevelPreconditioner::MultilevelPreconditioner(const BlockMatrix& matrix, const CoarseSpace& coarse,
                                                   SweepOrder order, const TaskContext& context)
    : matrix_(matrix), order_(std::move(order)) {
    if (order_.pieces.empty()) order_ = {{0, matrix.rows}, {0, 1}};
    const auto rows = static_cast<std::size_t>(matrix.rows);
    const int b = matrix.block;
    diagonal_.resize(rows);
    inverse_diagonal_.resize(rows * static_cast<std::size_t>(b * b));
    // First row of the stage of each piece, and of the next stage.
    std::vector<std::pair<Index, Index>> stage_of_piece(order_.pieces.size() - 1);
    for (std::size_t stage = 0; stage + 1 < order_.stages.size(); ++stage)
        for (Index piece = order_.stages[stage]; piece < order_.stages[stage + 1]; ++piece)
            stage_of_piece[piece] = {order_.pieces[order_.stages[stage]], order_.pieces[order_.stages[stage + 1]]};
    parallel_for(stage_of_piece.size(), 1, context, {}, [&](std::size_t first, std::size_t last) {
        for (std::size_t piece = first; piece < last; ++piece) {
            const Index begin = order_.pieces[piece], end = order_.pieces[piece + 1];
            const auto [stage_begin, stage_end] = stage_of_piece[piece];
            for (auto row = static_cast<std::size_t>(begin); row < static_cast<std::size_t>(end); ++row) {
                bool has_diagonal = false;
                for (std::size_t k = matrix.offsets[row]; k < matrix.offsets[row + 1]; ++k) {
                    const Index column = matrix.column_of[k];
                    if (column == static_cast<Index>(row)) {
                        diagonal_[row] = k;
                        has_diagonal = true;
                    }
                    const bool is_in_stage = column >= stage_begin && column < stage_end;
                    if (is_in_stage && (column < begin || column >= end))
                        throw SolverFailure("Rows that are to be swept at the same time are coupled.");
                }
                if (!has_diagonal) throw SolverFailure("A diagonal block of the linear system is missing.");
                using Block = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor, 3, 3>;
                const Block diagonal = Eigen::Map<const Block>(matrix.block_at(diagonal_[row]), b, b);
                const Block inverse = diagonal.inverse();
                if (!inverse.allFinite()) throw SolverFailure("A diagonal block of the linear system is singular.");
                Eigen::Map<Block>(inverse_diagonal_.data() + row * static_cast<std::size_t>(b * b), b, b) = inverse;
            }
        }
    });
    if (coarse.prolongation.cols() > 0) {
        prolongation_ = coarse.prolongation;
        restriction_ = prolongation_.transpose();
        if (coarse.row_scale.size() > 0) restriction_ = restriction_ * coarse.row_scale.asDiagonal();
        coarse_.emplace(galerkin_product(restriction_, matrix, prolongation_, context), b, coarse.near_null, context);
    }
}

void MultilevelPreconditioner::apply(const MultiVector& r, MultiVector& z, Workspace& work,
                                     const TaskContext& context) const {
    z.resize(r.rows(), r.cols());
    work.residual.resize(r.rows(), r.cols());
    with_sizes(matrix_.block, r.cols(), [&]<int Block, int Vectors>() {
        constexpr int width = Block * Vectors;
        double* solution = z.data();
        /// Pieces of one stage in parallel.
        const auto sweep_stage = [&](std::size_t stage, const auto& sweep_piece) {
            const auto first = static_cast<std::size_t>(order_.stages[stage]);
            parallel_for(static_cast<std::size_t>(order_.stages[stage + 1]) - first, 1, context, {},
                         [&](std::size_t begin, std::size_t end) {
                             for (std::size_t piece = first + begin; piece < first + end; ++piece)
                                 sweep_piece(static_cast<std::size_t>(order_.pieces[piece]),
                                             static_cast<std::size_t>(order_.pieces[piece + 1]));
                         });
        };
        // z = D^-1 (r - blocks [begin, end) of the row times z)
        const auto solve_row = [&](std::size_t row, std::size_t begin, std::size_t end) {
            double sum[width] = {};
            add_products<Block, Vectors>(matrix_, begin, diagonal_[row], solution, sum);
            if (end > diagonal_[row]) add_products<Block, Vectors>(matrix_, diagonal_[row] + 1, end, solution, sum);
            for (std::size_t e = 0; e < width; ++e) sum[e] = r.data()[row * width + e] - sum[e];
            double* target = solution + row * width;
            std::fill_n(target, width, 0.0);
            add_scaled<Block, Vectors>(inverse_diagonal_.data() + row * Block * Block, sum, target);
        };
        const std::size_t stages = order_.stages.size() - 1;
        for (std::size_t stage = 0; stage < stages; ++stage)
            sweep_stage(stage, [&](std::size_t begin, std::size_t end) {
                for (std::size_t row = begin; row < end; ++row) solve_row(row, matrix_.offsets[row], diagonal_[row]);
            });
        if (coarse_) {
            // After a sweep from zero the lower triangle is satisfied: the residual is what the upper one leaves.
            double* residual = work.residual.data();
            parallel_for(static_cast<std::size_t>(matrix_.rows), rows_per_piece, context, {},
                         [&](std::size_t begin, std::size_t end) {
                             for (std::size_t row = begin; row < end; ++row) {
                                 double sum[width] = {};
                                 add_products<Block, Vectors>(matrix_, diagonal_[row] + 1, matrix_.offsets[row + 1],
                                                              solution, sum);
                                 for (std::size_t e = 0; e < width; ++e) residual[row * width + e] = -sum[e];
                             }
                         });
            work.restricted.resize(restriction_.rows() * Block, Vectors);
            multiply_coarse(restriction_, width, residual, work.restricted.data(), false, context);
            const MultiVector correction = coarse_->apply(work.restricted);
            multiply_coarse(prolongation_, width, correction.data(), solution, true, context);
        }
        for (std::size_t stage = stages; stage-- > 0;)
            sweep_stage(stage, [&](std::size_t begin, std::size_t end) {
                for (std::size_t row = end; row-- > begin;)
                    solve_row(row, matrix_.offsets[row], matrix_.offsets[row + 1]);
            });
    });
}

std::string MultilevelPreconditioner::description() const {
    if (!coarse_) return "Gauss-Seidel";
    return fmt::format("Gauss-Seidel and {} level{} over {} vertices", coarse_->level_count(),
                       coarse_->level_count() == 1 ? "" : "s", prolongation_.cols());
}

}  // namespace curvewright
