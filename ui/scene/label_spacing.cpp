#include "ui/scene/label_spacing.h"

#include <cmath>

namespace curvewright {
namespace {

/// Moves both if they overlap; returns whether they did. Of two in the same place the second goes up or to the right.
bool part(LabelBox& a, LabelBox& b) {
    const double dx = b.x - a.x, dy = b.y - a.y;
    const double missing_x = 0.5 * (a.width + b.width) - std::abs(dx);
    const double missing_y = 0.5 * (a.height + b.height) - std::abs(dy);
    if (!(missing_x > 0.0 && missing_y > 0.0)) return false;
    const bool is_along_x = missing_x < missing_y;
    const double missing = is_along_x ? missing_x : missing_y;
    const double step = ((is_along_x ? dx : dy) < 0.0 ? -0.5 : 0.5) * missing;
    (is_along_x ? a.x : a.y) -= step;
    (is_along_x ? b.x : b.y) += step;
    return true;
}

}  // namespace

void keep_apart(std::vector<LabelBox>& boxes) {
    constexpr int most_rounds = 30;
    bool has_moved = true;
    for (int round = 0; has_moved && round < most_rounds; ++round) {
        has_moved = false;
        for (std::size_t i = 0; i < boxes.size(); ++i)
            for (std::size_t k = i + 1; k < boxes.size(); ++k) has_moved |= part(boxes[i], boxes[k]);
    }
}

}  // namespace curvewright
