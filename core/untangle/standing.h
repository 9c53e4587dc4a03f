#pragma once

#include <limits>
#include <span>

#include "core/quality/quality.h"

namespace curvewright {

/// Whether the element is proved valid.
inline bool is_valid(const ElementQuality& quality) {
    return quality.validity == Validity::valid;
}

/// Whether the element was assessed and is not proved valid.
inline bool is_in_need(const ElementQuality& quality) {
    return quality.validity == Validity::invalid || quality.validity == Validity::undecided;
}

/// How good a mesh, or a part of it, is: fewer elements that are not valid first, then a higher least scaled Jacobian.
/// Elements that were not assessed do not count.
struct Standing {
    Index not_valid = 0;
    double least = std::numeric_limits<double>::infinity();
    std::size_t worst = 0;  ///< position of the element with the least scaled Jacobian

    explicit Standing(std::span<const ElementQuality> qualities) {
        for (std::size_t i = 0; i < qualities.size(); ++i) {
            not_valid += is_in_need(qualities[i]) ? 1 : 0;
            if (!(qualities[i].scaled_jacobian < least)) continue;
            least = qualities[i].scaled_jacobian;
            worst = i;
        }
    }
    bool is_better_than(const Standing& other) const {
        return not_valid != other.not_valid ? not_valid < other.not_valid : least > other.least;
    }
};

}  // namespace curvewright
