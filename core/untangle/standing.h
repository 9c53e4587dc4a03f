#pragma once

#include <algorithm>
#include <limits>
#include <span>

#include "core/quality/quality.h"

namespace curvewright {

/// How good a mesh, or a part of it, is: fewer elements that are not valid first, then a higher least scaled Jacobian.
struct Standing {
    Index not_valid = 0;
    double least = std::numeric_limits<double>::infinity();

    explicit Standing(std::span<const ElementQuality> qualities) {
        for (const ElementQuality& quality : qualities) {
            not_valid += quality.validity == Validity::valid ? 0 : 1;
            least = std::min(least, quality.scaled_jacobian);
        }
    }
    bool is_better_than(const Standing& other) const {
        return not_valid != other.not_valid ? not_valid < other.not_valid : least > other.least;
    }
};

}  // namespace curvewright
