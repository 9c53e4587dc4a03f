#include "core/warp/weights.h"

#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/QR>

#include "core/base/parallel.h"

namespace curvewright {
namespace {

constexpr double degenerate_pivot = 1e-10;

template <int Dim>
PatchStatus affine_weights_of(const Eigen::Ref<const Eigen::MatrixXd>& offsets, Eigen::Ref<Eigen::VectorXd> weights) {
    const Eigen::Index n = offsets.rows();
    double scale = offsets.cwiseAbs().maxCoeff();
    if (!(scale > 0.0)) scale = 1.0;
    using Row = Eigen::Matrix<double, Dim + 1, 1>;
    using Gram = Eigen::Matrix<double, Dim + 1, Dim + 1>;
    const auto row = [&](Eigen::Index j) {
        Row a;
        for (int d = 0; d < Dim; ++d) a[d] = offsets(j, d) / scale;
        a[Dim] = 1.0;
        return a;
    };
    Gram gram = Gram::Zero();
    for (Eigen::Index j = 0; j < n; ++j) {
        const Row a = row(j);
        gram.noalias() += a * a.transpose();
    }
    const Row b = Row::Unit(Dim);
    const Eigen::LDLT<Gram> factor(gram);
    const auto pivots = factor.vectorD();
    if (factor.info() == Eigen::Success && pivots.minCoeff() > degenerate_pivot * pivots.maxCoeff()) {
        // One step of refinement: stretched patches have Gram matrices of condition (aspect ratio)^2.
        Row lambda = factor.solve(b);
        lambda += factor.solve(b - gram * lambda);
        for (Eigen::Index j = 0; j < n; ++j) weights[j] = row(j).dot(lambda);
        return PatchStatus::regular;
    }
    Eigen::MatrixXd a(Dim + 1, n);
    for (Eigen::Index j = 0; j < n; ++j) a.col(j) = row(j);
    const Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> orthogonal(a);
    weights = orthogonal.solve(Eigen::VectorXd(b));
    return orthogonal.rank() == Dim + 1 ? PatchStatus::regular : PatchStatus::degenerate;
}

template <int Dim>
PatchStatus convex_weights_of(const Eigen::Ref<const Eigen::MatrixXd>& offsets, Eigen::Ref<Eigen::VectorXd> weights) {
    using Vector = Eigen::Matrix<double, Dim, 1>;
    using Matrix = Eigen::Matrix<double, Dim, Dim>;
    const Eigen::Index n = offsets.rows();
    const double count = static_cast<double>(n);
    // Whiten the patch (offsets times the inverse Cholesky factor of their second moment): the solution does not change,
    // but stretched patches become round and the Hessian well conditioned.
    Matrix moment = Matrix::Zero();
    for (Eigen::Index j = 0; j < n; ++j) {
        const Vector y = offsets.row(j).transpose();
        moment.noalias() += y * y.transpose();
    }
    moment /= count;
    const double largest = moment.diagonal().maxCoeff();
    if (!(largest > 0.0)) return PatchStatus::outside_hull;
    const Eigen::LLT<Matrix> cholesky(moment);
    if (cholesky.info() != Eigen::Success ||
        cholesky.matrixLLT().diagonal().minCoeff() <= 1e-10 * std::sqrt(largest))
        return PatchStatus::outside_hull;
    Eigen::Matrix<double, Dim, Eigen::Dynamic> y = cholesky.matrixL().solve(offsets.transpose());

    Vector g = Vector::Zero();
    constexpr int max_iterations = 200;
    for (int iteration = 0; iteration < max_iterations; ++iteration) {
        Vector gradient = Vector::Zero();
        Matrix hessian = Matrix::Zero();
        for (Eigen::Index j = 0; j < n; ++j) {
            const double w = 1.0 / (count + g.dot(y.col(j)));
            gradient += w * y.col(j);
            hessian.noalias() += (w * w) * y.col(j) * y.col(j).transpose();
        }
        const Eigen::LDLT<Matrix> factor(hessian);
        const Vector step = factor.solve(gradient);
        const double decrement_squared = gradient.dot(step);
        if (!(decrement_squared >= 0.0) || !std::isfinite(decrement_squared)) return PatchStatus::outside_hull;
        const double decrement = std::sqrt(decrement_squared);
        g += decrement > 0.25 ? Vector(step / (1.0 + decrement)) : step;
        // Quadratic convergence: from 1e-7 one more full step reaches rounding, and it has just been made.
        if (decrement < 1e-7) {
            double sum = 0.0;
            for (Eigen::Index j = 0; j < n; ++j) {
                weights[j] = 1.0 / (count + g.dot(y.col(j)));
                sum += weights[j];
            }
            weights /= sum;
            return weights.minCoeff() > 0.0 ? PatchStatus::regular : PatchStatus::outside_hull;
        }
    }
    return PatchStatus::outside_hull;
}

}  // namespace

PatchStatus affine_weights(const Eigen::Ref<const Eigen::MatrixXd>& offsets, Eigen::Ref<Eigen::VectorXd> weights) {
    return offsets.cols() == 2 ? affine_weights_of<2>(offsets, weights) : affine_weights_of<3>(offsets, weights);
}

PatchStatus convex_weights(const Eigen::Ref<const Eigen::MatrixXd>& offsets, Eigen::Ref<Eigen::VectorXd> weights) {
    return offsets.cols() == 2 ? convex_weights_of<2>(offsets, weights) : convex_weights_of<3>(offsets, weights);
}

WeightTable compute_weights(const CurvedMesh& mesh, const NeighbourSets& sets, Weighting weighting,
                            const TaskContext& context) {
    const auto& interior = mesh.topology().interior_nodes();
    const int dim = mesh.topology().dimension();
    WeightTable table;
    table.weights.resize(sets.nodes.size());
    table.status.assign(interior.size(), PatchStatus::regular);
    parallel_for(interior.size(), 256, context, "Computing weights", [&](std::size_t begin, std::size_t end) {
        Eigen::MatrixXd offsets;
        for (std::size_t i = begin; i < end; ++i) {
            const auto neighbours = sets.of(i);
            const auto count = static_cast<Eigen::Index>(neighbours.size());
            offsets.resize(count, dim);
            for (Eigen::Index j = 0; j < count; ++j)
                offsets.row(j) = (mesh.coordinates().row(neighbours[j]) - mesh.coordinates().row(interior[i])).head(dim);
            Eigen::Map<Eigen::VectorXd> weights(table.weights.data() + sets.offsets[i], count);
            PatchStatus status = PatchStatus::outside_hull;
            if (weighting == Weighting::convex) status = convex_weights(offsets, weights);
            if (status == PatchStatus::regular) continue;
            const PatchStatus affine = affine_weights(offsets, weights);
            const bool convex_failed = weighting == Weighting::convex && affine == PatchStatus::regular;
            table.status[i] = convex_failed ? PatchStatus::outside_hull : affine;
        }
    });
    return table;
}

}  // namespace curvewright
