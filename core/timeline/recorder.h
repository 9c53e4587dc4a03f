#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/base/task.h"
#include "core/timeline/recording.h"

namespace curvewright {

/// Where a recording is kept.
struct RecorderOptions {
    /// Bytes of steps that are held in memory; the others go to a temporary file.
    std::size_t memory_limit = std::size_t{64} << 20;
};

/// Writes down what a method reports, judging the mesh after every move.
class Recorder : public UntangleObserver {
  public:
    explicit Recorder(const RecorderOptions& options = {}, const TaskContext& context = {});
    ~Recorder() override;

    /// The first event must be Started, and a patch must end before another one begins. Throws Cancelled. If the
    /// temporary file is full, what follows is not recorded.
    void on_event(const UntangleEvent& event) override;
    /// The start of a warp in increments, then the states that it tries, accepted or not. coordinates: nodes × 3.
    void begin_warp(const CurvedMesh& mesh);
    void add_increment(const WarpIncrement& increment, const Coordinates& coordinates);
    /// coordinates: of the result.
    void end_warp(const Coordinates& coordinates, StopReason reason);

    /// What was recorded. pre: there was a start. Nothing may be added afterwards.
    std::shared_ptr<const Recording> finish();
    /// Why the recording ends early; "" = it does not.
    const std::string& problem() const { return problem_; }

  private:
    class Minimum;

    void start(const CurvedMesh& mesh);
    void add(const StepEvent& event);
    void write(const StepEvent& event, const StepCodec::Moved* moved);
    void place(std::span<const Index> nodes, std::span<const untangle_event::Position> positions);
    StepCodec::Moved moved_nodes(std::span<const Index> nodes,
                                 std::span<const untangle_event::Position> positions) const;
    void commit(std::size_t moved_nodes);
    /// Certifies elements in the present positions, in the name of the last step.
    void judge(std::span<const Index> elements);
    std::vector<Index> elements_at(std::span<const Index> nodes) const;

    const RecorderOptions options_;
    const TaskContext context_;
    std::shared_ptr<Recording> recording_;
    Coordinates x_;
    std::unique_ptr<Minimum> minimum_;
    std::vector<Validity> validity_;  ///< per element
    Index not_valid_ = 0;
    std::optional<untangle_event::PatchBegan> patch_;  ///< the open one
    std::vector<untangle_event::Position> candidate_;  ///< its positions in the last energy step
    std::uint32_t patches_in_pass_ = 0;
    std::size_t cost_since_keyframe_ = 0;
    ByteWriter bytes_;
    std::string problem_;
};

}  // namespace curvewright
