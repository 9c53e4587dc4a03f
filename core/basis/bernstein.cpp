#include "core/basis/bernstein.h"

#include <cmath>
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

void BernsteinSimplex::bisect(int a, int b, const double* coefficients, double* near_a, double* near_b) const {
    if (a > b) return bisect(b, a, coefficients, near_b, near_a);
    constexpr int longest = 3 * max_order;
    double work[longest + 1];
    for (const auto& line : lines_[a][b]) {
        const int last = static_cast<int>(line.size()) - 1;
        for (int t = 0; t <= last; ++t) work[t] = coefficients[line[t]];
        near_a[line[0]] = work[0];
        near_b[line[last]] = work[last];
        for (int round = 1; round <= last; ++round) {
            for (int t = 0; t <= last - round; ++t) work[t] = 0.5 * (work[t] + work[t + 1]);
            near_a[line[round]] = work[0];
            near_b[line[last - round]] = work[last - round];
        }
    }
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
