#include "core/quality/shape_quality.h"

#include <cmath>
#include <limits>
#include <map>
#include <mutex>

#include <Eigen/LU>

#include "core/base/parallel.h"
#include "core/basis/lagrange.h"
#include "core/basis/node_ordering.h"
#include "core/quality/quality.h"

namespace curvewright {
namespace {

/// Basis gradients on the lattice of degree 3 p.
const BasisTable& sample_basis(ElementType type) {
    static std::mutex mutex;
    static std::map<ElementType, BasisTable> cache;
    const std::lock_guard lock(mutex);
    auto [entry, is_new] = cache.try_emplace(type);
    if (is_new) {
        const int degree = 3 * type.order;
        const auto lattice = gmsh_node_order({type.shape, degree});
        Eigen::MatrixX3d points(static_cast<Eigen::Index>(lattice.size()), 3);
        for (Eigen::Index i = 0; i < points.rows(); ++i)
            for (int d = 0; d < 3; ++d) points(i, d) = static_cast<double>(lattice[i][d]) / degree;
        entry->second = lagrange_basis(type, points);
    }
    return entry->second;
}

template <int Dim>
double worst_mean_ratio(const BasisTable& basis, const Eigen::MatrixX3d& x, const Eigen::MatrixX3d& ideal) {
    using Matrix = Eigen::Matrix<double, Dim, Dim>;
    Matrix w;
    for (int k = 0; k < Dim; ++k) w.col(k) = (ideal.row(k + 1) - ideal.row(0)).template head<Dim>().transpose();
    if (w.determinant() == 0.0) return 0.0;
    const Matrix inverse = w.inverse();
    double worst = std::numeric_limits<double>::infinity();
    std::array<Eigen::Matrix<double, Eigen::Dynamic, Dim>, Dim> columns;
    for (int k = 0; k < Dim; ++k) columns[k] = basis.gradients[k] * x.leftCols<Dim>();
    for (Eigen::Index q = 0; q < basis.values.rows(); ++q) {
        Matrix jacobian;
        for (int k = 0; k < Dim; ++k) jacobian.col(k) = columns[k].row(q).transpose();
        const Matrix t = jacobian * inverse;
        const double det = t.determinant();
        const double ratio = Dim * std::pow(std::abs(det), 2.0 / Dim) / t.squaredNorm();
        worst = std::min(worst, det < 0.0 ? -ratio : ratio);
    }
    return worst;
}

}  // namespace

ShapeSummary assess_shape(const CurvedMesh& mesh, const Coordinates& ideal, const TaskContext& context) {
    require_assessable(mesh);
    const CurvedMesh ideal_mesh = mesh.with_coordinates(ideal);
    const MeshTopology& topology = mesh.topology();
    std::vector<double> worst(static_cast<std::size_t>(topology.element_count()));
    parallel_for(worst.size(), 64, context, {}, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const auto element = static_cast<Index>(i);
            const BasisTable& basis = sample_basis(topology.element_type(element));
            const Eigen::MatrixX3d x = mesh.element_coordinates(element), w = ideal_mesh.element_coordinates(element);
            worst[i] = topology.dimension() == 2 ? worst_mean_ratio<2>(basis, x, w) : worst_mean_ratio<3>(basis, x, w);
        }
    });
    ShapeSummary summary{worst.empty() ? 1.0 : std::numeric_limits<double>::infinity(), worst.empty() ? 1.0 : 0.0};
    for (std::size_t i = 0; i < worst.size(); ++i) {
        summary.min = std::min(summary.min, worst[i]);
        summary.mean += worst[i] / static_cast<double>(worst.size());
    }
    return summary;
}

}  // namespace curvewright
