#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "core/base/task.h"
#include "core/timeline/recording.h"

namespace curvewright {

/// A place in a recording, with the mesh as it was there: in a step within a patch, with the patch's nodes where that
/// step had them. To go anywhere is about as much work as copying the coordinates, and certifying what changed.
class TimelineCursor {
  public:
    /// At step 0.
    explicit TimelineCursor(std::shared_ptr<const Recording> recording);

    const Recording& recording() const { return *recording_; }
    const std::shared_ptr<const Recording>& shared_recording() const { return recording_; }
    StepNumber step() const { return step_; }

    /// pre: step < step_count(). Throws InvalidInput if the temporary file cannot be read, and Cancelled; the positions
    /// are then those of the step, but the quality is not, until a later call succeeds.
    void seek(StepNumber step, const TaskContext& context = {});

    const Coordinates& coordinates() const { return x_; }
    const QualityReport& quality() const { return quality_; }
    /// The patch that the step is in, as it began; none between patches.
    const std::optional<untangle_event::PatchBegan>& patch() const { return patch_; }

  private:
    void seek_commits(std::size_t count);
    void apply(std::size_t commit, bool forward);
    void jump_to(std::size_t keyframe);
    void leave_patch();
    void enter_patch();
    void place(std::span<const Index> nodes, std::span<const untangle_event::Position> positions);
    void mark_elements_of(Index node);

    std::shared_ptr<const Recording> recording_;
    StepNumber step_ = 0;
    std::size_t commits_ = 0;  ///< how many have been done
    Coordinates x_;
    QualityReport quality_;
    std::optional<untangle_event::PatchBegan> patch_;
    std::optional<std::size_t> patch_number_;
    std::vector<Index> stale_;    ///< elements to be certified
    std::vector<char> is_stale_;  ///< per element
};

}  // namespace curvewright
