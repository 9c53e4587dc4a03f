#include "core/linear/block_matrix.h"

#include <algorithm>

#include "core/base/parallel.h"

namespace curvewright {
namespace {

constexpr std::size_t rows_per_piece = 2048;

template <int Block, int Vectors>
void multiply_vectors(const BlockMatrix& matrix, const double* x, double* y, const TaskContext& context) {
    parallel_for(static_cast<std::size_t>(matrix.rows), rows_per_piece, context, {},
                 [&](std::size_t begin, std::size_t end) {
                     for (std::size_t row = begin; row < end; ++row) {
                         double sum[Block * Vectors] = {};
                         add_products<Block, Vectors>(matrix, matrix.offsets[row], matrix.offsets[row + 1], x, sum);
                         std::copy_n(sum, Block * Vectors, y + row * (Block * Vectors));
                     }
                 });
}

}  // namespace

void multiply(const BlockMatrix& matrix, const MultiVector& x, MultiVector& y, const TaskContext& context) {
    y.resize(static_cast<Eigen::Index>(matrix.rows) * matrix.block, x.cols());
    constexpr Eigen::Index most = 4;
    if (x.cols() <= most) {
        if (x.cols() > 0)
            with_sizes(matrix.block, x.cols(), [&]<int Block, int Vectors>() {
                multiply_vectors<Block, Vectors>(matrix, x.data(), y.data(), context);
            });
        return;
    }
    MultiVector part, product;
    for (Eigen::Index first = 0; first < x.cols(); first += most) {
        const Eigen::Index count = std::min(most, x.cols() - first);
        part = x.middleCols(first, count);
        multiply(matrix, part, product, context);
        y.middleCols(first, count) = product;
    }
}

SparseRows to_sparse(const BlockMatrix& matrix) {
    const int b = matrix.block;
    SparseRows result(static_cast<Eigen::Index>(matrix.rows) * b, static_cast<Eigen::Index>(matrix.columns) * b);
    result.reserve(static_cast<Eigen::Index>(matrix.values.size()));
    for (Index row = 0; row < matrix.rows; ++row)
        for (int r = 0; r < b; ++r) {
            result.startVec(row * b + r);
            for (std::size_t k = matrix.offsets[row]; k < matrix.offsets[row + 1]; ++k)
                for (int c = 0; c < b; ++c)
                    result.insertBack(row * b + r, matrix.column_of[k] * b + c) = matrix.block_at(k)[r * b + c];
        }
    result.finalize();
    return result;
}

SparseRows galerkin_product(const SparseRows& restriction, const BlockMatrix& matrix, const SparseRows& prolongation,
                            const TaskContext& context) {
    const int b = matrix.block;
    const auto size = static_cast<std::size_t>(restriction.rows());
    // Rows of the product, gathered piece by piece: the columns of a row and their blocks.
    struct Piece {
        std::vector<std::size_t> counts;
        std::vector<Index> columns;
        std::vector<double> blocks;
    };
    const std::size_t grain = std::max<std::size_t>(256, size / 64 + 1);
    std::vector<Piece> pieces((size + grain - 1) / grain);
    parallel_for(size, grain, context, {}, [&](std::size_t begin, std::size_t end) {
        Piece& piece = pieces[begin / grain];
        std::vector<Index> position(size, -1);
        std::vector<Index> columns;
        std::vector<double> blocks;
        std::vector<std::size_t> order;
        for (std::size_t row = begin; row < end; ++row) {
            columns.clear();
            blocks.clear();
            for (SparseRows::InnerIterator fine(restriction, static_cast<Eigen::Index>(row)); fine; ++fine)
                for (std::size_t k = matrix.offsets[fine.col()]; k < matrix.offsets[fine.col() + 1]; ++k)
                    for (SparseRows::InnerIterator to(prolongation, matrix.column_of[k]); to; ++to) {
                        Index& place = position[to.col()];
                        if (place < 0) {
                            place = static_cast<Index>(columns.size());
                            columns.push_back(static_cast<Index>(to.col()));
                            blocks.resize(blocks.size() + static_cast<std::size_t>(b * b), 0.0);
                        }
                        const double factor = fine.value() * to.value();
                        const double* value = matrix.block_at(k);
                        double* target = blocks.data() + static_cast<std::size_t>(place * b * b);
                        for (int e = 0; e < b * b; ++e) target[e] += factor * value[e];
                    }
            order.resize(columns.size());
            for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
            std::sort(order.begin(), order.end(), [&](auto p, auto q) { return columns[p] < columns[q]; });
            piece.counts.push_back(columns.size());
            for (const std::size_t i : order) {
                piece.columns.push_back(columns[i]);
                piece.blocks.insert(piece.blocks.end(), blocks.begin() + static_cast<std::ptrdiff_t>(i) * b * b,
                                    blocks.begin() + static_cast<std::ptrdiff_t>(i + 1) * b * b);
                position[columns[i]] = -1;
            }
        }
    });
    std::size_t total = 0;
    for (const Piece& piece : pieces) total += piece.blocks.size();
    SparseRows result(static_cast<Eigen::Index>(size) * b, static_cast<Eigen::Index>(size) * b);
    result.reserve(static_cast<Eigen::Index>(total));
    Eigen::Index row = 0;
    for (const Piece& piece : pieces) {
        std::size_t first = 0;
        for (const std::size_t count : piece.counts) {
            for (int r = 0; r < b; ++r, ++row) {
                result.startVec(row);
                for (std::size_t i = first; i < first + count; ++i)
                    for (int c = 0; c < b; ++c)
                        result.insertBack(row, piece.columns[i] * b + c) =
                            piece.blocks[i * static_cast<std::size_t>(b * b) + static_cast<std::size_t>(r * b + c)];
            }
            first += count;
        }
    }
    result.finalize();
    return result;
}

}  // namespace curvewright
