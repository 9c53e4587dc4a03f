#include "ui/panels/timeline_curve.h"

#include <algorithm>

namespace curvewright {
namespace {

constexpr std::size_t block_size = 64;

void take(TimelineCurve::Range& range, const TimelineCurve::Range& other) {
    range.least = std::min(range.least, other.least);
    range.most = std::max(range.most, other.most);
    range.fewest = std::min(range.fewest, other.fewest);
    range.many = std::max(range.many, other.many);
}

TimelineCurve::Range at(const QualityPoint& point) {
    return {point.min_scaled_jacobian, point.min_scaled_jacobian, point.not_valid, point.not_valid};
}

}  // namespace

TimelineCurve::TimelineCurve(std::shared_ptr<const Recording> recording) : recording_(std::move(recording)) {
    const auto points = recording_->quality_points();
    for (std::size_t i = 0; i < points.size(); ++i) {
        if (i % block_size == 0) blocks_.push_back(at(points[i]));
        take(blocks_.back(), at(points[i]));
    }
    whole_ = blocks_.front();
    for (const Range& block : blocks_) take(whole_, block);
}

TimelineCurve::Range TimelineCurve::over(StepNumber first, StepNumber last) const {
    const auto points = recording_->quality_points();
    const auto position = [&](StepNumber step) {  // of the point that holds in a step
        const auto after = std::upper_bound(points.begin(), points.end(), step,
                                            [](StepNumber s, const QualityPoint& point) { return s < point.step; });
        return static_cast<std::size_t>(after - points.begin()) - 1;
    };
    std::size_t i = position(first);
    const std::size_t end = position(last) + 1;
    Range range = at(points[i]);
    while (i < end) {
        if (i % block_size == 0 && i + block_size <= end) {
            take(range, blocks_[i / block_size]);
            i += block_size;
        } else {
            take(range, at(points[i++]));
        }
    }
    return range;
}

}  // namespace curvewright
