#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "core/mesh/curved_mesh.h"
#include "core/mesh/node_elements.h"
#include "core/quality/quality.h"
#include "core/timeline/step_codec.h"
#include "core/timeline/step_event.h"
#include "core/timeline/step_store.h"

namespace curvewright {

/// Number of a step of a recording, from 0.
using StepNumber = std::uint32_t;

/// A pass over the mesh, or all increments of a warp.
struct RecordedPass {
    int number = 0;                  ///< from 1
    StepNumber first = 0, last = 0;  ///< its steps, both included
};

/// Nodes that were moved together, and the steps that led there.
struct RecordedPatch {
    StepNumber first = 0, last = 0;             ///< PatchBegan and PatchEnded
    std::uint32_t pass = 0;                     ///< position in passes()
    std::uint32_t number = 0;                   ///< in its pass, from 1
    float min_before = 0.0f, min_after = 0.0f;  ///< certified scaled Jacobian over the patch
};

/// The certified quality of the whole mesh from a step on, until the next point.
struct QualityPoint {
    StepNumber step = 0;
    float min_scaled_jacobian = 0.0f;
    Index not_valid = 0;
};

/// What is proved of an element became something else in a step.
struct ValidityChange {
    StepNumber step = 0;
    Index element = 0;
    Validity validity = Validity::undecided;  ///< from this step on
};

/// Everything that happened in an untangling or a warp in increments: steps that can be read in any order, each with
/// what it changed. A step takes some hundred bytes, most of them in a temporary file (see StepStore). Made by a
/// Recorder; nothing changes afterwards, so several threads may read it.
///
/// Positions are those of the methods bit for bit, but for the iterations of the guaranteed method within a patch:
/// their displacements from the patch's start have single precision.
class Recording {
  public:
    /// The mesh as it was at the start, and what was proved of it.
    const CurvedMesh& mesh() const { return mesh_; }
    const QualityReport& start_quality() const { return start_quality_; }
    const NodeElements& node_elements() const { return node_elements_; }

    StepNumber step_count() const { return static_cast<StepNumber>(steps_.size()); }
    StepKind kind(StepNumber step) const { return static_cast<StepKind>(steps_[step] & 0xff); }
    /// pre: step < step_count(). Throws InvalidInput if the temporary file cannot be read.
    StepEvent read(StepNumber step) const;

    std::span<const RecordedPass> passes() const { return passes_; }
    std::span<const RecordedPatch> patches() const { return patches_; }
    /// Ascending by step; at least the start.
    std::span<const QualityPoint> quality_points() const { return quality_points_; }
    /// Ascending by step.
    std::span<const ValidityChange> validity_changes() const { return validity_changes_; }
    /// Position in passes() or patches() of the one that a step is in; none between them.
    std::optional<std::size_t> pass_of(StepNumber step) const;
    std::optional<std::size_t> patch_of(StepNumber step) const;
    /// The mesh's quality in a step: that of the last point.
    const QualityPoint& quality_at(StepNumber step) const;

    /// False: the store was full, and what came after the last step is not in it.
    bool is_complete() const { return is_complete_; }
    /// Bytes: in memory, and in memory and file together.
    std::size_t memory() const;
    std::uint64_t size() const { return store_->size() + keyframe_store_->size() + index_size(); }

  private:
    friend class Recorder;
    friend class TimelineCursor;
    friend class StepExplainer;

    /// A step after which the mesh is another one: what it changed can be done and undone.
    struct Commit {
        StepNumber step = 0;
        std::uint32_t cost = 0;  ///< nodes that it moves
    };
    using Delta = StepCodec::Moved;
    /// All positions after so many commits.
    struct Keyframe {
        std::uint32_t commits = 0;
        std::uint64_t offset = 0;
    };

    explicit Recording(const CurvedMesh& mesh, QualityReport quality, std::size_t memory_limit);

    std::uint64_t index_size() const;
    std::uint64_t offset(StepNumber step) const { return steps_[step] >> 8; }
    std::vector<std::byte> bytes(StepNumber step) const;
    /// patch: the PatchBegan of the patch that the step is in, if it is in one.
    StepEvent decode(StepNumber step, const untangle_event::PatchBegan* patch) const;
    untangle_event::PatchBegan read_patch(StepNumber began) const;
    Delta read_delta(const Commit& commit) const;
    Coordinates read_keyframe(const Keyframe& keyframe) const;
    StepCodec codec() const { return {mesh_.topology().dimension(), mesh_.coordinates()}; }

    CurvedMesh mesh_;
    QualityReport start_quality_;
    NodeElements node_elements_;
    std::unique_ptr<StepStore> store_, keyframe_store_;
    std::vector<std::uint64_t> steps_;  ///< offset in the store × 256 + kind
    std::vector<RecordedPass> passes_;
    std::vector<RecordedPatch> patches_;
    std::vector<QualityPoint> quality_points_;
    std::vector<ValidityChange> validity_changes_;
    std::vector<Commit> commits_;
    std::vector<Keyframe> keyframes_;  ///< the first one is the start
    bool is_complete_ = true;
};

}  // namespace curvewright
