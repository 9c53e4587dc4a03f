#include "core/linear/block_matrix.h"

#include <gtest/gtest.h>

#include "core/base/parallel.h"
#include "tests/unit/linear/test_systems.h"

namespace curvewright {
namespace {

using testing::BlockMap;
using testing::dense;
using testing::random_vectors;

/// About four blocks per row, some rows empty.
BlockMap random_blocks(Index rows, Index columns, int block, std::mt19937& random) {
    std::normal_distribution<double> normal;
    std::uniform_int_distribution<Index> row(0, rows - 1), column(0, columns - 1);
    BlockMap blocks;
    for (Index k = 0; k < 4 * rows; ++k) {
        Eigen::MatrixXd value(block, block);
        for (double& entry : value.reshaped()) entry = normal(random);
        blocks[{row(random), column(random)}] = value;
    }
    return blocks;
}

TEST(BlockMatrix, MultipliesLikeADenseMatrix) {
    std::mt19937 random(1);
    for (int block = 1; block <= 3; ++block) {
        const BlockMap blocks = random_blocks(31, 17, block, random);
        const BlockMatrix matrix = testing::block_matrix(blocks, 31, 17, block);
        const Eigen::MatrixXd reference = dense(blocks, 31, 17, block);
        for (int vectors = 0; vectors <= 7; ++vectors) {
            const MultiVector x = random_vectors(17 * block, vectors, 5);
            MultiVector y = MultiVector::Constant(3, 9, 77.0);  // what was there is forgotten
            multiply(matrix, x, y);
            ASSERT_EQ(y.rows(), 31 * block);
            ASSERT_EQ(y.cols(), vectors);
            if (vectors > 0) {
                EXPECT_LT((y - reference * x).cwiseAbs().maxCoeff(), 1e-13) << block << " " << vectors;
            }
        }
    }
}

TEST(BlockMatrix, MultipliesTheSameForEveryThreadCountAndCancels) {
    const BlockMatrix matrix = testing::grid_system(95).matrix;
    const MultiVector x = random_vectors(matrix.rows, 3, 6);
    std::vector<MultiVector> results(3);
    for (std::size_t i = 0; i < 3; ++i) {
        set_thread_count(1 << i);
        multiply(matrix, x, results[i]);
    }
    set_thread_count(0);
    EXPECT_EQ(results[0], results[1]);
    EXPECT_EQ(results[0], results[2]);
    std::stop_source source;
    source.request_stop();
    MultiVector y;
    EXPECT_THROW(multiply(matrix, x, y, {source.get_token(), {}}), Cancelled);
}

TEST(BlockMatrix, ToSparseHasTheSameEntries) {
    std::mt19937 random(2);
    for (int block = 1; block <= 3; ++block) {
        const BlockMap blocks = random_blocks(13, 29, block, random);
        const SparseRows sparse = to_sparse(testing::block_matrix(blocks, 13, 29, block));
        EXPECT_EQ(Eigen::MatrixXd(sparse), dense(blocks, 13, 29, block));
        EXPECT_EQ(sparse.nonZeros(), static_cast<Eigen::Index>(blocks.size()) * block * block);
        EXPECT_TRUE(sparse.isCompressed());
    }
}

TEST(BlockMatrix, GalerkinProductIsThatOfDenseMatrices) {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> uniform(-1.0, 1.0);
    constexpr Index rows = 400, coarse = 270;  // more than one piece of the parallel loop
    const auto random_sparse = [&](Index r, Index c) {
        std::vector<Eigen::Triplet<double>> entries;
        for (Index k = 0; k < 2 * std::max(r, c); ++k)
            entries.emplace_back(static_cast<int>(random() % r), static_cast<int>(random() % c), uniform(random));
        SparseRows result(r, c);
        result.setFromTriplets(entries.begin(), entries.end());
        return result;
    };
    for (int block = 1; block <= 3; ++block) {
        const BlockMap blocks = random_blocks(rows, rows, block, random);
        const SparseRows restriction = random_sparse(coarse, rows), prolongation = random_sparse(rows, coarse);
        const Eigen::MatrixXd product =
            galerkin_product(restriction, testing::block_matrix(blocks, rows, rows, block), prolongation);
        // The outer two act on each unknown of a node alike: entry (i, j) times a unit block.
        const auto widen = [&](const SparseRows& narrow) {
            std::vector<Eigen::Triplet<double>> entries;
            for (Eigen::Index r = 0; r < narrow.rows(); ++r)
                for (SparseRows::InnerIterator it(narrow, r); it; ++it)
                    for (int d = 0; d < block; ++d)
                        entries.emplace_back(it.row() * block + d, it.col() * block + d, it.value());
            SparseRows wide(narrow.rows() * block, narrow.cols() * block);
            wide.setFromTriplets(entries.begin(), entries.end());
            return wide;
        };
        const Eigen::MatrixXd reference =
            widen(restriction) * (dense(blocks, rows, rows, block) * Eigen::MatrixXd(widen(prolongation)));
        EXPECT_LT((product - reference).cwiseAbs().maxCoeff(), 1e-12) << block;
    }
}

}  // namespace
}  // namespace curvewright
