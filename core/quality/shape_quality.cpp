#include "core/quality/shape_quality.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <mutex>
#include <vector>

#include <Eigen/LU>

#include "core/base/parallel.h"
#include "core/basis/lagrange.h"
#include "core/basis/node_ordering.h"
#include "core/mesh/renumbering.h"
#include "core/quality/quality.h"

namespace curvewright {
namespace {

/// Gradients of the shape functions of an element and of the straight-sided one at the samples.
struct SampleBasis {
    BasisTable element, ideal;
};

const SampleBasis& sample_basis(ElementType type) {
    static std::mutex mutex;
    static std::map<ElementType, SampleBasis> cache;
    const std::lock_guard lock(mutex);
    auto [entry, is_new] = cache.try_emplace(type);
    if (is_new) {
        // 12: more samples of a hexahedron of high order would fill the memory.
        const bool is_large = dimension(type.shape) == 3 && !is_simplex(type.shape);
        const int degree = is_large ? std::min(3 * type.order, 12) : 3 * type.order;
        const auto lattice = gmsh_node_order({type.shape, degree});
        Eigen::MatrixX3d points(static_cast<Eigen::Index>(lattice.size()), 3);
        for (Eigen::Index i = 0; i < points.rows(); ++i)
            for (int d = 0; d < 3; ++d) points(i, d) = static_cast<double>(lattice[i][d]) / degree;
        entry->second = {lagrange_basis(type, points), lagrange_basis({type.shape, 1}, points)};
        entry->second.element.values.resize(0, 0);
    }
    return entry->second;
}

/// The tangents at all samples, one direction each: samples × Dim.
template <int Dim>
std::array<Eigen::Matrix<double, Eigen::Dynamic, Dim>, Dim> tangents(const BasisTable& basis,
                                                                     const Eigen::MatrixX3d& x) {
    std::array<Eigen::Matrix<double, Eigen::Dynamic, Dim>, Dim> result;
    for (int k = 0; k < Dim; ++k)
        result[k] = basis.gradients[k] * x.topRows(basis.gradients[k].cols()).template leftCols<Dim>();
    return result;
}

template <int Dim>
double worst_mean_ratio(const SampleBasis& basis, const Eigen::MatrixX3d& x, const Eigen::MatrixX3d& ideal) {
    using Matrix = Eigen::Matrix<double, Dim, Dim>;
    const auto of_element = tangents<Dim>(basis.element, x), of_ideal = tangents<Dim>(basis.ideal, ideal);
    const Eigen::Index samples = of_element[0].rows();
    std::vector<Matrix> w(static_cast<std::size_t>(samples));
    double volume = 0.0;
    for (Eigen::Index q = 0; q < samples; ++q) {
        for (int k = 0; k < Dim; ++k) w[q].col(k) = of_ideal[k].row(q).transpose();
        volume += w[q].determinant();
    }
    double worst = std::numeric_limits<double>::infinity();
    for (Eigen::Index q = 0; q < samples; ++q) {
        // Where the ideal is folded against the rest of itself, or flat, nothing is similar to it.
        const double ideal_det = w[q].determinant();
        if (!(ideal_det * volume > 0.0)) {
            worst = std::min(worst, 0.0);
            continue;
        }
        Matrix jacobian;
        for (int k = 0; k < Dim; ++k) jacobian.col(k) = of_element[k].row(q).transpose();
        const Matrix t = jacobian * w[q].inverse();
        const double det = t.determinant();
        const double ratio = Dim * std::pow(std::abs(det), 2.0 / Dim) / t.squaredNorm();
        worst = std::min(worst, det < 0.0 ? -ratio : ratio);
    }
    return worst;
}

}  // namespace

std::vector<double> element_shapes(const CurvedMesh& mesh, const Coordinates& ideal, const TaskContext& context) {
    require_assessable(mesh);
    // Numbered alike, so that not a bit depends on the numbering.
    const CurvedMesh alike = numbered_alike(mesh), ideal_mesh = alike.with_coordinates(ideal);
    const MeshTopology& topology = alike.topology();
    std::vector<double> worst(static_cast<std::size_t>(topology.element_count()));
    parallel_for(worst.size(), 64, context, {}, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const auto element = static_cast<Index>(i);
            if (topology.element_type(element).shape == Shape::pyramid) {
                worst[i] = std::numeric_limits<double>::quiet_NaN();
                continue;
            }
            const SampleBasis& basis = sample_basis(topology.element_type(element));
            const Eigen::MatrixX3d x = alike.element_coordinates(element), w = ideal_mesh.element_coordinates(element);
            worst[i] = topology.dimension() == 2 ? worst_mean_ratio<2>(basis, x, w) : worst_mean_ratio<3>(basis, x, w);
        }
    });
    return worst;
}

ShapeSummary assess_shape(const CurvedMesh& mesh, const Coordinates& ideal, const TaskContext& context) {
    const std::vector<double> worst = element_shapes(mesh, ideal, context);
    const auto assessed = std::count_if(worst.begin(), worst.end(), [](double shape) { return !std::isnan(shape); });
    if (assessed == 0) return {};
    ShapeSummary summary{std::numeric_limits<double>::infinity(), 0.0};
    for (const double shape : worst) {
        if (std::isnan(shape)) continue;
        summary.min = std::min(summary.min, shape);
        summary.mean += shape / static_cast<double>(assessed);
    }
    return summary;
}

}  // namespace curvewright
