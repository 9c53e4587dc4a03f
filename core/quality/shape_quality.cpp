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
#include "core/basis/reference_element.h"
#include "core/mesh/renumbering.h"
#include "core/quality/quality.h"

namespace curvewright {
namespace {

/// Gradients of the shape functions of an element and of the straight-sided one at the samples.
struct SampleBasis {
    BasisTable element, ideal;
};

/// A squared norm below this is taken for this: what has shrunk to a point is similar to nothing.
constexpr double smallest_norm = 1e-100;

/// The lattice of samples.
Eigen::MatrixX3d sample_points(ElementType type) {
    // 12: more samples of a hexahedron of high order would fill the memory.
    const bool is_large = dimension(type.shape) == 3 && !is_simplex(type.shape);
    const int degree = is_large ? std::min(3 * type.order, 12) : 3 * type.order;
    const auto lattice = gmsh_node_order({type.shape, degree});
    Eigen::MatrixX3d points(static_cast<Eigen::Index>(lattice.size()), 3);
    for (Eigen::Index i = 0; i < points.rows(); ++i)
        for (int d = 0; d < 3; ++d) points(i, d) = static_cast<double>(lattice[i][d]) / degree;
    return points;
}

const SampleBasis& sample_basis(ElementType type) {
    static std::mutex mutex;
    static std::map<ElementType, SampleBasis> cache;
    const std::lock_guard lock(mutex);
    auto [entry, is_new] = cache.try_emplace(type);
    if (is_new) {
        const Eigen::MatrixX3d points = sample_points(type);
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

/// det(T)^2 / |T|^6 (2D: det(T) / |T|^2) with the sign of det(T), which orders as the mean ratio does.
template <int Dim, class Determinant, class SquaredNorm>
auto power_of_ratio(const Determinant& det, const SquaredNorm& norm) {
    if constexpr (Dim == 2)
        return det / norm;
    else
        return det * det.abs() / (norm * norm * norm);
}

template <int Dim>
double mean_ratio(double power) {
    return Dim == 2 ? 2.0 * power : 3.0 * std::cbrt(power);
}

// ------------------------------------------------------------------------------------------------------- ideal varies

template <int Dim>
double worst_mean_ratio(const SampleBasis& basis, const Eigen::MatrixX3d& x, const Eigen::MatrixX3d& ideal) {
    using Matrix = Eigen::Matrix<double, Dim, Dim>;
    const auto of_element = tangents<Dim>(basis.element, x), of_ideal = tangents<Dim>(basis.ideal, ideal);
    const Eigen::Index samples = of_element[0].rows();
    const auto ideal_at = [&](Eigen::Index q) {
        Matrix w;
        for (int k = 0; k < Dim; ++k) w.col(k) = of_ideal[k].row(q).transpose();
        return w;
    };
    double volume = 0.0;
    for (Eigen::Index q = 0; q < samples; ++q) volume += ideal_at(q).determinant();
    double worst = std::numeric_limits<double>::infinity();
    for (Eigen::Index q = 0; q < samples; ++q) {
        // Where the ideal is folded against the rest of itself, or flat, nothing is similar to it.
        const Matrix w = ideal_at(q);
        if (!(w.determinant() * volume > 0.0)) {
            worst = std::min(worst, 0.0);
            continue;
        }
        Matrix jacobian;
        for (int k = 0; k < Dim; ++k) jacobian.col(k) = of_element[k].row(q).transpose();
        const Matrix t = jacobian * w.inverse();
        const Eigen::Array<double, 1, 1> det(t.determinant()), norm(std::max(t.squaredNorm(), smallest_norm));
        worst = std::min(worst, power_of_ratio<Dim>(det, norm).value());
    }
    return mean_ratio<Dim>(worst);
}

// ---------------------------------------------------------------------------------------------------------- simplices

/// On a simplex W is the same everywhere, and J has the degree p - 1: it is computed at the lattice of that degree,
/// multiplied by W^-1, and interpolated to the samples, of several elements at once.
struct SimplexBasis {
    Eigen::MatrixXd derivatives;  ///< (directions · points of the lattice) × nodes, directions below each other
    Eigen::MatrixXd samples;      ///< samples × points of the lattice
};

const SimplexBasis& simplex_basis(ElementType type) {
    static std::mutex mutex;
    static std::map<ElementType, SimplexBasis> cache;
    const std::lock_guard lock(mutex);
    auto [entry, is_new] = cache.try_emplace(type);
    if (!is_new) return entry->second;
    SimplexBasis& basis = entry->second;
    const int dim = dimension(type.shape);
    Eigen::MatrixX3d lattice = Eigen::MatrixX3d::Zero(1, 3);
    if (type.order > 1) lattice = reference_nodes({type.shape, type.order - 1});
    const BasisTable at_lattice = lagrange_basis(type, lattice);
    basis.derivatives.resize(dim * lattice.rows(), node_count(type));
    for (int k = 0; k < dim; ++k)
        basis.derivatives.middleRows(k * lattice.rows(), lattice.rows()) =
            at_lattice.gradients[static_cast<std::size_t>(k)];
    if (type.order == 1)
        basis.samples = Eigen::MatrixXd::Ones(1, 1);
    else
        basis.samples = lagrange_basis({type.shape, type.order - 1}, sample_points(type)).values;
    return basis;
}

/// Worst mean ratios of simplices of one type, in portions.
template <int Dim>
class SimplexShapes {
  public:
    SimplexShapes(ElementType type, const MeshTopology& topology, const Coordinates& x, const Coordinates& ideal)
        : basis_(simplex_basis(type)),
          points_(basis_.derivatives.rows() / Dim),
          topology_(topology),
          x_(x),
          ideal_(ideal),
          positions_(basis_.derivatives.cols(), portion * Dim),
          tangents_(basis_.derivatives.rows(), portion * Dim),
          curved_(points_, portion * squares),
          sampled_(basis_.samples.rows(), portion * squares) {}

    static constexpr Eigen::Index portion = 16;

    /// Elements first .. first + count - 1, count <= portion; worst: one per element.
    void compute(Index first, Eigen::Index count, double* worst) {
        for (Eigen::Index b = 0; b < count; ++b) gather(first + static_cast<Index>(b), b * Dim);
        tangents_.leftCols(count * Dim).noalias() = basis_.derivatives * positions_.leftCols(count * Dim);
        Eigen::Index curved = 0;
        std::array<Eigen::Index, portion> places;
        for (Eigen::Index b = 0; b < count; ++b)
            if (!is_done(first + static_cast<Index>(b), b * Dim, curved * squares, worst[b])) places[curved++] = b;
        if (curved == 0) return;
        sampled_.leftCols(curved * squares).noalias() = basis_.samples * curved_.leftCols(curved * squares);
        for (Eigen::Index c = 0; c < curved; ++c)
            worst[places[static_cast<std::size_t>(c)]] =
                mean_ratio<Dim>(powers(sampled_.middleCols(c * squares, squares)).minCoeff());
    }

  private:
    using Matrix = Eigen::Matrix<double, Dim, Dim>;
    static constexpr Eigen::Index squares = Dim * Dim;

    void gather(Index element, Eigen::Index column) {
        const auto nodes = topology_.element_nodes(element);
        for (std::size_t i = 0; i < nodes.size(); ++i)
            for (int d = 0; d < Dim; ++d)
                positions_(static_cast<Eigen::Index>(i), column + d) = x_(nodes[i], d) - x_(nodes[0], d);
    }

    /// Writes T at the lattice to curved_. Where it is the same everywhere up to rounding, or there is no ideal, the
    /// ratio is known.
    bool is_done(Index element, Eigen::Index from, Eigen::Index to, double& ratio) {
        const auto nodes = topology_.element_nodes(element);
        Matrix w;
        for (int k = 0; k < Dim; ++k)
            for (int d = 0; d < Dim; ++d)
                w(d, k) = ideal_(nodes[static_cast<std::size_t>(k) + 1], d) - ideal_(nodes[0], d);
        const double ideal_det = w.determinant();
        if (!(std::abs(ideal_det) > 0.0)) {
            ratio = 0.0;
            return true;
        }
        const Matrix inverse = w.inverse();
        for (int d = 0; d < Dim; ++d)
            for (int j = 0; j < Dim; ++j) {
                auto column = curved_.col(to + Dim * d + j);
                column = inverse(0, j) * tangents_.col(from + d).head(points_);
                for (int k = 1; k < Dim; ++k)
                    column += inverse(k, j) * tangents_.col(from + d).segment(k * points_, points_);
            }
        const auto all = curved_.middleCols(to, squares);
        constexpr double rounding = 1e-13;
        const double size = all.cwiseAbs().maxCoeff();
        if (!((all.rowwise() - all.row(0)).cwiseAbs().maxCoeff() <= rounding * size)) return false;
        ratio = mean_ratio<Dim>(powers(all.topRows(1)).value());
        return true;
    }

    /// One row per T, its rows behind each other.
    template <class Matrices>
    static auto powers(const Matrices& t) {
        const auto at = [&](int i, int j) { return t.col(Dim * i + j).array(); };
        Eigen::ArrayXd norm = t.rowwise().squaredNorm().array().max(smallest_norm);
        Eigen::ArrayXd det;
        if constexpr (Dim == 2)
            det = at(0, 0) * at(1, 1) - at(0, 1) * at(1, 0);
        else
            det = at(0, 0) * (at(1, 1) * at(2, 2) - at(1, 2) * at(2, 1)) +
                  at(0, 1) * (at(1, 2) * at(2, 0) - at(1, 0) * at(2, 2)) +
                  at(0, 2) * (at(1, 0) * at(2, 1) - at(1, 1) * at(2, 0));
        return Eigen::ArrayXd(power_of_ratio<Dim>(det, norm));
    }

    const SimplexBasis& basis_;
    const Eigen::Index points_;  ///< of the lattice
    const MeshTopology& topology_;
    const Coordinates &x_, &ideal_;
    Eigen::MatrixXd positions_;  ///< nodes × (elements · Dim), relative to the first node
    Eigen::MatrixXd tangents_;   ///< (directions · points) × (elements · Dim)
    Eigen::MatrixXd curved_;     ///< T of curved elements: points × (elements · Dim²)
    Eigen::MatrixXd sampled_;    ///< the same at the samples
};

/// The elements from begin to end, which are all of a type.
template <int Dim>
void compute_simplices(ElementType type, const MeshTopology& topology, const Coordinates& x, const Coordinates& ideal,
                       std::size_t begin, std::size_t end, std::vector<double>& worst) {
    SimplexShapes<Dim> shapes(type, topology, x, ideal);
    for (std::size_t i = begin; i < end; i += SimplexShapes<Dim>::portion)
        shapes.compute(static_cast<Index>(i), std::min(static_cast<Eigen::Index>(end - i), SimplexShapes<Dim>::portion),
                       &worst[i]);
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
            const ElementType type = topology.element_type(element);
            if (type.shape == Shape::pyramid) {
                worst[i] = std::numeric_limits<double>::quiet_NaN();
                continue;
            }
            if (is_simplex(type.shape)) {
                std::size_t last = i + 1;
                while (last < end && topology.element_type(static_cast<Index>(last)) == type) ++last;
                if (topology.dimension() == 2)
                    compute_simplices<2>(type, topology, alike.coordinates(), ideal, i, last, worst);
                else
                    compute_simplices<3>(type, topology, alike.coordinates(), ideal, i, last, worst);
                i = last - 1;
                continue;
            }
            const SampleBasis& basis = sample_basis(type);
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
