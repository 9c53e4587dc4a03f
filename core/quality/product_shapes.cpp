#include "core/quality/product_shapes.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <mutex>
#include <vector>

#include "core/basis/lagrange.h"
#include "core/basis/reference_element.h"
#include "core/quality/mean_ratio.h"

namespace curvewright {
namespace {

Shape base_of(Shape shape) {
    if (shape == Shape::quadrilateral) return Shape::line;
    return shape == Shape::prism ? Shape::triangle : Shape::quadrilateral;
}

/// The factors of an element's shape functions at the samples.
struct ProductBasis {
    Eigen::MatrixXd base;  ///< (Dim · samples) × nodes of the base: the values below the derivatives
    /// nodes × samples of the line
    Eigen::MatrixXd line_values, line_derivatives;
    /// For every node of the element its place: node of the base, node of the line.
    std::vector<std::array<Eigen::Index, 2>> places;
};

/// The functions of an element's order at the samples of an element of another order.
ProductBasis make_product_basis(ElementType type, int sampled_order) {
    const int base_dim = dimension(type.shape) - 1;
    // 12: more samples of a hexahedron of high order would take longer than all else.
    const int degree = base_dim == 2 ? std::min(3 * sampled_order, 12) : 3 * sampled_order;
    const ElementType base_type{base_of(type.shape), type.order}, line_type{Shape::line, type.order};
    const BasisTable base = lagrange_basis(base_type, lattice_points(base_type.shape, degree));
    const BasisTable line = lagrange_basis(line_type, lattice_points(Shape::line, degree));

    ProductBasis result;
    const Eigen::Index samples = base.values.rows();
    result.base.resize((base_dim + 1) * samples, base.values.cols());
    for (int k = 0; k < base_dim; ++k)
        result.base.middleRows(k * samples, samples) = base.gradients[static_cast<std::size_t>(k)];
    result.base.bottomRows(samples) = base.values;
    result.line_values = line.values.transpose();
    result.line_derivatives = line.gradients[0].transpose();
    for (const LatticePoint& point : reference_element(type).lattice) {
        LatticePoint in_base = point;
        in_base[static_cast<std::size_t>(base_dim)] = 0;
        const int along = point[static_cast<std::size_t>(base_dim)];
        result.places.push_back(
            {reference_element(base_type).find_node(in_base), reference_element(line_type).find_node({along, 0, 0})});
    }
    return result;
}

const ProductBasis& product_basis(ElementType type, int sampled_order) {
    static std::mutex mutex;
    static std::map<std::pair<ElementType, int>, ProductBasis> cache;
    const std::lock_guard lock(mutex);
    auto [entry, is_new] = cache.try_emplace({type, sampled_order});
    if (is_new) entry->second = make_product_basis(type, sampled_order);
    return entry->second;
}

using Pair = Eigen::Array2d;

/// A matrix at two samples at once.
template <int Dim>
using Pairs = std::array<std::array<Pair, Dim>, Dim>;

/// The transposed cofactors: a · adjugate(a) = det(a).
template <int Dim>
Pairs<Dim> adjugate(const Pairs<Dim>& a) {
    Pairs<Dim> result;
    if constexpr (Dim == 2) {
        result[0][0] = a[1][1];
        result[0][1] = -a[0][1];
        result[1][0] = -a[1][0];
        result[1][1] = a[0][0];
        return result;
    }
    for (int i = 0; i < Dim; ++i)
        for (int j = 0; j < Dim; ++j) {
            const int r = (j + 1) % Dim, s = (j + 2) % Dim, u = (i + 1) % Dim, v = (i + 2) % Dim;
            result[i][j] = a[r][u] * a[s][v] - a[r][v] * a[s][u];
        }
    return result;
}

/// |a b|².
template <int Dim>
Pair squared_norm_of_product(const Pairs<Dim>& a, const Pairs<Dim>& b) {
    Pair norm = Pair::Zero();
    for (int i = 0; i < Dim; ++i)
        for (int j = 0; j < Dim; ++j) {
            Pair entry = a[i][0] * b[0][j];
            for (int k = 1; k < Dim; ++k) entry += a[i][k] * b[k][j];
            norm += entry * entry;
        }
    return norm;
}

template <int Dim>
Pair determinant(const Pairs<Dim>& a) {
    return determinant_of<Dim>([&a](int i, int j) -> const Pair& { return a[i][j]; });
}

}  // namespace

/// Where a pair of samples is: its first in the base, and where it is on the line.
struct SamplePair {
    Eigen::Index in_base, on_line;
};

/// The Jacobian matrices of an element at the samples.
template <int Dim>
class ProductShapes<Dim>::Tangents {
  public:
    explicit Tangents(const ProductBasis& basis)
        : basis_(basis),
          base_samples_(basis.base.rows() / Dim),
          layers_(basis.line_values.rows()),
          positions_(basis.base.cols(), layers_ * Dim),
          along_base_(basis.base.rows(), layers_ * Dim) {}

    Eigen::Index base_samples() const { return base_samples_; }
    Eigen::Index line_samples() const { return basis_.line_values.cols(); }

    /// nodes: of the element; the corners, which come first, are enough for the straight-sided one.
    template <class Nodes>
    void compute(const Nodes& nodes, const Coordinates& x) {
        gather(nodes, x);
        along_base_.noalias() = basis_.base * positions_;
    }

    /// The Jacobian matrices at a pair of samples.
    Pairs<Dim> at(SamplePair pair) const {
        Pairs<Dim> result;
        for (auto& row : result) row.fill(Pair::Zero());
        for (Eigen::Index layer = 0; layer < layers_; ++layer) {
            const double value = basis_.line_values(layer, pair.on_line);
            const double derivative = basis_.line_derivatives(layer, pair.on_line);
            for (int d = 0; d < Dim; ++d) {
                const double* along_base = &along_base_(pair.in_base, d * layers_ + layer);
                for (int k = 0; k < Dim; ++k)
                    result[d][k] +=
                        (k == Dim - 1 ? derivative : value) * Eigen::Map<const Pair>(along_base + k * base_samples_);
            }
        }
        return result;
    }

  private:
    /// Positions relative to the first node, scaled by a power of two to a size of about 1, so that no product of them
    /// leaves the range of numbers. The mean ratio does not depend on the scale.
    template <class Nodes>
    void gather(const Nodes& nodes, const Coordinates& x) {
        for (std::size_t i = 0; i < basis_.places.size(); ++i) {
            const auto [base, layer] = basis_.places[i];
            for (int d = 0; d < Dim; ++d) positions_(base, d * layers_ + layer) = x(nodes[i], d) - x(nodes[0], d);
        }
        const double size = positions_.cwiseAbs().maxCoeff();
        if (size > 0.0) positions_ *= std::exp2(-std::ilogb(size));
    }

    const ProductBasis& basis_;
    const Eigen::Index base_samples_, layers_;
    Eigen::MatrixXd positions_;   ///< nodes of the base × (Dim · nodes of the line)
    Eigen::MatrixXd along_base_;  ///< (Dim · samples of the base) × (Dim · nodes of the line)
};

template <int Dim>
ProductShapes<Dim>::ProductShapes(ElementType type, const MeshTopology& topology, const Coordinates& x,
                                  const Coordinates& ideal)
    : topology_(topology),
      x_(x),
      ideal_(ideal),
      of_element_(std::make_unique<Tangents>(product_basis(type, type.order))),
      of_ideal_(std::make_unique<Tangents>(product_basis({type.shape, 1}, type.order))),
      determinants_(of_ideal_->base_samples(), of_ideal_->line_samples()) {}

template <int Dim>
ProductShapes<Dim>::~ProductShapes() = default;

template <int Dim>
double ProductShapes<Dim>::worst(Index element) {
    const auto nodes = topology_.element_nodes(element);
    of_element_->compute(nodes, x_);
    of_ideal_->compute(nodes, ideal_);
    // Of an odd number of samples the last but one is taken twice.
    const auto for_each_pair = [this](const auto& body) {
        const Eigen::Index last = determinants_.rows() - 2;
        for (Eigen::Index l = 0; l < determinants_.cols(); ++l) {
            for (Eigen::Index q = 0; q < last; q += 2) body(SamplePair{q, l});
            body(SamplePair{last, l});
        }
    };
    const auto ideal_determinant = [this](SamplePair pair) {
        return determinants_.col(pair.on_line).template segment<2>(pair.in_base);
    };
    for_each_pair([&](SamplePair pair) { ideal_determinant(pair) = determinant<Dim>(of_ideal_->at(pair)); });
    const double volume = determinants_.sum();

    Pair least = Pair::Constant(std::numeric_limits<double>::infinity());
    for_each_pair([&](SamplePair pair) {
        // T = J W^-1 = J adj(W) / det(W), put so that nothing is divided by det(W).
        const Pairs<Dim> jacobian = of_element_->at(pair);
        const Pair det = determinant<Dim>(jacobian), ideal_det = ideal_determinant(pair);
        const Pair norm =
            squared_norm_of_product<Dim>(jacobian, adjugate<Dim>(of_ideal_->at(pair))).max(smallest_squared_norm);
        Pair power = power_of_ratio<Dim>(det, norm) * ideal_det;
        if constexpr (Dim == 3) power *= ideal_det * ideal_det * ideal_det.abs();
        // Where the ideal is folded against the rest of itself, or flat, nothing is similar to it.
        least = least.min((ideal_det * volume > 0.0).select(power, Pair::Zero()));
    });
    return mean_ratio<Dim>(least.minCoeff());
}

template class ProductShapes<2>;
template class ProductShapes<3>;

}  // namespace curvewright
