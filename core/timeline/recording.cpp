#include "core/timeline/recording.h"

#include <algorithm>

namespace curvewright {
namespace {

namespace event = untangle_event;

/// The last of some ranges of steps that begins at or before a step, if it reaches there.
template <class Range>
std::optional<std::size_t> range_of(std::span<const Range> ranges, StepNumber step) {
    const auto after = std::upper_bound(ranges.begin(), ranges.end(), step,
                                        [](StepNumber s, const Range& range) { return s < range.first; });
    if (after == ranges.begin() || std::prev(after)->last < step) return std::nullopt;
    return static_cast<std::size_t>(std::prev(after) - ranges.begin());
}

}  // namespace

Recording::Recording(const CurvedMesh& mesh, QualityReport quality, std::size_t memory_limit)
    : mesh_(mesh),
      start_quality_(std::move(quality)),
      node_elements_(elements_of_nodes(mesh.topology())),
      store_(std::make_unique<StepStore>(memory_limit / 4 * 3)),
      keyframe_store_(std::make_unique<StepStore>(memory_limit / 4)) {}

std::uint64_t Recording::index_size() const {
    const auto bytes = [](const auto& values) { return values.capacity() * sizeof(values[0]); };
    return bytes(steps_) + bytes(passes_) + bytes(patches_) + bytes(quality_points_) + bytes(validity_changes_) +
           bytes(commits_) + bytes(keyframes_);
}

std::size_t Recording::memory() const {
    return store_->memory() + keyframe_store_->memory() + static_cast<std::size_t>(index_size());
}

std::optional<std::size_t> Recording::pass_of(StepNumber step) const {
    return range_of(passes(), step);
}

std::optional<std::size_t> Recording::patch_of(StepNumber step) const {
    return range_of(patches(), step);
}

const QualityPoint& Recording::quality_at(StepNumber step) const {
    const auto after = std::upper_bound(quality_points_.begin(), quality_points_.end(), step,
                                        [](StepNumber s, const QualityPoint& point) { return s < point.step; });
    return *std::prev(after);
}

std::vector<std::byte> Recording::bytes(StepNumber step) const {
    const std::uint64_t begin = offset(step), end = step + 1 < step_count() ? offset(step + 1) : store_->size();
    std::vector<std::byte> bytes(static_cast<std::size_t>(end - begin));
    store_->read(begin, bytes);
    return bytes;
}

StepEvent Recording::decode(StepNumber step, const event::PatchBegan* patch) const {
    return codec().decode(kind(step), bytes(step), patch);
}

event::PatchBegan Recording::read_patch(StepNumber began) const {
    return std::get<event::PatchBegan>(decode(began, nullptr));
}

StepEvent Recording::read(StepNumber step) const {
    const StepKind of_step = kind(step);
    const bool needs_patch =
        of_step == StepKind::bfgs_step || of_step == StepKind::energy_step || of_step == StepKind::patch_ended;
    if (!needs_patch) return decode(step, nullptr);
    const event::PatchBegan patch = read_patch(patches_[*patch_of(step)].first);
    return decode(step, &patch);
}

Recording::Delta Recording::read_delta(const Commit& commit) const {
    if (kind(commit.step) != StepKind::patch_ended) return codec().decode_moved(kind(commit.step), bytes(commit.step));
    event::PatchBegan patch = read_patch(patches_[*patch_of(commit.step)].first);
    auto ended = std::get<event::PatchEnded>(decode(commit.step, &patch));
    return {std::move(patch.nodes), std::move(patch.positions), std::move(ended.positions)};
}

Coordinates Recording::read_keyframe(const Keyframe& keyframe) const {
    Coordinates x(mesh_.coordinates().rows(), 3);
    keyframe_store_->read(keyframe.offset,
                          std::as_writable_bytes(std::span(x.data(), static_cast<std::size_t>(x.size()))));
    return x;
}

}  // namespace curvewright
