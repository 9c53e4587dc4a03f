#include "core/quality/jacobian_bounds.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <mutex>
#include <queue>

#include "core/basis/bernstein.h"

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

/// out += sign · f g for polynomials in scaled Bézier form (coefficient × multinomial), in which the product is a plain
/// convolution. target[a * g.size + b] is the position of the sum of the two multi-indices.
void accumulate_product(const double* f, int f_size, const double* g, int g_size, const std::vector<int>& target,
                        double sign, double* out) {
    const int* row = target.data();
    for (int a = 0; a < f_size; ++a, row += g_size) {
        const double factor = sign * f[a];
        for (int b = 0; b < g_size; ++b) out[row[b]] += factor * g[b];
    }
}

std::vector<int> product_targets(const BernsteinSimplex& f, const BernsteinSimplex& g, const BernsteinSimplex& out) {
    std::vector<int> target;
    target.reserve(static_cast<std::size_t>(f.size()) * g.size());
    for (const auto& a : f.indices())
        for (const auto& b : g.indices()) target.push_back(out.position(a[1] + b[1], a[2] + b[2], a[3] + b[3]));
    return target;
}

}  // namespace

struct JacobianBounds::Tables {
    /// Degree p - 1, 2 (p - 1) and, in 3D, 3 (p - 1).
    const BernsteinSimplex* linear_form = nullptr;
    const BernsteinSimplex* minor_form = nullptr;
    const BernsteinSimplex* jacobian_form = nullptr;
    /// Per direction, (size of degree p - 1) × nodes: scaled Bézier coefficients of the derivative.
    std::array<Eigen::MatrixXd, 3> derivative;
    /// Largest row sum of the absolute values of the derivative matrices (before scaling by the multinomials), and of
    /// the two terms that each entry is the difference of.
    double row_sum = 0.0, row_sum_of_terms = 0.0;
    std::vector<int> linear_times_linear, linear_times_minor;
    std::vector<double> inverse_multinomials;  ///< of the Jacobian's form
};

const JacobianBounds::Tables& JacobianBounds::tables(ElementType type) {
    static std::mutex mutex;
    static std::map<ElementType, std::unique_ptr<const Tables>> cache;
    const std::lock_guard lock(mutex);
    auto& entry = cache[type];
    if (entry) return *entry;

    auto built = std::make_unique<Tables>();
    const int dim = dimension(type.shape), p = type.order;
    const BernsteinSimplex& form = BernsteinSimplex::get(dim, p);
    built->linear_form = &BernsteinSimplex::get(dim, p - 1);
    built->minor_form = &BernsteinSimplex::get(dim, 2 * (p - 1));
    built->jacobian_form = &BernsteinSimplex::get(dim, dim * (p - 1));
    const ExtendedMatrix& to_bezier = lagrange_to_bernstein(type);
    for (int k = 0; k < dim; ++k) {
        built->derivative[k].resize(built->linear_form->size(), to_bezier.cols());
        for (int row = 0; row < built->linear_form->size(); ++row) {
            auto up = built->linear_form->indices()[row];
            const int zero = form.position(up[1], up[2], up[3]);
            up[k + 1] += 1;
            const int one = form.position(up[1], up[2], up[3]);
            const ExtendedMatrix plain = p * (to_bezier.row(one) - to_bezier.row(zero));
            const ExtendedMatrix terms = p * (to_bezier.row(one).cwiseAbs() + to_bezier.row(zero).cwiseAbs());
            built->row_sum = std::max(built->row_sum, static_cast<double>(plain.cwiseAbs().sum()));
            built->row_sum_of_terms = std::max(built->row_sum_of_terms, static_cast<double>(terms.sum()));
            built->derivative[k].row(row) = (built->linear_form->multinomials()[row] * plain).cast<double>();
        }
    }
    built->linear_times_linear = product_targets(*built->linear_form, *built->linear_form, *built->minor_form);
    if (dim == 3)
        built->linear_times_minor = product_targets(*built->linear_form, *built->minor_form, *built->jacobian_form);
    for (double multinomial : built->jacobian_form->multinomials())
        built->inverse_multinomials.push_back(1.0 / multinomial);
    entry = std::move(built);
    return *entry;
}

JacobianBounds::JacobianBounds(ElementType type)
    : type_(type), dimension_(dimension(type.shape)), tables_(tables(type)) {
    coefficients_.resize(tables_.jacobian_form->size());
    negated_.resize(coefficients_.size());
    minor_.resize(tables_.minor_form->size());
    product_.resize(coefficients_.size());
}

void JacobianBounds::compute(const Eigen::Ref<const Eigen::MatrixX3d>& x, double sign) {
    const int n1 = tables_.linear_form->size(), n2 = tables_.minor_form->size();
    // Relative to the first corner: the subtraction is exact up to half an ulp of the result, so an element far from
    // the origin is judged as well as one near it.
    Eigen::MatrixXd shifted = (x.rowwise() - x.row(0)).leftCols(dimension_);
    exponent_ = 0;
    std::array<std::array<Magnitude, 3>, 3> size;
    for (int c = 0; c < dimension_; ++c) {
        double extent = shifted.col(c).cwiseAbs().maxCoeff();
        if (!std::isfinite(extent)) {
            std::fill(coefficients_.begin(), coefficients_.end(), std::numeric_limits<double>::quiet_NaN());
            error_ = std::numeric_limits<double>::infinity();
            return;
        }
        if (extent > 0.0) {
            const int power = std::ilogb(extent);
            shifted.col(c) = shifted.col(c).unaryExpr([power](double v) { return std::scalbn(v, -power); });
            extent = std::scalbn(extent, -power);
            exponent_ += power;
        }
        // The dot product and the rounding of its entries; the entries themselves are exact to 2^-60 of their terms.
        const double error = (2 * (static_cast<double>(x.rows()) + 6) * unit_roundoff * tables_.row_sum +
                              0x1p-60 * tables_.row_sum_of_terms) *
                             extent;
        for (int k = 0; k < dimension_; ++k) {
            derivative_[k][c].noalias() = tables_.derivative[k] * shifted.col(c);
            double largest = 0.0;
            for (int a = 0; a < n1; ++a)
                largest = std::max(largest, std::abs(derivative_[k][c][a]) / tables_.linear_form->multinomials()[a]);
            size[k][c] = {largest, error};
        }
    }
    std::fill(product_.begin(), product_.end(), 0.0);
    Magnitude total;
    if (dimension_ == 2) {
        const auto& d = derivative_;
        accumulate_product(d[0][0].data(), n1, d[1][1].data(), n1, tables_.linear_times_linear, sign, product_.data());
        accumulate_product(d[0][1].data(), n1, d[1][0].data(), n1, tables_.linear_times_linear, -sign, product_.data());
        total = add(multiply(size[0][0], size[1][1], n1), multiply(size[0][1], size[1][0], n1));
    } else {
        for (int c = 0; c < 3; ++c) {
            const int u = (c + 1) % 3, v = (c + 2) % 3;
            std::fill(minor_.begin(), minor_.end(), 0.0);
            accumulate_product(derivative_[1][u].data(), n1, derivative_[2][v].data(), n1, tables_.linear_times_linear,
                               1.0, minor_.data());
            accumulate_product(derivative_[1][v].data(), n1, derivative_[2][u].data(), n1, tables_.linear_times_linear,
                               -1.0, minor_.data());
            accumulate_product(derivative_[0][c].data(), n1, minor_.data(), n2, tables_.linear_times_minor, sign,
                               product_.data());
            const Magnitude minor = add(multiply(size[1][u], size[2][v], n1), multiply(size[1][v], size[2][u], n1));
            // Three such products are summed into each coefficient.
            total = add(total, multiply(size[0][c], minor, 3 * n1));
        }
    }
    for (std::size_t i = 0; i < product_.size(); ++i) coefficients_[i] = product_[i] * tables_.inverse_multinomials[i];
    error_ = total.error;
}

JacobianBounds::Extremum JacobianBounds::minimize(const std::vector<double>& coefficients, double magnitude,
                                                  bool settle_sign, const QualityOptions& options) const {
    double largest_coefficient = 0.0;
    for (double c : coefficients) largest_coefficient = std::max(largest_coefficient, std::abs(c));
    const BernsteinSimplex& form = *tables_.jacobian_form;
    const std::size_t size = coefficients.size();
    struct Piece {
        double lower = 0.0;
        int depth = 0;
        std::array<std::array<double, 3>, 4> corners{};
        std::vector<double> coefficients;
    };
    Extremum best;
    best.attained = std::numeric_limits<double>::infinity();
    best.error = error_;
    const auto inspect = [&](Piece& piece) {
        piece.lower = *std::min_element(piece.coefficients.begin(), piece.coefficients.end());
        for (int corner = 0; corner <= dimension_; ++corner) {
            const double value = piece.coefficients[form.corners()[corner]];
            if (value < best.attained) {
                best.attained = value;
                best.point = piece.corners[corner];
            }
        }
    };
    // Averaging in de Casteljau's algorithm adds at most half an ulp of the largest coefficient per round.
    const double error_per_level = 2 * std::max(1, form.degree()) * unit_roundoff * largest_coefficient;

    std::vector<Piece> pieces(1);
    pieces[0].coefficients = coefficients;
    for (int d = 0; d < dimension_; ++d) pieces[0].corners[d + 1][d] = 1.0;
    inspect(pieces[0]);
    const auto later = [&](int a, int b) { return pieces[a].lower > pieces[b].lower; };
    std::priority_queue<int, std::vector<int>, decltype(later)> queue(later);
    queue.push(0);
    int deepest = 0;
    for (int bisections = 0;; ++bisections) {
        const double error = error_ + deepest * error_per_level;
        Piece& piece = pieces[queue.top()];
        best.bound = std::min(piece.lower, best.attained) - error;
        best.error = error;
        const double scale = std::max(magnitude, std::abs(best.attained));
        const bool is_tight = best.attained - piece.lower <= options.tolerance * scale;
        const bool is_settled = !settle_sign || best.bound > 0.0 || best.attained + error < 0.0;
        // Nothing more can be learnt once the gap is within rounding.
        const bool is_exhausted = best.attained - piece.lower <= 2 * error;
        if ((is_tight && is_settled) || is_exhausted || bisections >= options.max_subdivisions) return best;

        int edge_a = 0, edge_b = 1;
        double longest = -1.0;
        for (int a = 0; a <= dimension_; ++a)
            for (int b = a + 1; b <= dimension_; ++b) {
                double length = 0.0;
                for (int d = 0; d < dimension_; ++d) {
                    const double step = piece.corners[b][d] - piece.corners[a][d];
                    length += step * step;
                }
                if (length > longest * (1 + 1e-9)) {
                    longest = length;
                    edge_a = a;
                    edge_b = b;
                }
            }
        const int parent = queue.top();
        queue.pop();
        Piece near_a, near_b;
        near_a.depth = near_b.depth = pieces[parent].depth + 1;
        deepest = std::max(deepest, near_a.depth);
        near_a.corners = near_b.corners = pieces[parent].corners;
        std::array<double, 3> middle{};
        for (int d = 0; d < dimension_; ++d) middle[d] = 0.5 * (near_a.corners[edge_a][d] + near_a.corners[edge_b][d]);
        near_a.corners[edge_b] = middle;
        near_b.corners[edge_a] = middle;
        near_a.coefficients.resize(size);
        near_b.coefficients.resize(size);
        form.bisect(edge_a, edge_b, pieces[parent].coefficients.data(), near_a.coefficients.data(),
                    near_b.coefficients.data());
        inspect(near_a);
        inspect(near_b);
        pieces[parent] = std::move(near_a);
        pieces.push_back(std::move(near_b));
        queue.push(parent);
        queue.push(static_cast<int>(pieces.size()) - 1);
    }
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
    for (int corner = 0; corner <= dimension_; ++corner)
        magnitude = std::max(magnitude, std::abs(coefficients_[tables_.jacobian_form->corners()[corner]]));
    std::transform(coefficients_.begin(), coefficients_.end(), negated_.begin(), std::negate<>());
    const Extremum high = minimize(negated_, magnitude, false, options);
    magnitude = std::max(magnitude, std::abs(high.attained));
    const Extremum low = minimize(coefficients_, magnitude, true, options);

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
