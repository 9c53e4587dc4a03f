#include "core/quality/jacobian_bounds.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <mutex>
#include <optional>

#include "core/base/error.h"
#include "core/basis/reference_element.h"

namespace curvewright {
namespace {

constexpr double unit_roundoff = std::numeric_limits<double>::epsilon() / 2;

/// Largest coefficient of a polynomial and a bound of the error of its coefficients, both for the plain (unscaled)
/// Bézier form. The weights of a Bernstein product are positive and sum to 1, so products are bounded by products.
struct Magnitude {
    double largest = 0.0, error = 0.0;
};

/// terms: number of products summed into one coefficient, at most.
Magnitude multiply(Magnitude f, Magnitude g, int terms) {
    const double largest = f.largest * g.largest;
    return {largest, f.largest * g.error + f.error * g.largest + f.error * g.error +
                         2 * (terms + 4) * unit_roundoff * (f.largest + f.error) * (g.largest + g.error)};
}

Magnitude add(Magnitude f, Magnitude g) {
    const double largest = f.largest + g.largest;
    return {largest, f.error + g.error + 2 * unit_roundoff * largest};
}

/// A factor of products of polynomials in scaled Bézier form (coefficient × multinomial), in which a product is a plain
/// convolution: where its coefficients are in the box of the product.
struct Places {
    std::vector<int> of;
    int size() const { return static_cast<int>(of.size()); }
};

/// box += f[0] g[0] + f[1] g[1] + …
template <std::size_t Terms>
void add_products(const std::array<const double*, Terms>& f, const Places& f_places,
                  const std::array<const double*, Terms>& g, const Places& g_places, double* box) {
    const int* place = g_places.of.data();
    const int f_size = f_places.size(), g_size = g_places.size();
    for (int a = 0; a < f_size; ++a) {
        double* shifted = box + f_places.of[a];
        for (int b = 0; b < g_size; ++b) {
            double sum = f[0][a] * g[0][b];
            for (std::size_t t = 1; t < Terms; ++t) sum += f[t][a] * g[t][b];
            shifted[place[b]] += sum;
        }
    }
}

}  // namespace

/// Matrices of the factors of a reference element, whose Kronecker product is applied one factor after the other.
template <class Real>
using FactorMatrices = std::vector<Eigen::Matrix<Real, Eigen::Dynamic, Eigen::Dynamic>>;

struct JacobianBounds::Tables {
    std::vector<int> node_at;  ///< the element's node at every place of the product of the factors' nodes
    /// Per factor, from the nodes to the scaled Bézier coefficients of the derivatives in its directions, below each
    /// other.
    std::vector<FactorMatrices<double>> derivatives;
    std::vector<FactorMatrices<long double>> extended_derivatives;
    /// Products of equispaced nodes of high order are so badly conditioned that coefficients computed in double would
    /// be too inexact.
    bool is_extended = false;
    double derivative_error = 0.0;             ///< of the coefficients (before scaling), per unit of the nodes' extent
    std::array<int, 4> first_row{};            ///< of every direction
    std::vector<double> inverse_multinomials;  ///< per coefficient of all directions
    std::optional<BernsteinForm> jacobian_form, minor_form;  ///< the minors of directions 1 and 2: in 3D only
    /// 2D: the derivatives in J. 3D: those of directions 1 and 2 in the minors, and direction 0 and the minors in J.
    std::array<Places, 3> derivative_places;
    Places minor_places, minor_in_own_box, jacobian_in_own_box;
    std::vector<double> inverse_jacobian_multinomials;
    int minor_terms = 0, jacobian_terms = 0;  ///< products summed into one coefficient, at most
};

namespace {

/// A matrix from the nodes of a factor to coefficients, with the largest row sum of the absolute values of its entries
/// and of the terms that they are sums of (before scaling).
struct FactorMatrix {
    ExtendedMatrix scaled;
    long double row_sum = 0.0L, row_sum_of_terms = 0.0L;
};

void append(FactorMatrix& matrix, const BernsteinSimplex& form, const ExtendedMatrix& plain,
            const ExtendedMatrix& terms) {
    matrix.row_sum = std::max(matrix.row_sum, plain.cwiseAbs().rowwise().sum().maxCoeff());
    matrix.row_sum_of_terms = std::max(matrix.row_sum_of_terms, terms.rowwise().sum().maxCoeff());
    const Eigen::Index before = matrix.scaled.rows();
    matrix.scaled.conservativeResize(before + plain.rows(), plain.cols());
    for (int row = 0; row < form.size(); ++row)
        matrix.scaled.row(before + row) = form.multinomials()[row] * plain.row(row);
}

/// Coefficients of the map.
FactorMatrix map_matrix(int dimension, int p) {
    const ExtendedMatrix& to_bezier = lagrange_to_bernstein({simplex(dimension), p});
    FactorMatrix result;
    append(result, BernsteinSimplex::get(dimension, p), to_bezier, to_bezier.cwiseAbs());
    return result;
}

/// Coefficients of the derivatives in all directions, below each other.
FactorMatrix derivative_matrix(int dimension, int p) {
    const ExtendedMatrix& to_bezier = lagrange_to_bernstein({simplex(dimension), p});
    const BernsteinSimplex& form = BernsteinSimplex::get(dimension, p);
    const BernsteinSimplex& lower = BernsteinSimplex::get(dimension, p - 1);
    FactorMatrix result;
    ExtendedMatrix plain(lower.size(), to_bezier.cols()), terms = plain;
    for (int direction = 0; direction < dimension; ++direction) {
        for (int row = 0; row < lower.size(); ++row) {
            auto up = lower.indices()[row];
            const int zero = form.position(up[1], up[2], up[3]);
            up[direction + 1] += 1;
            const int one = form.position(up[1], up[2], up[3]);
            plain.row(row) = p * (to_bezier.row(one) - to_bezier.row(zero));
            terms.row(row) = p * (to_bezier.row(one).cwiseAbs() + to_bezier.row(zero).cwiseAbs());
        }
        append(result, lower, plain, terms);
    }
    return result;
}

/// The element's node at every place of the product of the factors' nodes, the last factor's running fastest.
std::vector<int> product_nodes(ElementType type, const std::vector<int>& dimensions) {
    std::vector<int> nodes(static_cast<std::size_t>(node_count(type)));
    int node = 0;
    for (const LatticePoint& point : reference_element(type).lattice) {
        int place = 0, axis = 0;
        for (const int dim : dimensions) {
            const ReferenceElement& factor = reference_element({simplex(dim), type.order});
            LatticePoint own{};
            for (int d = 0; d < dim; ++d) own[d] = point[axis++];
            place = place * factor.node_count() + factor.find_node(own);
        }
        nodes[static_cast<std::size_t>(place)] = node++;
    }
    return nodes;
}

/// Applies the Kronecker product of the matrices. in: overwritten; both vectors grow to the sizes of the steps.
template <class Real>
void apply(const FactorMatrices<Real>& matrices, std::vector<Real>& in, std::vector<Real>& out) {
    using Matrix = Eigen::Matrix<Real, Eigen::Dynamic, Eigen::Dynamic>;
    Eigen::Index inner = 1;
    auto size = static_cast<Eigen::Index>(in.size());
    for (std::size_t f = matrices.size(); f-- > 0;) {
        const Matrix& matrix = matrices[f];
        const Eigen::Index outer = size / (inner * matrix.cols());
        size = outer * inner * matrix.rows();
        out.resize(static_cast<std::size_t>(size));
        if (inner == 1 && outer == 1) {
            Eigen::Map<Eigen::Vector<Real, Eigen::Dynamic>>(out.data(), size).noalias() =
                matrix * Eigen::Map<const Eigen::Vector<Real, Eigen::Dynamic>>(in.data(), matrix.cols());
        } else if (inner == 1) {
            Eigen::Map<Matrix>(out.data(), matrix.rows(), outer).noalias() =
                matrix.lazyProduct(Eigen::Map<const Matrix>(in.data(), matrix.cols(), outer));
        } else {
            for (Eigen::Index o = 0; o < outer; ++o)
                Eigen::Map<Matrix>(out.data() + o * inner * matrix.rows(), inner, matrix.rows()).noalias() =
                    Eigen::Map<const Matrix>(in.data() + o * inner * matrix.cols(), inner, matrix.cols())
                        .lazyProduct(matrix.transpose());
        }
        inner *= matrix.rows();
        in.swap(out);
    }
    in.swap(out);
}

}  // namespace

const JacobianBounds::Tables& JacobianBounds::tables(ElementType type) {
    const std::vector<int> dimensions = simplex_factors(type.shape);
    const int dim = dimension(type.shape), p = type.order;
    const std::size_t factors = dimensions.size();
    if (factors == 0 || dim < 2)
        throw Unsupported("The Jacobian of a " + name(type) +
                          " is not bounded; expected a triangle, quadrilateral, tetrahedron, hexahedron or prism.");
    static std::mutex mutex;
    static std::map<ElementType, std::unique_ptr<const Tables>> cache;
    const std::lock_guard lock(mutex);
    auto& entry = cache[type];
    if (entry) return *entry;

    auto built = std::make_unique<Tables>();
    built->node_at = product_nodes(type, dimensions);
    std::vector<BernsteinForm> forms;
    std::vector<int> minor_degrees(factors, 0), jacobian_degrees(factors, 0);
    long double row_sum = 0.0L, row_sum_of_terms = 0.0L;
    int terms = 0;
    for (std::size_t own = 0; own < factors; ++own) {
        long double sum = 1.0L, sum_of_terms = 1.0L;
        terms = 0;
        for (std::size_t f = 0; f < factors; ++f) {
            const FactorMatrix matrix = f == own ? derivative_matrix(dimensions[f], p) : map_matrix(dimensions[f], p);
            sum *= matrix.row_sum;
            sum_of_terms *= matrix.row_sum_of_terms;
            terms += static_cast<int>(matrix.scaled.cols()) + 2;
            if (f == 0) {
                built->derivatives.emplace_back();
                built->extended_derivatives.emplace_back();
            }
            built->derivatives.back().push_back(matrix.scaled.cast<double>());
            built->extended_derivatives.back().push_back(matrix.scaled);
        }
        row_sum = std::max(row_sum, sum);
        row_sum_of_terms = std::max(row_sum_of_terms, sum_of_terms);
        for (int direction = 0; direction < dimensions[own]; ++direction) {
            std::vector<int> degrees(factors, p);
            --degrees[own];
            for (std::size_t f = 0; f < factors; ++f) {
                jacobian_degrees[f] += degrees[f];
                if (!forms.empty()) minor_degrees[f] += degrees[f];
            }
            const BernsteinForm& form = forms.emplace_back(dimensions, degrees);
            for (const double multinomial : form.multinomials())
                built->inverse_multinomials.push_back(1.0 / multinomial);
            built->first_row[forms.size()] = static_cast<int>(built->inverse_multinomials.size());
        }
    }
    // The sums of products and the rounding of the matrices; before that, these are exact to 16 roundings of their
    // terms.
    constexpr double extended_roundoff = std::numeric_limits<long double>::epsilon() / 2;
    const double tables_error = 16 * extended_roundoff * static_cast<double>(row_sum_of_terms);
    built->derivative_error = 2 * (terms + 6) * unit_roundoff * static_cast<double>(row_sum) + tables_error;
    // On simplices, double will do up to max_order.
    if (factors > 1 && built->derivative_error > 1e-9) {
        built->is_extended = true;
        built->derivative_error = 2 * (terms + 6) * extended_roundoff * static_cast<double>(row_sum) + tables_error;
        built->derivatives.clear();
    } else {
        built->extended_derivatives.clear();
    }

    const BernsteinForm& jacobian = built->jacobian_form.emplace(dimensions, jacobian_degrees);
    built->jacobian_in_own_box = {jacobian.places_in_box_of(jacobian)};
    for (const double multinomial : jacobian.multinomials())
        built->inverse_jacobian_multinomials.push_back(1.0 / multinomial);
    if (dim == 2) {
        for (int k = 0; k < 2; ++k) built->derivative_places[k] = {forms[k].places_in_box_of(jacobian)};
        built->jacobian_terms = 2 * std::min(forms[0].size(), forms[1].size());
    } else {
        const BernsteinForm& minor = built->minor_form.emplace(dimensions, minor_degrees);
        built->derivative_places[0] = {forms[0].places_in_box_of(jacobian)};
        for (int k = 1; k < 3; ++k) built->derivative_places[k] = {forms[k].places_in_box_of(minor)};
        built->minor_in_own_box = {minor.places_in_box_of(minor)};
        built->minor_places = {minor.places_in_box_of(jacobian)};
        built->minor_terms = 2 * std::min(forms[1].size(), forms[2].size());
        built->jacobian_terms = 3 * std::min(forms[0].size(), minor.size());
    }
    entry = std::move(built);
    return *entry;
}

JacobianBounds::JacobianBounds(ElementType type)
    : tables_(tables(type)), dimension_(dimension(type.shape)), minimizer_(*tables_.jacobian_form) {
    coefficients_.resize(static_cast<std::size_t>(form().size()));
    negated_.resize(coefficients_.size());
    positions_.resize(static_cast<Eigen::Index>(tables_.node_at.size()), dimension_);
    derivatives_.resize(tables_.first_row[dimension_], dimension_);
    int box_size = form().box_size();
    if (tables_.minor_form) {
        for (auto& minor : minors_) minor.resize(static_cast<std::size_t>(tables_.minor_form->size()));
        box_size = std::max(box_size, tables_.minor_form->box_size());
    }
    box_.resize(static_cast<std::size_t>(box_size));
}

const BernsteinForm& JacobianBounds::form() const {
    return *tables_.jacobian_form;
}

const double* JacobianBounds::derivative(int direction, int coordinate) const {
    return derivatives_.col(coordinate).data() + tables_.first_row[direction];
}

bool JacobianBounds::place(const Eigen::Ref<const Eigen::MatrixX3d>& x, std::array<double, 3>& extents) {
    exponent_ = 0;
    for (int c = 0; c < dimension_; ++c) {
        // Relative to the first corner: the subtraction is exact up to half an ulp of the result, so an element far
        // from the origin is judged as well as one near it.
        double extent = 0.0;
        bool is_finite = true;
        for (Eigen::Index i = 0; i < x.rows(); ++i) {
            const double v = x(tables_.node_at[i], c) - x(0, c), size = std::abs(v);
            is_finite = is_finite && size <= std::numeric_limits<double>::max();
            extent = std::max(extent, size);
            positions_(i, c) = v;
        }
        if (!is_finite) return false;
        if (extent > 0.0) {
            // In two steps, because 2^1074 is no number.
            const int power = std::ilogb(extent), half = power / 2;
            const double first = std::scalbn(1.0, -half), second = std::scalbn(1.0, half - power);
            for (Eigen::Index i = 0; i < x.rows(); ++i) positions_(i, c) = positions_(i, c) * first * second;
            extent = extent * first * second;
            exponent_ += power;
        }
        extents[c] = extent;
    }
    return true;
}

template <class Matrices, class Real>
void JacobianBounds::differentiate(const std::vector<Matrices>& matrices, int c,
                                   std::array<std::vector<Real>, 2>& work) {
    Eigen::Index first = 0;
    for (const Matrices& factors : matrices) {
        const auto positions = positions_.col(c);
        work[0].assign(positions.data(), positions.data() + positions.size());
        apply(factors, work[0], work[1]);
        for (const Real value : work[1]) derivatives_(first++, c) = static_cast<double>(value);
    }
}

void JacobianBounds::compute(const Eigen::Ref<const Eigen::MatrixX3d>& x, double sign) {
    std::array<double, 3> extents{};
    if (!place(x, extents)) {
        std::fill(coefficients_.begin(), coefficients_.end(), std::numeric_limits<double>::quiet_NaN());
        error_ = std::numeric_limits<double>::infinity();
        return;
    }
    std::array<std::array<Magnitude, 3>, 3> size;  // [direction][coordinate]
    for (int c = 0; c < dimension_; ++c) {
        if (tables_.is_extended)
            differentiate(tables_.extended_derivatives, c, extended_work_);
        else
            differentiate(tables_.derivatives, c, work_);
        const double error = tables_.derivative_error * extents[c];
        for (int k = 0; k < dimension_; ++k) {
            double largest = 0.0;
            for (int row = tables_.first_row[k]; row < tables_.first_row[k + 1]; ++row)
                largest = std::max(largest, std::abs(derivatives_(row, c)) * tables_.inverse_multinomials[row]);
            size[k][c] = {largest, error + 2 * unit_roundoff * largest};
        }
    }
    const Tables& t = tables_;
    Magnitude total;
    if (dimension_ == 2) {
        for (int row = t.first_row[0]; row < t.first_row[1]; ++row) derivatives_(row, 1) *= -1.0;
        std::fill_n(box_.begin(), form().box_size(), 0.0);
        add_products<2>({derivative(0, 0), derivative(0, 1)}, t.derivative_places[0],
                        {derivative(1, 1), derivative(1, 0)}, t.derivative_places[1], box_.data());
        total =
            add(multiply(size[0][0], size[1][1], t.jacobian_terms), multiply(size[0][1], size[1][0], t.jacobian_terms));
    } else {
        for (int c = 0; c < 3; ++c) {
            const int u = (c + 1) % 3, v = (c + 2) % 3;
            std::fill_n(box_.begin(), t.minor_form->box_size(), 0.0);
            negated_.assign(derivative(1, v), derivative(1, v) + t.derivative_places[1].size());
            for (double& value : negated_) value = -value;
            add_products<2>({derivative(1, u), negated_.data()}, t.derivative_places[1],
                            {derivative(2, v), derivative(2, u)}, t.derivative_places[2], box_.data());
            for (int i = 0; i < t.minor_in_own_box.size(); ++i) minors_[c][i] = box_[t.minor_in_own_box.of[i]];
            const Magnitude minor =
                add(multiply(size[1][u], size[2][v], t.minor_terms), multiply(size[1][v], size[2][u], t.minor_terms));
            total = add(total, multiply(size[0][c], minor, t.jacobian_terms));
        }
        std::fill_n(box_.begin(), form().box_size(), 0.0);
        add_products<3>({derivative(0, 0), derivative(0, 1), derivative(0, 2)}, t.derivative_places[0],
                        {minors_[0].data(), minors_[1].data(), minors_[2].data()}, t.minor_places, box_.data());
    }
    for (std::size_t i = 0; i < coefficients_.size(); ++i)
        coefficients_[i] = sign * (box_[t.jacobian_in_own_box.of[i]] * t.inverse_jacobian_multinomials[i]);
    error_ = total.error;
}

ElementQuality JacobianBounds::bound(const Eigen::Ref<const Eigen::MatrixX3d>& x, double sign,
                                     const QualityOptions& options) {
    compute(x, sign);
    ElementQuality quality;
    if (!std::isfinite(error_)) {
        constexpr double infinity = std::numeric_limits<double>::infinity();
        quality.scaled_jacobian = 0.0;
        quality.min_lower = quality.max_lower = -infinity;
        quality.min_upper = quality.max_upper = infinity;
        return quality;  // undecided
    }
    // A value of |J| that is attained: the tolerance is relative to max |J|, and in high orders the coefficients may be
    // far larger than that.
    double magnitude = 0.0;
    for (const BernsteinForm::Corner& corner : form().corners())
        magnitude = std::max(magnitude, std::abs(coefficients_[corner.position]));
    negated_.resize(coefficients_.size());
    std::transform(coefficients_.begin(), coefficients_.end(), negated_.begin(), std::negate<>());
    const BernsteinMinimizer::Result high = minimizer_.minimize(negated_, error_, magnitude, false, options);
    magnitude = std::max(magnitude, std::abs(high.attained));
    const BernsteinMinimizer::Result low = minimizer_.minimize(coefficients_, error_, magnitude, true, options);

    // The sign is judged before scaling back, which may round bounds of tiny or huge elements to 0 or infinity.
    quality.min_lower = low.bound;
    quality.min_upper = low.attained + low.error;
    if (quality.min_lower > 0.0)
        quality.validity = Validity::valid;
    else if (quality.min_upper < 0.0)
        quality.validity = Validity::invalid;
    else
        quality.validity = Validity::undecided;
    quality.max_lower = -high.attained - high.error;
    quality.max_upper = -high.bound;
    for (double* bound : {&quality.min_lower, &quality.min_upper, &quality.max_lower, &quality.max_upper})
        *bound = std::scalbn(*bound, exponent_);
    quality.worst_point = low.point;
    const double largest = std::abs(-high.attained);
    if (largest > 0.0)
        quality.scaled_jacobian = low.attained / largest;
    else
        quality.scaled_jacobian = low.attained < 0.0 ? std::numeric_limits<double>::lowest() : 0.0;
    if (!std::isfinite(quality.scaled_jacobian)) quality.scaled_jacobian = std::numeric_limits<double>::lowest();
    return quality;
}

}  // namespace curvewright
