#include "core/session/timeline_frames.h"

#include <fmt/format.h>

#include "core/base/error.h"

namespace curvewright {

TimelineFrames::TimelineFrames(std::shared_ptr<const Recording> recording, StepLevel level, int count, StepNumber first,
                               StepNumber last)
    : cursor_(std::move(recording)) {
    const Recording& steps = cursor_.recording();
    if (first > last || last >= steps.step_count())
        throw InvalidInput(fmt::format("Steps {} to {} of a timeline of {} steps; expected 0 <= first <= last < {}.",
                                       first, last, steps.step_count(), steps.step_count()));
    std::vector<StepNumber> all{first};
    while (all.back() < last) all.push_back(std::min(last, step_after(steps, all.back(), level)));
    const std::size_t wanted =
        count > 0 ? std::min(all.size(), static_cast<std::size_t>(std::max(2, count))) : all.size();
    if (wanted == all.size()) {
        steps_ = std::move(all);
        return;
    }
    for (std::size_t i = 0; i < wanted; ++i) steps_.push_back(all[i * (all.size() - 1) / (wanted - 1)]);
}

Frame TimelineFrames::make(int index, const TaskContext& context) {
    const StepNumber step = steps_[static_cast<std::size_t>(index)];
    cursor_.seek(step, context);
    return {cursor_.recording().mesh().with_coordinates(cursor_.coordinates()), cursor_.quality(),
            step_caption(cursor_.recording(), step, cursor_.quality().summary),
            cursor_.patch() ? cursor_.patch()->elements : std::vector<Index>()};
}

std::string step_caption(const Recording& recording, StepNumber step, const QualitySummary& quality) {
    std::string caption;
    const auto add = [&](const std::string& part) { caption += (caption.empty() ? "" : " \u00b7 ") + part; };
    const auto pass = recording.pass_of(step), patch = recording.patch_of(step);
    if (step == 0) add("start");
    if (pass) add(fmt::format("pass {}", recording.passes()[*pass].number));
    if (patch) {
        add(fmt::format("patch {}", recording.patches()[*patch].number));
        add(fmt::format("step {}", step - recording.patches()[*patch].first));
    }
    if (step + 1 == recording.step_count()) add("end");
    const Index not_valid = quality.invalid + quality.undecided;
    add(not_valid == 0 ? std::string("all valid") : fmt::format("{} not valid", not_valid));
    add(fmt::format("min {}{:.3g}", quality.min < 0 ? "\u2212" : "", std::abs(quality.min)));
    return caption;
}

}  // namespace curvewright
