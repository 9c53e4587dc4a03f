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
#include "core/basis/reference_element.h"
#include "core/mesh/renumbering.h"
#include "core/quality/mean_ratio.h"
#include "core/quality/product_shapes.h"
#include "core/quality/quality.h"

namespace curvewright {
namespace {

/// On a simplex W is the same everywhere, and J has the degree p - 1: it is computed in a basis of that degree,
/// multiplied by W^-1, and evaluated at the samples, of several elements at once. Up to order 3 the basis is that of
/// monomials in the steps of the samples' lattice, which is walked along lines; above, the Lagrange basis.
struct SimplexBasis {
    Eigen::MatrixXd derivatives;  ///< (directions · basis) × nodes, directions below each other
    Eigen::MatrixXd samples;      ///< samples × basis; not where the lattice is walked
    Eigen::MatrixXd nodes;        ///< reference coordinates, nodes × directions
};

constexpr int highest_order_walked = 3;

/// 1, i, j, i², ij, j²; in 3D then k, ik, jk, k²: at a point of the lattice.
Eigen::RowVectorXd monomials(int dim, double i, double j, double k) {
    Eigen::RowVectorXd result(dim == 2 ? 6 : 10);
    result.head(6) << 1.0, i, j, i * i, i * j, j * j;
    if (dim == 3) result.tail(4) << k, i * k, j * k, k * k;
    return result;
}

SimplexBasis make_simplex_basis(ElementType type) {
    SimplexBasis basis;
    const int dim = dimension(type.shape);
    basis.nodes = reference_nodes(type).leftCols(dim);
    const bool is_walked = type.order <= highest_order_walked;
    const ElementType lower{type.shape, is_walked ? 2 : type.order - 1};
    const Eigen::MatrixX3d lattice = reference_nodes(lower);
    const Eigen::Index size = lattice.rows();
    Eigen::MatrixXd to_basis = Eigen::MatrixXd::Identity(size, size);
    if (is_walked) {
        Eigen::MatrixXd values(size, size);
        const Eigen::MatrixX3d steps = 3.0 * type.order * lattice;
        for (Eigen::Index q = 0; q < size; ++q) values.row(q) = monomials(dim, steps(q, 0), steps(q, 1), steps(q, 2));
        to_basis = values.inverse();
    } else {
        basis.samples = lagrange_basis(lower, lattice_points(type.shape, 3 * type.order)).values;
    }
    const BasisTable at_lattice = lagrange_basis(type, lattice);
    basis.derivatives.resize(dim * size, node_count(type));
    for (int k = 0; k < dim; ++k)
        basis.derivatives.middleRows(k * size, size) = to_basis * at_lattice.gradients[static_cast<std::size_t>(k)];
    return basis;
}

const SimplexBasis& simplex_basis(ElementType type) {
    static std::mutex mutex;
    static std::map<ElementType, SimplexBasis> cache;
    const std::lock_guard lock(mutex);
    auto [entry, is_new] = cache.try_emplace(type);
    if (is_new) entry->second = make_simplex_basis(type);
    return entry->second;
}

/// The least power_of_ratio of two elements at once on the lattice of n steps. t: monomials × (Dim² columns of each),
/// the second element's behind the first's; the same twice for one.
template <int Dim>
Eigen::Array2d walk(const Eigen::Ref<const Eigen::MatrixXd>& t, int n) {
    using Pair = Eigen::Array2d;
    constexpr int squares = Dim * Dim;
    std::array<std::array<Pair, squares>, Dim == 2 ? 6 : 10> a;
    for (std::size_t m = 0; m < a.size(); ++m)
        for (int c = 0; c < squares; ++c)
            a[m][c] = Pair(t(static_cast<Eigen::Index>(m), c), t(static_cast<Eigen::Index>(m), squares + c));
    Pair least = Pair::Constant(std::numeric_limits<double>::infinity());
    const auto judge = [&least](const std::array<Pair, squares>& v) {
        Pair norm = Pair::Constant(smallest_squared_norm);
        for (const Pair& value : v) norm += value * value;
        const Pair det = determinant_of<Dim>([&v](int i, int j) -> const Pair& { return v[Dim * i + j]; });
        const Pair power = power_of_ratio<Dim>(det, norm);
        least = least.min(power);
    };
    std::array<Pair, squares> start, slope, v;
    for (int i = 0; i <= n; ++i)
        for (int j = 0; j <= n - i; ++j) {
            const double x = i, y = j;
            for (int c = 0; c < squares; ++c)
                start[c] = a[0][c] + x * (a[1][c] + x * a[3][c] + y * a[4][c]) + y * (a[2][c] + y * a[5][c]);
            if constexpr (Dim == 2) {
                judge(start);
            } else {
                for (int c = 0; c < squares; ++c) slope[c] = a[6][c] + x * a[7][c] + y * a[8][c];
                for (int k = 0; k <= n - i - j; ++k) {
                    const double z = k;
                    for (int c = 0; c < squares; ++c) v[c] = start[c] + z * (slope[c] + z * a[9][c]);
                    judge(v);
                }
            }
        }
    return least;
}

/// Worst mean ratios of simplices of one type, in portions.
template <int Dim>
class SimplexShapes {
  public:
    SimplexShapes(ElementType type, const MeshTopology& topology, const Coordinates& x, const Coordinates& ideal)
        : basis_(simplex_basis(type)),
          order_(type.order),
          size_(basis_.derivatives.rows() / Dim),
          topology_(topology),
          x_(x),
          ideal_(ideal),
          positions_(basis_.derivatives.cols(), portion * Dim),
          tangents_(basis_.derivatives.rows(), portion * Dim),
          curved_(size_, (portion + 1) * squares),
          sampled_(basis_.samples.rows(), portion * squares) {}

    static constexpr Eigen::Index portion = 16;

    /// Elements first .. first + count - 1, count <= portion; worst: one per element.
    void compute(Index first, Eigen::Index count, double* worst) {
        std::array<Eigen::Index, portion> places;
        Eigen::Index curved = 0;
        for (Eigen::Index b = 0; b < count; ++b)
            if (!is_done(first + static_cast<Index>(b), curved, worst[b])) places[curved++] = b;
        if (curved == 0) return;
        tangents_.leftCols(curved * Dim).noalias() = basis_.derivatives * positions_.leftCols(curved * Dim);
        for (Eigen::Index c = 0; c < curved; ++c) transform(c);
        if (order_ <= highest_order_walked) {
            // An odd one goes with itself.
            curved_.middleCols(curved * squares, squares) = curved_.middleCols((curved - 1) * squares, squares);
            for (Eigen::Index c = 0; c < curved; c += 2) {
                const Eigen::Array2d powers = walk<Dim>(curved_.middleCols(c * squares, 2 * squares), 3 * order_);
                worst[places[c]] = mean_ratio<Dim>(powers[0]);
                if (c + 1 < curved) worst[places[c + 1]] = mean_ratio<Dim>(powers[1]);
            }
            return;
        }
        sampled_.leftCols(curved * squares).noalias() = basis_.samples * curved_.leftCols(curved * squares);
        for (Eigen::Index c = 0; c < curved; ++c)
            worst[places[c]] = mean_ratio<Dim>(least_power(sampled_.middleCols(c * squares, squares)));
    }

  private:
    using Matrix = Eigen::Matrix<double, Dim, Dim>;
    static constexpr Eigen::Index squares = Dim * Dim;

    /// Puts the element's positions and W^-1 to the given place. Where T is the same everywhere up to rounding, or
    /// there is no ideal, the ratio is known.
    bool is_done(Index element, Eigen::Index place, double& ratio) {
        const auto nodes = topology_.element_nodes(element);
        auto x = positions_.middleCols<Dim>(place * Dim);
        for (std::size_t i = 0; i < nodes.size(); ++i)
            for (int d = 0; d < Dim; ++d) x(static_cast<Eigen::Index>(i), d) = x_(nodes[i], d) - x_(nodes[0], d);
        Matrix w;
        for (int k = 0; k < Dim; ++k)
            for (int d = 0; d < Dim; ++d)
                w(d, k) = ideal_(nodes[static_cast<std::size_t>(k) + 1], d) - ideal_(nodes[0], d);
        if (!(std::abs(w.determinant()) > 0.0)) {
            ratio = 0.0;
            return true;
        }
        Matrix& inverse = inverses_[static_cast<std::size_t>(place)];
        inverse = w.inverse();
        const Matrix edges = x.template middleRows<Dim>(1);
        double bend = 0.0;  // largest distance in a coordinate from the straight-sided element
        for (Eigen::Index i = Dim + 1; i < x.rows(); ++i)
            for (int d = 0; d < Dim; ++d) {
                double straight = 0.0;
                for (int k = 0; k < Dim; ++k) straight += basis_.nodes(i, k) * edges(k, d);
                bend = std::max(bend, std::abs(x(i, d) - straight));
            }
        const Matrix t = edges.transpose() * inverse;
        constexpr double rounding = 1e-12;
        // A derivative is less than some 4 p² times what is added to the nodes.
        const double change = 4.0 * order_ * order_ * bend * inverse.norm();
        if (!(change <= rounding * t.cwiseAbs().maxCoeff())) return false;
        const Eigen::Array<double, 1, 1> det(t.determinant()), norm(std::max(t.squaredNorm(), smallest_squared_norm));
        ratio = mean_ratio<Dim>(power_of_ratio<Dim>(det, norm).value());
        return true;
    }

    /// Writes T of the element in a place to curved_.
    void transform(Eigen::Index place) {
        const Matrix& inverse = inverses_[static_cast<std::size_t>(place)];
        for (int d = 0; d < Dim; ++d) {
            const auto tangent = tangents_.col(place * Dim + d);
            for (int j = 0; j < Dim; ++j) {
                auto column = curved_.col(place * squares + Dim * d + j);
                column = inverse(0, j) * tangent.head(size_);
                for (int k = 1; k < Dim; ++k) column += inverse(k, j) * tangent.segment(k * size_, size_);
            }
        }
    }

    /// t: samples × Dim².
    template <class Matrices>
    static double least_power(const Matrices& t) {
        const Eigen::ArrayXd norm = t.rowwise().squaredNorm().array().max(smallest_squared_norm);
        const Eigen::ArrayXd det = determinant_of<Dim>([&t](int i, int j) { return t.col(Dim * i + j).array(); });
        return power_of_ratio<Dim>(det, norm).minCoeff();
    }

    const SimplexBasis& basis_;
    const int order_;
    const Eigen::Index size_;  ///< of the basis
    const MeshTopology& topology_;
    const Coordinates &x_, &ideal_;
    std::array<Matrix, portion> inverses_;  ///< W^-1
    Eigen::MatrixXd positions_;             ///< nodes × (elements · Dim), relative to the first node
    Eigen::MatrixXd tangents_;              ///< (directions · basis) × (elements · Dim)
    Eigen::MatrixXd curved_;                ///< T: basis × (elements · Dim²)
    Eigen::MatrixXd sampled_;               ///< T at the samples
};

/// The elements from begin to end, which are all of a type.
template <int Dim>
void compute_alike(ElementType type, const MeshTopology& topology, const Coordinates& x, const Coordinates& ideal,
                   std::size_t begin, std::size_t end, std::vector<double>& worst) {
    if (type.shape == Shape::pyramid) {
        std::fill(&worst[begin], &worst[end - 1] + 1, std::numeric_limits<double>::quiet_NaN());
    } else if (is_simplex(type.shape)) {
        SimplexShapes<Dim> shapes(type, topology, x, ideal);
        constexpr auto portion = SimplexShapes<Dim>::portion;
        for (std::size_t i = begin; i < end; i += portion)
            shapes.compute(static_cast<Index>(i), std::min(static_cast<Eigen::Index>(end - i), portion), &worst[i]);
    } else {
        ProductShapes<Dim> shapes(type, topology, x, ideal);
        for (std::size_t i = begin; i < end; ++i) worst[i] = shapes.worst(static_cast<Index>(i));
    }
}

}  // namespace

std::vector<double> element_shapes(const CurvedMesh& mesh, const Coordinates& ideal, const TaskContext& context) {
    require_assessable(mesh);
    // Numbered alike, so that not a bit depends on the numbering.
    const NumberedAlike numbered(mesh);
    const CurvedMesh& alike = numbered.mesh();
    const MeshTopology& topology = alike.topology();
    std::vector<double> worst(static_cast<std::size_t>(topology.element_count()));
    parallel_for(worst.size(), 64, context, {}, [&](std::size_t begin, std::size_t end) {
        for (std::size_t first = begin; first < end;) {
            const ElementType type = topology.element_type(static_cast<Index>(first));
            std::size_t last = first + 1;
            while (last < end && topology.element_type(static_cast<Index>(last)) == type) ++last;
            if (topology.dimension() == 2)
                compute_alike<2>(type, topology, alike.coordinates(), ideal, first, last, worst);
            else
                compute_alike<3>(type, topology, alike.coordinates(), ideal, first, last, worst);
            first = last;
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
