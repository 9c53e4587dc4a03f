#include "core/warp/weights.h"

#include <algorithm>
#include <array>
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
    if (n == 0) return PatchStatus::degenerate;
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

/// Arrays that the patches of one thread share.
struct ConvexScratch {
    std::vector<double> whitened;  ///< dimension × neighbours
    std::vector<double> q;         ///< neighbours
    void resize(std::size_t size, std::size_t dim) {
        if (q.size() >= size) return;
        q.resize(size);
        whitened.resize(size * dim);
    }
};

template <int Dim>
PatchStatus convex_weights_of(const Eigen::Ref<const Eigen::MatrixXd>& offsets,
                              const Eigen::Ref<const Eigen::VectorXd>& influence, Eigen::Ref<Eigen::VectorXd> weights) {
    using Vector = Eigen::Matrix<double, Dim, 1>;
    using Matrix = Eigen::Matrix<double, Dim, Dim>;
    const auto n = static_cast<std::size_t>(offsets.rows());
    const double* c = influence.data();
    std::array<const double*, Dim> offset;
    for (int d = 0; d < Dim; ++d) offset[d] = offsets.data() + d * offsets.outerStride();
    double total = 0.0;
    for (std::size_t j = 0; j < n; ++j) total += c[j];
    // Whiten the patch (offsets times the inverse Cholesky factor of their second moment): the solution does not
    // change, but stretched patches become round and the Hessian well conditioned.
    Matrix moment = Matrix::Zero();
    for (int r = 0; r < Dim; ++r)
        for (int s = 0; s <= r; ++s) {
            double sum = 0.0;
            for (std::size_t j = 0; j < n; ++j) sum += c[j] * offset[r][j] * offset[s][j];
            moment(r, s) = moment(s, r) = sum / total;
        }
    const double largest = moment.diagonal().maxCoeff();
    if (!(largest > 0.0)) return PatchStatus::outside_hull;
    const Eigen::LLT<Matrix> cholesky(moment);
    if (cholesky.info() != Eigen::Success || cholesky.matrixLLT().diagonal().minCoeff() <= 1e-10 * std::sqrt(largest))
        return PatchStatus::outside_hull;
    const Matrix whitening = cholesky.matrixL().solve(Matrix::Identity());
    thread_local ConvexScratch scratch;
    scratch.resize(n, 3);
    std::array<double*, Dim> y;
    for (int d = 0; d < Dim; ++d) {
        y[d] = scratch.whitened.data() + static_cast<std::size_t>(d) * n;
        for (std::size_t j = 0; j < n; ++j) {
            double sum = 0.0;
            for (int e = 0; e <= d; ++e) sum += whitening(d, e) * offset[e][j];
            y[d][j] = sum;
        }
    }
    double* q = scratch.q.data();
    const auto evaluate = [&](const Vector& g) {
        for (std::size_t j = 0; j < n; ++j) {
            double value = total;
            for (int d = 0; d < Dim; ++d) value += g[d] * y[d][j];
            q[j] = value;
        }
    };
    const auto accept = [&](const Vector& g) {
        evaluate(g);
        double sum = 0.0;
        for (std::size_t j = 0; j < n; ++j) {
            if (!(q[j] > 0.0)) return PatchStatus::outside_hull;
            sum += c[j] / q[j];
        }
        for (std::size_t j = 0; j < n; ++j) weights[static_cast<Eigen::Index>(j)] = c[j] / (q[j] * sum);
        return PatchStatus::regular;
    };

    Vector g = Vector::Zero(), step = Vector::Zero();
    double length = 0.0, last_slope = std::numeric_limits<double>::infinity();
    evaluate(g);
    constexpr int max_iterations = 100;
    for (int iteration = 0; iteration < max_iterations; ++iteration) {
        Vector gradient = Vector::Zero();
        Matrix hessian = Matrix::Zero();
        for (std::size_t j = 0; j < n; ++j) {
            const double inverse = 1.0 / q[j], first = c[j] * inverse, second = first * inverse;
            for (int r = 0; r < Dim; ++r) {
                gradient[r] += first * y[r][j];
                const double product = second * y[r][j];
                for (int s = 0; s <= r; ++s) hessian(r, s) += product * y[s][j];
            }
        }
        // A step is too long when the objective falls at its end nearly as steeply as it rose at its beginning.
        const bool was_near = last_slope < 1e-10 * total;
        if (iteration > 0 && !was_near && gradient.dot(step) < -0.5 * last_slope && length > 1e-12) {
            g -= 0.5 * length * step;
            length *= 0.5;
            evaluate(g);
            continue;
        }
        hessian = hessian.template selfadjointView<Eigen::Lower>();
        step = Eigen::LDLT<Matrix>(hessian).solve(gradient);
        const double slope = gradient.dot(step);  // square of the Newton decrement
        if (!(slope >= 0.0) || !std::isfinite(slope)) return PatchStatus::outside_hull;
        // The next step would be below rounding, or rounding has stopped the decrease.
        if (slope < 1e-18 * total) return accept(g + step);
        if (was_near && slope >= last_slope) return accept(g);
        last_slope = slope;
        // As far as q stays positive.
        length = 1.0;
        for (std::size_t j = 0; j < n; ++j) {
            double change = 0.0;
            for (int d = 0; d < Dim; ++d) change += step[d] * y[d][j];
            if (-change * length > 0.95 * q[j]) length = -0.95 * q[j] / change;
        }
        g += length * step;
        if (g.squaredNorm() > 1e20 * total * total) return PatchStatus::outside_hull;
        evaluate(g);
    }
    return PatchStatus::outside_hull;
}

}  // namespace

double real_power(double base, double exponent) {
    const double size = std::abs(exponent);
    if (size > 8.0 || size != std::floor(size)) return std::pow(base, exponent);
    double result = 1.0;
    for (int i = 0; i < static_cast<int>(size); ++i) result *= base;
    return exponent < 0.0 ? 1.0 / result : result;
}

Eigen::VectorXd influences(const Eigen::Ref<const Eigen::MatrixXd>& offsets, double distance_power) {
    if (distance_power == 0.0) return Eigen::VectorXd::Ones(offsets.rows());
    Eigen::VectorXd influence = offsets.rowwise().norm();
    const double mean = influence.mean();
    if (!(mean > 0.0)) return Eigen::VectorXd::Ones(offsets.rows());
    // Bounded, because a ratio of c between neighbours costs as many digits of the weights.
    double sum = 0.0;
    for (double& c : influence) {
        c = std::clamp(real_power(std::max(c / mean, 1e-6), -distance_power), 1e-3, 1e3);
        sum += c;
    }
    return influence * (static_cast<double>(influence.size()) / sum);
}

Eigen::VectorXd influences(const Patch& patch, const InfluenceOptions& options) {
    Eigen::VectorXd influence = influences(patch.offsets, options.distance_power);
    if (options.sharing_power == 0.0) return influence;
    for (Eigen::Index j = 0; j < influence.size(); ++j) {
        const double shared = patch.shared_elements[static_cast<std::size_t>(j)];
        influence[j] *= real_power(shared, options.sharing_power);
    }
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

WeightFunction convex_weighting(double distance_power, double sharing_power) {
    return [options = InfluenceOptions{distance_power, sharing_power}](const Patch& patch,
                                                                       Eigen::Ref<Eigen::VectorXd> weights) {
        const Eigen::VectorXd influence = influences(patch, options);
        if (convex_weights(patch.offsets, influence, weights) == PatchStatus::regular) return PatchStatus::regular;
        const PatchStatus affine = affine_weights(patch.offsets, influence, weights);
        return affine == PatchStatus::regular ? PatchStatus::outside_hull : affine;
    };
}

WeightFunction affine_weighting(double distance_power, double sharing_power) {
    return [options = InfluenceOptions{distance_power, sharing_power}](const Patch& patch,
                                                                       Eigen::Ref<Eigen::VectorXd> weights) {
        return affine_weights(patch.offsets, influences(patch, options), weights);
    };
}

namespace {

/// The weights of a patch and its image behind the plane with a normal (dimension entries), added up. Arguments as
/// in Patch.
PatchStatus mirrored_weights(Index center, std::span<const Index> neighbours,
                             const Eigen::Ref<const Eigen::MatrixXd>& offsets, std::span<const std::uint16_t> shared,
                             const Eigen::VectorXd& normal, const WeightFunction& weighting,
                             Eigen::Ref<Eigen::VectorXd> weights) {
    const Eigen::Index count = offsets.rows();
    Eigen::MatrixXd both(2 * count, offsets.cols());
    both.topRows(count) = offsets;
    both.bottomRows(count) = offsets - 2.0 * (offsets * normal) * normal.transpose();
    std::vector<Index> twice(neighbours.begin(), neighbours.end());
    twice.insert(twice.end(), neighbours.begin(), neighbours.end());
    std::vector<std::uint16_t> shared_twice(shared.begin(), shared.end());
    shared_twice.insert(shared_twice.end(), shared.begin(), shared.end());
    Eigen::VectorXd all(2 * count);
    const PatchStatus status = weighting({center, twice, both, shared_twice}, all);
    weights = all.head(count) + all.tail(count);
    return status;
}

}  // namespace

WeightTable compute_weights(const CurvedMesh& mesh, const NeighbourSets& sets, const WeightFunction& weighting,
                            const TaskContext& context, const Coordinates& mirrors) {
    const auto& interior = sets.centers;
    const int dim = mesh.topology().dimension();
    WeightTable table;
    table.weights.resize(sets.nodes.size());
    table.status.assign(interior.size(), PatchStatus::regular);
    context.report("Computing weights", 0.0);
    parallel_for(interior.size(), 512, context, "Computing weights", [&](std::size_t begin, std::size_t end) {
        std::vector<double> buffer;
        for (std::size_t i = begin; i < end; ++i) {
            const auto neighbours = sets.of(i);
            const std::size_t count = neighbours.size();
            buffer.resize(std::max(buffer.size(), count * 3));
            const double* center = mesh.coordinates().row(interior[i]).data();
            for (std::size_t j = 0; j < count; ++j) {
                const double* position = mesh.coordinates().row(neighbours[j]).data();
                for (int d = 0; d < dim; ++d) buffer[static_cast<std::size_t>(d) * count + j] = position[d] - center[d];
            }
            const Eigen::Map<const Eigen::MatrixXd> offsets(buffer.data(), static_cast<Eigen::Index>(count), dim);
            Eigen::Map<Eigen::VectorXd> weights(table.weights.data() + sets.offsets[i],
                                                static_cast<Eigen::Index>(count));
            if (mirrors.rows() > 0 && !mirrors.row(interior[i]).isZero(0.0))
                table.status[i] = mirrored_weights(interior[i], neighbours, offsets, sets.shared_elements_of(i),
                                                   mirrors.row(interior[i]).head(dim).transpose(), weighting, weights);
            else
                table.status[i] = weighting({interior[i], neighbours, offsets, sets.shared_elements_of(i)}, weights);
        }
    });
    return table;
}

}  // namespace curvewright
