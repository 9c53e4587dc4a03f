#pragma once

#include <memory>
#include <vector>

#include "core/session/frames.h"
#include "core/timeline/cursor.h"
#include "core/timeline/search.h"

namespace curvewright {

/// The steps of an untangling or a warp in increments as the pictures of a film: from first to last, all of a level or,
/// if there are more than wanted, as many of them in even distances, the first and the last always among them.
class TimelineFrames : public FrameSource {
  public:
    /// count: of frames at most, 0 = all. Throws InvalidInput unless first <= last are steps of the recording.
    TimelineFrames(std::shared_ptr<const Recording> recording, StepLevel level, int count, StepNumber first,
                   StepNumber last);

    int count() const override { return static_cast<int>(steps_.size()); }
    Frame make(int index, const TaskContext& context) override;
    /// Steps shown, ascending.
    const std::vector<StepNumber>& steps() const { return steps_; }

  private:
    TimelineCursor cursor_;
    std::vector<StepNumber> steps_;
};

/// "pass 2 · patch 14 · step 9 · 3 not valid · min −0.031": where a step is and how the mesh is there. quality: of the
/// mesh in the step, within a patch with its nodes where that step has them.
std::string step_caption(const Recording& recording, StepNumber step, const QualitySummary& quality);

}  // namespace curvewright
