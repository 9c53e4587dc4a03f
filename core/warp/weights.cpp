#include "core/warp/weights.h"

#include <cmath>
#include <limits>

#include <Eigen/Cholesky>
#include <Eigen/QR>

#include "core/base/parallel.h"

namespace curvewright {
namespace {

constexpr double degenerate_pivot = 1e-10;

template <int Dim>
PatchStatus affine_weights_of(const Eigen::Ref<const Eigen::MatrixXd>& offsets,
                              const Eigen::Ref<const Eigen::VectorXd>& influence, Eigen::Ref<Eigen::VectorXd> weights) {
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
        gram.noalias() += influence[j] * a * a.transpose();
    }
    const Row b = Row::Unit(Dim);
    const Eigen::LDLT<Gram> factor(gram);
    const auto pivots = factor.vectorD();
    if (factor.info() == Eigen::Success && pivots.minCoeff() > degenerate_pivot * pivots.maxCoeff()) {
        // One step of refinement: stretched patches have Gram matrices of condition (aspect ratio)^2.
        Row lambda = factor.solve(b);
        lambda += factor.solve(b - gram * lambda);
        for (Eigen::Index j = 0; j < n; ++j) weights[j] = influence[j] * row(j).dot(lambda);
        return PatchStatus::regular;
    }
    // In v_j = w_j / sqrt(c_j) the weights of least norm are sought.
    Eigen::MatrixXd a(Dim + 1, n);
    for (Eigen::Index j = 0; j < n; ++j) a.col(j) = std::sqrt(influence[j]) * row(j);
    const Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> orthogonal(a);
    weights = influence.cwiseSqrt().cwiseProduct(orthogonal.solve(Eigen::VectorXd(b)));
    return orthogonal.rank() == Dim + 1 ? PatchStatus::regular : PatchStatus::degenerate;
}

template <int Dim>
PatchStatus convex_weights_of(const Eigen::Ref<const Eigen::MatrixXd>& offsets,
                              const Eigen::Ref<const Eigen::VectorXd>& influence, Eigen::Ref<Eigen::VectorXd> weights) {
    using Vector = Eigen::Matrix<double, Dim, 1>;
    using Matrix = Eigen::Matrix<double, Dim, Dim>;
    const Eigen::Index n = offsets.rows();
    const double total = influence.sum();
    // Whiten the patch (offsets times the inverse Cholesky factor of their second moment): the solution does not
    // change, but stretched patches become round and the Hessian well conditioned.
    Matrix moment = Matrix::Zero();
    for (Eigen::Index j = 0; j < n; ++j) {
        const Vector y = offsets.row(j).transpose();
        moment.noalias() += influence[j] / total * y * y.transpose();
    }
    const double largest = moment.diagonal().maxCoeff();
    if (!(largest > 0.0)) return PatchStatus::outside_hull;
    const Eigen::LLT<Matrix> cholesky(moment);
    if (cholesky.info() != Eigen::Success || cholesky.matrixLLT().diagonal().minCoeff() <= 1e-10 * std::sqrt(largest))
        return PatchStatus::outside_hull;
    const Eigen::Matrix<double, Dim, Eigen::Dynamic> y = cholesky.matrixL().solve(offsets.transpose());

    /// sum c_j log(total + g·y_j); -infinity outside the domain.
    const auto objective = [&](const Vector& g) {
        double sum = 0.0;
        for (Eigen::Index j = 0; j < n; ++j) {
            const double q = total + g.dot(y.col(j));
            if (!(q > 0.0)) return -std::numeric_limits<double>::infinity();
            sum += influence[j] * std::log(q);
        }
        return sum;
    };
    Vector g = Vector::Zero();
    double value = objective(g), last_slope = std::numeric_limits<double>::infinity();
    constexpr int max_iterations = 100;
    for (int iteration = 0; iteration < max_iterations; ++iteration) {
        Vector gradient = Vector::Zero();
        Matrix hessian = Matrix::Zero();
        for (Eigen::Index j = 0; j < n; ++j) {
            const double q = 1.0 / (total + g.dot(y.col(j)));
            gradient += influence[j] * q * y.col(j);
            hessian.noalias() += (influence[j] * q * q) * y.col(j) * y.col(j).transpose();
        }
        const Vector step = Eigen::LDLT<Matrix>(hessian).solve(gradient);
        const double slope = gradient.dot(step);  // square of the Newton decrement
        if (!(slope >= 0.0) || !std::isfinite(slope)) return PatchStatus::outside_hull;
        // Down to where rounding stops the decrease. There the objective is flat to rounding: no line search.
        const bool is_near = slope < 1e-10 * total;
        if (slope < 1e-30 * total || (is_near && slope >= last_slope)) {
            for (Eigen::Index j = 0; j < n; ++j) weights[j] = influence[j] / (total + g.dot(y.col(j)));
            if (!(weights.minCoeff() > 0.0)) return PatchStatus::outside_hull;
            weights /= weights.sum();
            return PatchStatus::regular;
        }
        last_slope = slope;
        double t = 1.0, next = objective(g + step);
        while (!(is_near ? std::isfinite(next) : next >= value + 1e-4 * t * slope) && t > 1e-12) {
            t *= 0.5;
            next = objective(g + t * step);
        }
        g += t * step;
        value = next;
    }
    return PatchStatus::outside_hull;
}

}  // namespace

Eigen::VectorXd influences(const Eigen::Ref<const Eigen::MatrixXd>& offsets, double power) {
    if (power == 0.0) return Eigen::VectorXd::Ones(offsets.rows());
    const Eigen::VectorXd distance = offsets.rowwise().norm();
    const double mean = distance.mean();
    if (!(mean > 0.0)) return Eigen::VectorXd::Ones(offsets.rows());
    // Bounded, because a ratio of c between neighbours costs as many digits of the weights.
    const Eigen::VectorXd influence =
        (distance / mean).cwiseMax(1e-6).array().pow(-power).cwiseMax(1e-3).cwiseMin(1e3).matrix();
    return influence / influence.mean();
}

PatchStatus affine_weights(const Eigen::Ref<const Eigen::MatrixXd>& offsets,
                           const Eigen::Ref<const Eigen::VectorXd>& influence, Eigen::Ref<Eigen::VectorXd> weights) {
    return offsets.cols() == 2 ? affine_weights_of<2>(offsets, influence, weights)
                               : affine_weights_of<3>(offsets, influence, weights);
}

PatchStatus convex_weights(const Eigen::Ref<const Eigen::MatrixXd>& offsets,
                           const Eigen::Ref<const Eigen::VectorXd>& influence, Eigen::Ref<Eigen::VectorXd> weights) {
    return offsets.cols() == 2 ? convex_weights_of<2>(offsets, influence, weights)
                               : convex_weights_of<3>(offsets, influence, weights);
}

WeightTable compute_weights(const CurvedMesh& mesh, const NeighbourSets& sets, Weighting weighting,
                            double distance_power, const TaskContext& context) {
    const auto& interior = sets.centers;
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
                offsets.row(j) =
                    (mesh.coordinates().row(neighbours[j]) - mesh.coordinates().row(interior[i])).head(dim);
            Eigen::Map<Eigen::VectorXd> weights(table.weights.data() + sets.offsets[i], count);
            const Eigen::VectorXd influence = influences(offsets, distance_power);
            PatchStatus status = PatchStatus::outside_hull;
            if (weighting == Weighting::convex) status = convex_weights(offsets, influence, weights);
            if (status == PatchStatus::regular) continue;
            const PatchStatus affine = affine_weights(offsets, influence, weights);
            const bool convex_failed = weighting == Weighting::convex && affine == PatchStatus::regular;
            table.status[i] = convex_failed ? PatchStatus::outside_hull : affine;
        }
    });
    return table;
}

}  // namespace curvewright
