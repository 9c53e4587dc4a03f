#pragma once

#include <memory>
#include <vector>

#include "core/timeline/recording.h"

namespace curvewright {

/// The quality of a recording over its steps, for drawing: extremes over any stretch of it in next to no time.
class TimelineCurve {
  public:
    struct Range {
        float least = 0.0f, most = 0.0f;  ///< of the least scaled Jacobian
        Index fewest = 0, many = 0;       ///< elements that are not valid
    };

    TimelineCurve() = default;
    explicit TimelineCurve(std::shared_ptr<const Recording> recording);

    /// Over the steps from first to last, both included. pre: there is a recording, first <= last.
    Range over(StepNumber first, StepNumber last) const;
    /// Over all steps.
    const Range& whole() const { return whole_; }

  private:
    std::shared_ptr<const Recording> recording_;
    std::vector<Range> blocks_;  ///< of some quality points each
    Range whole_;
};

}  // namespace curvewright
