#pragma once

#include <map>
#include <random>
#include <utility>

#include <Eigen/Core>

#include "core/linear/linear_solver.h"

namespace curvewright::testing {

/// Blocks by row and column.
using BlockMap = std::map<std::pair<Index, Index>, Eigen::MatrixXd>;

inline BlockMatrix block_matrix(const BlockMap& blocks, Index rows, Index columns, int block) {
    BlockMatrix matrix;
    matrix.block = block;
    matrix.rows = rows;
    matrix.columns = columns;
    matrix.offsets.assign(static_cast<std::size_t>(rows) + 1, 0);
    for (const auto& [place, value] : blocks) {
        ++matrix.offsets[static_cast<std::size_t>(place.first) + 1];
        matrix.column_of.push_back(place.second);
        for (int r = 0; r < block; ++r)
            for (int c = 0; c < block; ++c) matrix.values.push_back(value(r, c));
    }
    for (std::size_t row = 0; row < static_cast<std::size_t>(rows); ++row)
        matrix.offsets[row + 1] += matrix.offsets[row];
    return matrix;
}

inline Eigen::MatrixXd dense(const BlockMap& blocks, Index rows, Index columns, int block) {
    Eigen::MatrixXd result = Eigen::MatrixXd::Zero(rows * block, columns * block);
    for (const auto& [place, value] : blocks)
        result.block(place.first * block, place.second * block, block, block) = value;
    return result;
}

inline MultiVector random_vectors(Eigen::Index rows, Eigen::Index columns, unsigned seed) {
    std::mt19937 random(seed);
    std::normal_distribution<double> normal;
    MultiVector result(rows, columns);
    for (double& value : result.reshaped()) value = normal(random);
    return result;
}

/// Five-point Laplacian of the unit square (zero on its boundary) on n × n inner points, n odd, times a positive
/// definite block that couples the unknowns of a point; with the convection's part of every row skew. Coarse space:
/// bilinear functions on every other point. Points are numbered in bands of lines, first the even bands, then the odd
/// ones: those of one kind are not coupled, and can be swept together.
inline LinearSystem grid_system(int n, int block = 1, double convection = 0.0, bool has_stages = true) {
    constexpr int lines = 4;
    const int bands = (n + lines - 1) / lines;
    std::vector<Index> number(static_cast<std::size_t>(n * n));
    LinearSystem system;
    Index next = 0;
    for (int parity = 0; parity < 2; ++parity) {
        system.sweep.stages.push_back(static_cast<Index>(system.sweep.pieces.size()));
        for (int band = parity; band < bands; band += 2) {
            system.sweep.pieces.push_back(next);
            for (int j = band * lines; j < std::min(n, (band + 1) * lines); ++j)
                for (int i = 0; i < n; ++i) number[static_cast<std::size_t>(j * n + i)] = next++;
        }
    }
    system.sweep.stages.push_back(static_cast<Index>(system.sweep.pieces.size()));
    system.sweep.pieces.push_back(next);
    if (!has_stages) system.sweep = {};

    const Eigen::MatrixXd unit =
        0.7 * Eigen::MatrixXd::Identity(block, block) + Eigen::MatrixXd::Constant(block, block, 0.3 / block);
    BlockMap blocks;
    const double skew = convection / (n + 1);
    const auto at = [&](int i, int j) { return number[static_cast<std::size_t>(j * n + i)]; };
    for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i) {
            blocks[{at(i, j), at(i, j)}] = 4.0 * unit;
            if (i > 0) blocks[{at(i, j), at(i - 1, j)}] = -(1.0 + skew) * unit;
            if (i + 1 < n) blocks[{at(i, j), at(i + 1, j)}] = -(1.0 - skew) * unit;
            if (j > 0) blocks[{at(i, j), at(i, j - 1)}] = -(1.0 + 0.5 * skew) * unit;
            if (j + 1 < n) blocks[{at(i, j), at(i, j + 1)}] = -(1.0 - 0.5 * skew) * unit;
        }
    system.matrix = block_matrix(blocks, n * n, n * n, block);
    system.is_symmetric = convection == 0.0;

    const int m = n / 2;  // coarse points at 1, 3, 5, …
    std::vector<Eigen::Triplet<double>> entries;
    for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i)
            for (int q = 0; q < m; ++q)
                for (int p = 0; p < m; ++p) {
                    const int di = std::abs(i - 2 * p - 1), dj = std::abs(j - 2 * q - 1);
                    if (di < 2 && dj < 2)
                        entries.emplace_back(at(i, j), q * m + p, (di ? 0.5 : 1.0) * (dj ? 0.5 : 1.0));
                    if (dj >= 2) break;
                }
    system.coarse.prolongation.resize(n * n, m * m);
    system.coarse.prolongation.setFromTriplets(entries.begin(), entries.end());
    system.coarse.near_null = Eigen::MatrixXd::Identity(block, block).replicate(m * m, 1);
    return system;
}

}  // namespace curvewright::testing
