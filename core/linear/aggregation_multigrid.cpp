#include "core/linear/aggregation_multigrid.h"

#include <algorithm>
#include <cmath>
#include <span>

#include <Eigen/QR>

#include "core/base/error.h"

namespace curvewright {
namespace {

constexpr Eigen::Index coarsest_size = 800;
constexpr std::size_t most_levels = 12;
constexpr double strength_threshold = 0.08;

using Matrix = SparseRows;

/// Nodes that are strongly coupled: |A_ij| >= theta sqrt(|A_ii| |A_jj|), with Frobenius norms of the blocks.
struct StrengthGraph {
    std::vector<std::size_t> offsets{0};
    std::vector<Index> neighbours;
};

StrengthGraph strong_couplings(const Matrix& a, int block, double threshold) {
    const auto nodes = static_cast<Index>(a.rows() / block);
    StrengthGraph graph;
    std::vector<double> norm(static_cast<std::size_t>(nodes), 0.0), diagonal(norm);
    std::vector<Index> touched;
    for (int pass = 0; pass < 2; ++pass)
        for (Index node = 0; node < nodes; ++node) {
            touched.clear();
            for (int r = 0; r < block; ++r)
                for (Matrix::InnerIterator it(a, node * block + r); it; ++it) {
                    const auto to = static_cast<Index>(it.col() / block);
                    if (norm[to] == 0.0) touched.push_back(to);
                    norm[to] += it.value() * it.value() + 1e-300;
                }
            if (pass == 0) {
                diagonal[node] = norm[node];
            } else {
                for (const Index to : touched)
                    if (to != node && norm[to] >= threshold * threshold * std::sqrt(diagonal[node] * diagonal[to]))
                        graph.neighbours.push_back(to);
                graph.offsets.push_back(graph.neighbours.size());
            }
            for (const Index to : touched) norm[to] = 0.0;
        }
    return graph;
}

/// Aggregate of every node; returns their number.
Index aggregate(const StrengthGraph& graph, std::vector<Index>& aggregate_of) {
    const auto nodes = graph.offsets.size() - 1;
    aggregate_of.assign(nodes, -1);
    Index count = 0;
    const auto of = [&](std::size_t node) {
        return std::span(graph.neighbours).subspan(graph.offsets[node], graph.offsets[node + 1] - graph.offsets[node]);
    };
    // Whole neighbourhoods first, then what touches an aggregate, then the rest among themselves.
    for (std::size_t node = 0; node < nodes; ++node) {
        if (aggregate_of[node] >= 0) continue;
        const auto neighbours = of(node);
        if (std::any_of(neighbours.begin(), neighbours.end(), [&](Index n) { return aggregate_of[n] >= 0; })) continue;
        aggregate_of[node] = count;
        for (const Index n : neighbours) aggregate_of[n] = count;
        ++count;
    }
    std::vector<Index> joined = aggregate_of;
    for (std::size_t node = 0; node < nodes; ++node)
        if (aggregate_of[node] < 0)
            for (const Index n : of(node))
                if (aggregate_of[n] >= 0) {
                    joined[node] = aggregate_of[n];
                    break;
                }
    aggregate_of = std::move(joined);
    for (std::size_t node = 0; node < nodes; ++node) {
        if (aggregate_of[node] >= 0) continue;
        aggregate_of[node] = count;
        for (const Index n : of(node))
            if (aggregate_of[n] < 0) aggregate_of[n] = count;
        ++count;
    }
    return count;
}

/// Largest eigenvalue of D^-1 A by power iteration, with a margin.
double spectral_radius(const Matrix& a, const Eigen::VectorXd& inverse_diagonal) {
    Eigen::VectorXd x(a.rows());
    // A fixed vector without symmetry.
    for (Eigen::Index i = 0; i < x.size(); ++i) x[i] = 1.0 + 0.7 * std::sin(12.9898 * static_cast<double>(i + 1));
    double radius = 1.0;
    for (int iteration = 0; iteration < 12; ++iteration) {
        x /= x.norm();
        x = inverse_diagonal.cwiseProduct(a * x).eval();
        radius = x.norm();
        if (!(radius > 0.0)) return 1.0;
    }
    return 1.05 * radius;
}

}  // namespace

struct AggregationMultigrid::Level {
    Matrix matrix;
    Eigen::VectorXd inverse_diagonal;
    Matrix prolongation, restriction;  ///< from and to the next level

    void smooth_forward(const MultiVector& b, MultiVector& x) const {
        for (Eigen::Index row = 0; row < matrix.rows(); ++row) smooth_row(row, b, x);
    }
    void smooth_backward(const MultiVector& b, MultiVector& x) const {
        for (Eigen::Index row = matrix.rows() - 1; row >= 0; --row) smooth_row(row, b, x);
    }

  private:
    void smooth_row(Eigen::Index row, const MultiVector& b, MultiVector& x) const {
        constexpr Eigen::Index most = 16;
        const Eigen::Index vectors = b.cols();
        double residual[most];
        for (Eigen::Index first = 0; first < vectors; first += most) {
            const Eigen::Index count = std::min(most, vectors - first);
            for (Eigen::Index v = 0; v < count; ++v) residual[v] = b(row, first + v);
            for (Matrix::InnerIterator it(matrix, row); it; ++it) {
                const double* entry = x.data() + it.col() * vectors + first;
                for (Eigen::Index v = 0; v < count; ++v) residual[v] -= it.value() * entry[v];
            }
            for (Eigen::Index v = 0; v < count; ++v) x(row, first + v) += inverse_diagonal[row] * residual[v];
        }
    }
};

AggregationMultigrid::~AggregationMultigrid() = default;
AggregationMultigrid::AggregationMultigrid(AggregationMultigrid&&) noexcept = default;

AggregationMultigrid::AggregationMultigrid(SparseRows matrix, int block, Eigen::MatrixXd near_null,
                                           const TaskContext& context) {
    const auto modes = static_cast<int>(near_null.cols());
    double threshold = strength_threshold;
    while (true) {
        context.check();
        Level level;
        level.matrix = std::move(matrix);
        level.matrix.makeCompressed();
        const Matrix& a = level.matrix;
        level.inverse_diagonal =
            Eigen::VectorXd(a.diagonal()).unaryExpr([](double d) { return std::abs(d) > 0.0 ? 1.0 / d : 0.0; });
        const bool is_last = a.rows() <= coarsest_size || levels_.size() + 1 == most_levels;
        std::vector<Index> aggregate_of;
        Index count = 0;
        if (!is_last) {
            count = aggregate(strong_couplings(a, block, threshold), aggregate_of);
            threshold *= 0.5;
        }
        // Coarsening that hardly coarsens is not worth a level.
        if (is_last || static_cast<Eigen::Index>(count) * modes > a.rows() * 7 / 10) {
            coarsest_ = std::make_unique<Eigen::SparseLU<Eigen::SparseMatrix<double>>>();
            coarsest_->compute(Eigen::SparseMatrix<double>(a));
            levels_.push_back(std::move(level));
            if (coarsest_->info() != Eigen::Success)
                throw SolverFailure("The coarsest level of the multilevel solver is singular.");
            return;
        }

        // Tentative prolongation: the near-null vectors cut into aggregates and made orthonormal there.
        std::vector<std::vector<Index>> members(static_cast<std::size_t>(count));
        for (std::size_t node = 0; node < aggregate_of.size(); ++node)
            members[aggregate_of[node]].push_back(static_cast<Index>(node));
        std::vector<Eigen::Triplet<double>> entries;
        Eigen::MatrixXd coarse_null = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(count) * modes, modes);
        for (Index i = 0; i < count; ++i) {
            const auto rows = static_cast<Eigen::Index>(members[i].size()) * block;
            Eigen::MatrixXd local(rows, modes);
            for (std::size_t m = 0; m < members[i].size(); ++m)
                local.middleRows(static_cast<Eigen::Index>(m) * block, block) =
                    near_null.middleRows(static_cast<Eigen::Index>(members[i][m]) * block, block);
            // Aggregates with fewer rows than modes, or on a line, leave some modes empty: rank-revealing.
            const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(local);
            const Eigen::Index rank = qr.rank();
            const Eigen::MatrixXd q = qr.householderQ() * Eigen::MatrixXd::Identity(rows, rank);
            const Eigen::MatrixXd r = q.transpose() * local;
            coarse_null.middleRows(i * modes, rank) = r;
            for (std::size_t m = 0; m < members[i].size(); ++m)
                for (int d = 0; d < block; ++d)
                    for (Eigen::Index k = 0; k < rank; ++k)
                        entries.emplace_back(members[i][m] * block + d, i * modes + static_cast<int>(k),
                                             q(static_cast<Eigen::Index>(m) * block + d, k));
        }
        Matrix tentative(a.rows(), static_cast<Eigen::Index>(count) * modes);
        tentative.setFromTriplets(entries.begin(), entries.end());
        const double omega = 4.0 / 3.0 / spectral_radius(a, level.inverse_diagonal);
        const Eigen::VectorXd scale = omega * level.inverse_diagonal;
        level.prolongation = tentative - Matrix(scale.asDiagonal() * Matrix(a * tentative));
        level.restriction = level.prolongation.transpose();
        matrix = level.restriction * Matrix(a * level.prolongation);
        // Modes that an aggregate could not carry: a unit diagonal keeps the level regular.
        for (Eigen::Index row = 0; row < matrix.rows(); ++row)
            if (coarse_null.row(row).isZero(0.0)) matrix.coeffRef(row, row) += 1.0;
        near_null = std::move(coarse_null);
        block = modes;
        levels_.push_back(std::move(level));
    }
}

int AggregationMultigrid::level_count() const {
    return static_cast<int>(levels_.size());
}

double AggregationMultigrid::operator_complexity() const {
    double sum = 0.0;
    for (const Level& level : levels_) sum += static_cast<double>(level.matrix.nonZeros());
    return sum / static_cast<double>(levels_.front().matrix.nonZeros());
}

MultiVector AggregationMultigrid::cycle(std::size_t index, const MultiVector& b) const {
    const Level& level = levels_[index];
    if (index + 1 == levels_.size()) return Eigen::MatrixXd(coarsest_->solve(Eigen::MatrixXd(b)));
    MultiVector x = MultiVector::Zero(b.rows(), b.cols());
    level.smooth_forward(b, x);
    const MultiVector residual = b - level.matrix * x;
    x += level.prolongation * cycle(index + 1, level.restriction * residual);
    level.smooth_backward(b, x);
    return x;
}

MultiVector AggregationMultigrid::apply(const MultiVector& b) const {
    return cycle(0, b);
}

}  // namespace curvewright
