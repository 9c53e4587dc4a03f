#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/SparseCore>

#include "core/base/ids.h"
#include "core/base/task.h"
#include "core/linear/multi_vector.h"

namespace curvewright {

/// Sparse matrix, compressed by rows.
using SparseRows = Eigen::SparseMatrix<double, Eigen::RowMajor>;

/// A sparse matrix of small square blocks, compressed by rows: one block row per node of a mesh, one row and column of
/// the block per unknown of the node (1 for a scalar field, the dimension for a displacement).
struct BlockMatrix {
    int block = 1;                        ///< rows and columns of a block, 1 to 3
    Index rows = 0, columns = 0;          ///< in blocks
    std::vector<std::size_t> offsets{0};  ///< rows + 1
    std::vector<Index> column_of;         ///< per stored block; ascending in a row
    std::vector<double> values;           ///< per stored block: block × block, row-major

    std::size_t block_count() const { return column_of.size(); }
    double* block_at(std::size_t k) { return values.data() + k * static_cast<std::size_t>(block * block); }
    const double* block_at(std::size_t k) const { return values.data() + k * static_cast<std::size_t>(block * block); }
};

/// Calls call.template operator()<Block, Vectors>() with block (1 to 3) and vectors (1 to 4) as constants.
template <class Call>
void with_sizes(int block, Eigen::Index vectors, const Call& call) {
    const auto with_block = [&]<int Block>() {
        switch (vectors) {
            case 1:
                return call.template operator()<Block, 1>();
            case 2:
                return call.template operator()<Block, 2>();
            case 3:
                return call.template operator()<Block, 3>();
            default:
                return call.template operator()<Block, 4>();
        }
    };
    switch (block) {
        case 1:
            return with_block.template operator()<1>();
        case 2:
            return with_block.template operator()<2>();
        default:
            return with_block.template operator()<3>();
    }
}

/// sum over the blocks [begin, end) of one row times x, added to sum (Block × Vectors).
template <int Block, int Vectors>
inline void add_products(const BlockMatrix& matrix, std::size_t begin, std::size_t end, const double* x, double* sum) {
    const double* value = matrix.values.data() + begin * (Block * Block);
    for (std::size_t k = begin; k < end; ++k, value += Block * Block) {
        const double* entry = x + static_cast<std::size_t>(matrix.column_of[k]) * (Block * Vectors);
        for (int r = 0; r < Block; ++r)
            for (int c = 0; c < Block; ++c)
                for (int v = 0; v < Vectors; ++v) sum[r * Vectors + v] += value[r * Block + c] * entry[c * Vectors + v];
    }
}

/// y = matrix x. x: (columns · block) × any number of vectors. Multi-threaded, same result for every thread count.
/// Throws Cancelled.
void multiply(const BlockMatrix& matrix, const MultiVector& x, MultiVector& y, const TaskContext& context = {});

/// The same matrix entry by entry.
SparseRows to_sparse(const BlockMatrix& matrix);

/// restriction matrix prolongation, entry by entry, where the outer two (coarse size × rows, rows × coarse size) act on
/// each unknown of a node alike. Multi-threaded.
SparseRows galerkin_product(const SparseRows& restriction, const BlockMatrix& matrix, const SparseRows& prolongation,
                            const TaskContext& context = {});

}  // namespace curvewright
