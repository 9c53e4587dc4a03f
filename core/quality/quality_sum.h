#pragma once

#include <algorithm>
#include <limits>

#include "core/quality/quality.h"

namespace curvewright {

/// Sums up the quality of some elements, one after another.
class QualitySum {
  public:
    void add(const ElementQuality& quality) {
        if (quality.is_reversed) ++summary_.reversed;
        if (quality.validity == Validity::not_assessed) {
            ++summary_.not_assessed;
            return;
        }
        low_ = std::min(low_, quality.scaled_jacobian);
        high_ = std::max(high_, quality.scaled_jacobian);
        total_ += quality.scaled_jacobian;
        if (quality.validity == Validity::valid) ++summary_.valid;
        if (quality.validity == Validity::invalid) ++summary_.invalid;
        if (quality.validity == Validity::undecided) ++summary_.undecided;
    }
    /// Zeros if none was assessed.
    QualitySummary result() const {
        QualitySummary summary = summary_;
        if (summary.assessed() == 0) return summary;
        summary.min = low_;
        summary.max = high_;
        // Clamped: rounding must not push the mean past the extremes, nor an infinite sum out of the numbers.
        summary.mean = std::clamp(total_ / static_cast<double>(summary.assessed()), low_, high_);
        return summary;
    }

  private:
    QualitySummary summary_;
    double low_ = std::numeric_limits<double>::infinity(), high_ = -low_, total_ = 0.0;
};

}  // namespace curvewright
