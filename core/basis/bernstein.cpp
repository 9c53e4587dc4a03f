#include "core/basis/bernstein.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>

#include "core/basis/reference_element.h"

namespace curvewright {

BernsteinSimplex::BernsteinSimplex(int dimension, int degree) : dimension_(dimension), degree_(degree) {
    const int side = degree + 1;
    position_.assign(static_cast<std::size_t>(side) * side * side, -1);
    std::vector<double> factorial(side, 1.0);
    for (int i = 1; i < side; ++i) factorial[i] = factorial[i - 1] * i;
    for (int k = 0; k <= (dimension > 2 ? degree : 0); ++k)
        for (int j = 0; j <= (dimension > 1 ? degree - k : 0); ++j)
            for (int i = 0; i <= degree - j - k; ++i) {
                const std::array<int, 4> index{degree - i - j - k, i, j, k};
                position_[(i * side + j) * side + k] = size();
                double multinomial = factorial[degree];
                for (int a : index) multinomial /= factorial[a];
                multinomials_.push_back(std::round(multinomial));
                indices_.push_back(index);
            }
    corners_[0] = position(0, 0, 0);
    if (dimension >= 1) corners_[1] = position(degree, 0, 0);
    if (dimension >= 2) corners_[2] = position(0, degree, 0);
    if (dimension >= 3) corners_[3] = position(0, 0, degree);

    for (int a = 0; a <= dimension; ++a)
        for (int b = a + 1; b <= dimension; ++b)
            for (const auto& start : indices_) {
                if (start[b] != 0) continue;
                std::vector<int> line;
                auto index = start;
                for (int t = 0; t <= start[a]; ++t) {
                    index[a] = start[a] - t;
                    index[b] = t;
                    line.push_back(position(index[1], index[2], index[3]));
                }
                lines_[a][b].push_back(std::move(line));
            }
}

const BernsteinSimplex& BernsteinSimplex::get(int dimension, int degree) {
    static std::mutex mutex;
    static std::map<std::pair<int, int>, std::unique_ptr<const BernsteinSimplex>> cache;
    const std::lock_guard lock(mutex);
    auto& entry = cache[{dimension, degree}];
    if (!entry) entry.reset(new BernsteinSimplex(dimension, degree));
    return *entry;
}

void BernsteinSimplex::bisect(int a, int b, int count, const double* coefficients, double* near_a,
                              double* near_b) const {
    if (a > b) return bisect(b, a, count, coefficients, near_b, near_a);
    const auto stride = static_cast<std::ptrdiff_t>(count);
    for (const auto& line : lines_[a][b]) {
        const int last = static_cast<int>(line.size()) - 1;
        if (count == 1) {
            constexpr int longest = 3 * max_order;
            double work[longest + 1];
            for (int t = 0; t <= last; ++t) work[t] = coefficients[line[t]];
            near_a[line[0]] = work[0];
            near_b[line[last]] = work[last];
            for (int round = 1; round <= last; ++round) {
                for (int t = 0; t <= last - round; ++t) work[t] = 0.5 * (work[t] + work[t + 1]);
                near_a[line[round]] = work[0];
                near_b[line[last - round]] = work[last - round];
            }
            continue;
        }
        // near_b is the work space: what a round leaves at its far end is final.
        for (int t = 0; t <= last; ++t) std::copy_n(coefficients + line[t] * stride, count, near_b + line[t] * stride);
        std::copy_n(near_b + line[0] * stride, count, near_a + line[0] * stride);
        for (int round = 1; round <= last; ++round) {
            for (int t = 0; t <= last - round; ++t) {
                double* here = near_b + line[t] * stride;
                const double* next = near_b + line[t + 1] * stride;
                for (int i = 0; i < count; ++i) here[i] = 0.5 * (here[i] + next[i]);
            }
            std::copy_n(near_b + line[0] * stride, count, near_a + line[round] * stride);
        }
    }
}

BernsteinForm::BernsteinForm(const std::vector<int>& dimensions, const std::vector<int>& degrees) {
    multinomials_ = {1.0};
    corners_.resize(1);
    for (std::size_t f = 0; f < dimensions.size(); ++f) {
        const BernsteinSimplex& factor = BernsteinSimplex::get(dimensions[f], degrees[f]);
        factors_.push_back(&factor);
        dimension_ += dimensions[f];
        std::vector<double> multinomials;
        for (const double before : multinomials_)
            for (const double own : factor.multinomials()) multinomials.push_back(before * own);
        multinomials_ = std::move(multinomials);
        std::vector<Corner> corners;
        for (const Corner& before : corners_)
            for (int vertex = 0; vertex <= dimensions[f]; ++vertex) {
                Corner corner = before;
                corner.position = before.position * factor.size() + factor.corners()[vertex];
                corner.of_factor[f] = vertex;
                corners.push_back(corner);
            }
        corners_ = std::move(corners);
    }
}

void BernsteinForm::bisect(int factor, int a, int b, const double* coefficients, double* near_a, double* near_b) const {
    int count = 1;
    for (std::size_t f = static_cast<std::size_t>(factor) + 1; f < factors_.size(); ++f) count *= factors_[f]->size();
    const int block = factors_[factor]->size() * count;
    for (int first = 0; first < size(); first += block)
        factors_[factor]->bisect(a, b, count, coefficients + first, near_a + first, near_b + first);
}

int BernsteinForm::box_size() const {
    int result = 1;
    for (const BernsteinSimplex* factor : factors_)
        for (int d = 0; d < factor->dimension(); ++d) result *= factor->degree() + 1;
    return result;
}

std::vector<int> BernsteinForm::places_in_box_of(const BernsteinForm& other) const {
    std::vector<int> places{0};
    for (std::size_t f = 0; f < factors_.size(); ++f) {
        const int side = other.factors_[f]->degree() + 1;
        std::vector<int> longer;
        for (const int before : places)
            for (const auto& index : factors_[f]->indices()) {
                int place = before;
                for (int d = factors_[f]->dimension(); d >= 1; --d) place = place * side + index[d];
                longer.push_back(place);
            }
        places = std::move(longer);
    }
    return places;
}

const ExtendedMatrix& lagrange_to_bernstein(ElementType simplex) {
    static std::mutex mutex;
    static std::map<ElementType, ExtendedMatrix> cache;
    const std::lock_guard lock(mutex);
    const auto known = cache.find(simplex);
    if (known != cache.end()) return known->second;

    const int p = simplex.order, dim = dimension(simplex.shape);
    const BernsteinSimplex& form = BernsteinSimplex::get(dim, p);
    const auto& lattice = reference_element(simplex).lattice;
    ExtendedMatrix matrix(form.size(), form.size());
    for (int node = 0; node < form.size(); ++node) {
        const auto& point = lattice[node];
        const std::array<int, 4> alpha{p - point[0] - point[1] - point[2], point[0], point[1], point[2]};
        std::vector<std::int64_t> polynomial{1};
        std::int64_t divisor = 1;
        int degree = 0;
        for (int i = 0; i <= dim; ++i)
            for (int k = 0; k < alpha[i]; ++k) {
                // Multiply by the linear form p lambda_i - k = sum_j (p delta_ij - k) lambda_j.
                const BernsteinSimplex& low = BernsteinSimplex::get(dim, degree);
                const BernsteinSimplex& high = BernsteinSimplex::get(dim, ++degree);
                std::vector<std::int64_t> product(high.size(), 0);
                for (int a = 0; a < low.size(); ++a)
                    for (int j = 0; j <= dim; ++j) {
                        auto index = low.indices()[a];
                        ++index[j];
                        product[high.position(index[1], index[2], index[3])] += (j == i ? p - k : -k) * polynomial[a];
                    }
                polynomial = std::move(product);
                divisor *= k + 1;
            }
        for (int c = 0; c < form.size(); ++c)
            matrix(c, node) = static_cast<long double>(polynomial[c]) /
                              (static_cast<long double>(divisor) * static_cast<long double>(form.multinomials()[c]));
    }
    return cache.emplace(simplex, std::move(matrix)).first->second;
}

}  // namespace curvewright
