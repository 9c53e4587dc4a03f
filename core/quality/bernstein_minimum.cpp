#include "core/quality/bernstein_minimum.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace curvewright {
namespace {

constexpr double unit_roundoff = std::numeric_limits<double>::epsilon() / 2;

double smallest_of(const std::vector<double>& coefficients) {
    double smallest = coefficients[0];
    for (const double c : coefficients) smallest = std::min(smallest, c);
    return smallest;
}

}  // namespace

BernsteinMinimizer::BernsteinMinimizer(const BernsteinForm& form) : form_(form) {
    int first = 0;
    for (const BernsteinSimplex* factor : form.factors()) {
        for (int d = 0; d < factor->dimension(); ++d) whole_.corners[first + d + 1][d] = 1.0;
        first += factor->dimension() + 1;
    }
}

void BernsteinMinimizer::inspect(Piece& piece, Result& best) const {
    piece.lower = smallest_of(piece.coefficients);
    for (const BernsteinForm::Corner& corner : form_.corners()) {
        const double value = piece.coefficients[corner.position];
        if (!(value < best.attained)) continue;
        best.attained = value;
        int first = 0, axis = 0;
        for (std::size_t f = 0; f < form_.factors().size(); ++f) {
            const int dim = form_.factors()[f]->dimension();
            for (int d = 0; d < dim; ++d) best.point[axis++] = piece.corners[first + corner.of_factor[f]][d];
            first += dim + 1;
        }
    }
}

BernsteinMinimizer::Edge BernsteinMinimizer::longest_edge(const Piece& piece) const {
    Edge edge;
    double longest = -1.0;
    int first = 0;
    for (std::size_t f = 0; f < form_.factors().size(); ++f) {
        const int dim = form_.factors()[f]->dimension();
        for (int a = 0; a <= dim; ++a)
            for (int b = a + 1; b <= dim; ++b) {
                double length = 0.0;
                for (int d = 0; d < dim; ++d) {
                    const double step = piece.corners[first + b][d] - piece.corners[first + a][d];
                    length += step * step;
                }
                if (length > longest * (1 + 1e-9)) {
                    longest = length;
                    edge = {static_cast<int>(f), a, b};
                }
            }
        first += dim + 1;
    }
    return edge;
}

int BernsteinMinimizer::take_slot() {
    if (free_slots_.empty()) {
        pieces_.emplace_back().coefficients.resize(static_cast<std::size_t>(form_.size()));
        return static_cast<int>(pieces_.size()) - 1;
    }
    const int slot = free_slots_.back();
    free_slots_.pop_back();
    return slot;
}

BernsteinMinimizer::Result BernsteinMinimizer::minimize(const std::vector<double>& coefficients,
                                                        double coefficient_error, double magnitude, bool settle_sign,
                                                        const QualityOptions& options) {
    Result best;
    best.attained = std::numeric_limits<double>::infinity();
    whole_.coefficients = coefficients;
    inspect(whole_, best);

    // Averaging in de Casteljau's algorithm adds at most half an ulp of the largest coefficient per round.
    double error_per_level = 0.0;
    int deepest = 0;
    const auto is_done = [&](double lower, int bisections) {
        best.error = coefficient_error + deepest * error_per_level;
        best.bound = std::min(lower, best.attained) - best.error;
        const double gap = best.attained - lower, scale = std::max(magnitude, std::abs(best.attained));
        const bool is_tight = gap <= options.tolerance * scale;
        const bool is_settled = !settle_sign || best.bound > 0.0 || best.attained + best.error < 0.0;
        // Nothing more can be learnt once the gap is within rounding.
        const bool is_exhausted = gap <= 2 * best.error;
        return (is_tight && is_settled) || is_exhausted || bisections >= options.max_subdivisions;
    };
    if (is_done(whole_.lower, 0)) return best;

    double largest = 0.0;
    for (const double c : coefficients) largest = std::max(largest, std::abs(c));
    int degree = 1;
    for (const BernsteinSimplex* factor : form_.factors()) degree = std::max(degree, factor->degree());
    error_per_level = 2 * degree * unit_roundoff * largest;

    free_slots_.clear();
    for (int slot = static_cast<int>(pieces_.size()) - 1; slot >= 0; --slot) free_slots_.push_back(slot);
    heap_.clear();
    const auto later = [&](int a, int b) { return pieces_[a].lower > pieces_[b].lower; };
    const auto keep = [&](int slot) {
        // A piece that lies above an attained value holds no minimum.
        if (pieces_[slot].lower >= best.attained) {
            free_slots_.push_back(slot);
            return;
        }
        heap_.push_back(slot);
        std::push_heap(heap_.begin(), heap_.end(), later);
    };
    const int first = take_slot();
    pieces_[first] = whole_;
    keep(first);
    for (int bisections = 0;; ++bisections) {
        const double lower = heap_.empty() ? best.attained : pieces_[heap_.front()].lower;
        if (is_done(lower, bisections)) return best;
        std::pop_heap(heap_.begin(), heap_.end(), later);
        const int parent_slot = heap_.back(), slot_a = take_slot(), slot_b = take_slot();
        heap_.pop_back();
        const Piece& parent = pieces_[parent_slot];
        Piece &near_a = pieces_[slot_a], &near_b = pieces_[slot_b];
        const Edge edge = longest_edge(parent);
        int first_corner = 0;
        for (int f = 0; f < edge.factor; ++f) first_corner += form_.factors()[f]->dimension() + 1;
        const int a = first_corner + edge.a, b = first_corner + edge.b;
        near_a.depth = near_b.depth = parent.depth + 1;
        deepest = std::max(deepest, near_a.depth);
        near_a.corners = near_b.corners = parent.corners;
        std::array<double, 3> middle{};
        for (int d = 0; d < 3; ++d) middle[d] = 0.5 * (parent.corners[a][d] + parent.corners[b][d]);
        near_a.corners[b] = near_b.corners[a] = middle;
        form_.bisect(edge.factor, edge.a, edge.b, parent.coefficients.data(), near_a.coefficients.data(),
                     near_b.coefficients.data());
        free_slots_.push_back(parent_slot);
        inspect(near_a, best);
        inspect(near_b, best);
        keep(slot_a);
        keep(slot_b);
    }
}

}  // namespace curvewright
