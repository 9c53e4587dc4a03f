#include "core/timeline/cursor.h"

#include <algorithm>

namespace curvewright {

namespace event = untangle_event;
using event::Position;

TimelineCursor::TimelineCursor(std::shared_ptr<const Recording> recording)
    : recording_(std::move(recording)),
      x_(recording_->mesh().coordinates()),
      quality_(recording_->start_quality()),
      is_stale_(quality_.elements.size(), 0) {}

void TimelineCursor::mark_elements_of(Index node) {
    for (const Index element : recording_->node_elements().of(node)) {
        if (is_stale_[element]) continue;
        is_stale_[element] = 1;
        stale_.push_back(element);
    }
}

void TimelineCursor::place(std::span<const Index> nodes, std::span<const Position> positions) {
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        const Eigen::RowVector3d position(positions[i][0], positions[i][1], positions[i][2]);
        if (x_.row(nodes[i]) == position) continue;
        x_.row(nodes[i]) = position;
        mark_elements_of(nodes[i]);
    }
}

void TimelineCursor::apply(std::size_t commit, bool forward) {
    const Recording::Delta delta = recording_->read_delta(recording_->commits_[commit]);
    place(delta.nodes, forward ? delta.after : delta.before);
}

void TimelineCursor::jump_to(std::size_t keyframe) {
    const Coordinates x = recording_->read_keyframe(recording_->keyframes_[keyframe]);
    for (Eigen::Index node = 0; node < x.rows(); ++node)
        if (x_.row(node) != x.row(node)) mark_elements_of(static_cast<Index>(node));
    x_ = x;
    commits_ = recording_->keyframes_[keyframe].commits;
}

void TimelineCursor::seek_commits(std::size_t count) {
    if (count == commits_) return;
    const auto& keyframes = recording_->keyframes_;
    const auto after = std::upper_bound(keyframes.begin(), keyframes.end(), count,
                                        [](std::size_t c, const Recording::Keyframe& k) { return c < k.commits; });
    const std::size_t before = static_cast<std::size_t>(after - keyframes.begin()) - 1;
    // From the keyframe before it, unless the present place is nearer.
    const std::size_t from_here = count > commits_ ? count - commits_ : commits_ - count;
    const std::size_t from_keyframe = count - keyframes[before].commits;
    const std::size_t cost_of_jump = static_cast<std::size_t>(x_.rows()) / 64;
    if (from_keyframe + cost_of_jump < from_here) jump_to(before);
    while (commits_ < count) {
        apply(commits_, true);
        ++commits_;
    }
    while (commits_ > count) {
        apply(commits_ - 1, false);
        --commits_;
    }
}

void TimelineCursor::leave_patch() {
    if (patch_) place(patch_->nodes, patch_->positions);
    patch_.reset();
    patch_number_.reset();
}

/// Puts the patch's nodes where the last steps within it had them.
void TimelineCursor::enter_patch() {
    const RecordedPatch& patch = recording_->patches()[*patch_number_];
    if (recording_->kind(step_) == StepKind::patch_ended) return;  // done by its commit
    std::vector<Position> positions = patch_->positions;
    std::vector<char> is_set(positions.size(), 0);
    std::size_t open = positions.size();
    const auto set = [&](std::size_t i, const Position& position) {
        if (is_set[i]) return;
        is_set[i] = 1;
        positions[i] = position;
        --open;
    };
    for (StepNumber step = step_; open > 0 && step > patch.first; --step) {
        const StepKind kind = recording_->kind(step);
        if (kind == StepKind::energy_step) {
            positions = std::get<event::EnergyStep>(recording_->decode(step, &*patch_)).positions;
            break;
        }
        if (kind == StepKind::bfgs_step) {
            const auto bfgs = std::get<event::BfgsStep>(recording_->decode(step, &*patch_));
            for (std::size_t i = 0; i < bfgs.positions.size(); ++i) set(i, bfgs.positions[i]);
            break;
        }
        if (kind == StepKind::simplex_step) {
            const auto simplex = std::get<event::SimplexStep>(recording_->decode(step, nullptr));
            const auto node = std::find(patch_->nodes.begin(), patch_->nodes.end(), simplex.node);
            if (node == patch_->nodes.end()) continue;
            const auto i = static_cast<std::size_t>(node - patch_->nodes.begin());
            set(i, {simplex.simplex[0][0], simplex.simplex[0][1], positions[i][2]});
        }
        if (kind == StepKind::nodes_placed) {
            const auto placed = std::get<event::NodesPlaced>(recording_->decode(step, nullptr));
            for (std::size_t k = 0; k < placed.nodes.size(); ++k) {
                const auto node = std::find(patch_->nodes.begin(), patch_->nodes.end(), placed.nodes[k]);
                if (node != patch_->nodes.end())
                    set(static_cast<std::size_t>(node - patch_->nodes.begin()), placed.positions[k]);
            }
        }
    }
    place(patch_->nodes, positions);
}

void TimelineCursor::seek(StepNumber step, const TaskContext& context) {
    const auto& commits = recording_->commits_;
    const auto count = static_cast<std::size_t>(
        std::upper_bound(commits.begin(), commits.end(), step,
                         [](StepNumber s, const Recording::Commit& commit) { return s < commit.step; }) -
        commits.begin());
    const auto patch_number = recording_->patch_of(step);
    const bool stays_in_patch = patch_number && patch_number == patch_number_ && count == commits_;
    if (!stays_in_patch) {
        // A patch that has ended is where its commit put it.
        if (patch_ && recording_->kind(step_) != StepKind::patch_ended) leave_patch();
        patch_.reset();
        patch_number_.reset();
        seek_commits(count);
        if (patch_number) {
            patch_ = recording_->read_patch(recording_->patches()[*patch_number].first);
            patch_number_ = patch_number;
        }
    }
    step_ = step;
    if (patch_) enter_patch();
    if (stale_.empty()) return;
    QualityOptions options;
    options.orientation_sign = quality_.orientation_sign;
    update_quality(quality_, recording_->mesh().topology(), x_, stale_, options, {context.stop, {}});
    for (const Index element : stale_) is_stale_[element] = 0;
    stale_.clear();
}

}  // namespace curvewright
