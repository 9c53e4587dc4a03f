#pragma once

#include <array>
#include <vector>

#include "core/basis/bernstein.h"
#include "core/quality/quality.h"

namespace curvewright {

/// Proved bounds of the minimum of polynomials in Bernstein form by bisection, best piece first: the smallest
/// coefficient bounds the minimum from below, the values at the corners from above, and both tend to it as the pieces
/// shrink (Johnen, Remacle, Geuzaine, J. Comput. Phys. 233, 2013). One object per thread: it owns work space.
class BernsteinMinimizer {
  public:
    /// What is known of a minimum.
    struct Result {
        double attained = 0.0;  ///< value at `point`, up to `error`
        double bound = 0.0;     ///< proved lower bound of the minimum
        double error = 0.0;     ///< rounding bound of `attained`
        std::array<double, 3> point{};
    };

    /// form: must outlive this object.
    explicit BernsteinMinimizer(const BernsteinForm& form);

    /// Stops when the bounds are within options.tolerance × magnitude (or × the minimum, if that is larger in size),
    /// when rounding allows no more, or when options.max_subdivisions are spent. coefficients: form.size().
    /// coefficient_error: bound of their rounding errors. settle_sign: go on until the sign is proved, too.
    Result minimize(const std::vector<double>& coefficients, double coefficient_error, double magnitude,
                    bool settle_sign, const QualityOptions& options);

  private:
    struct Piece {
        double lower = 0.0;
        int depth = 0;
        /// Corners of the factors, one factor after the other, in the factor's own coordinates.
        std::array<std::array<double, 3>, 6> corners{};
        std::vector<double> coefficients;
    };
    struct Edge {
        int factor = 0, a = 0, b = 1;
    };
    /// Sets piece.lower, and takes values at the piece's corners into best.
    void inspect(Piece& piece, Result& best) const;
    Edge longest_edge(const Piece& piece) const;
    int take_slot();

    const BernsteinForm& form_;
    Piece whole_;
    std::vector<Piece> pieces_;
    std::vector<int> free_slots_, heap_;
};

}  // namespace curvewright
