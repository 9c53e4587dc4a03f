#include "core/timeline/recorder.h"

#include <algorithm>
#include <bit>
#include <limits>

namespace curvewright {

namespace event = untangle_event;
using event::Position;

/// The least of many numbers, one of which changes at a time: a binary tree of minima.
class Recorder::Minimum {
  public:
    explicit Minimum(std::span<const ElementQuality> qualities)
        : leaves_(std::bit_ceil(std::max<std::size_t>(1, qualities.size()))),
          tree_(2 * leaves_, std::numeric_limits<double>::infinity()) {
        for (std::size_t i = 0; i < qualities.size(); ++i)
            if (qualities[i].validity != Validity::not_assessed) tree_[leaves_ + i] = qualities[i].scaled_jacobian;
        for (std::size_t i = leaves_; i-- > 1;) tree_[i] = std::min(tree_[2 * i], tree_[2 * i + 1]);
    }
    void set(Index element, double value) {
        std::size_t i = leaves_ + static_cast<std::size_t>(element);
        tree_[i] = value;
        while (i > 1) {
            i /= 2;
            tree_[i] = std::min(tree_[2 * i], tree_[2 * i + 1]);
        }
    }
    double least() const { return tree_[1]; }

  private:
    std::size_t leaves_;
    std::vector<double> tree_;
};

Recorder::Recorder(const RecorderOptions& options, const TaskContext& context) : options_(options), context_(context) {}
Recorder::~Recorder() = default;

void Recorder::start(const CurvedMesh& mesh) {
    QualityReport quality = assess_quality(mesh, {}, {context_.stop, {}});
    x_ = mesh.coordinates();
    minimum_ = std::make_unique<Minimum>(quality.elements);
    not_valid_ = quality.summary.invalid + quality.summary.undecided;
    for (const ElementQuality& element : quality.elements) validity_.push_back(element.validity);
    recording_.reset(new Recording(mesh, std::move(quality), options_.memory_limit));
    recording_->keyframes_.push_back({0, 0});
    recording_->keyframe_store_->append(std::as_bytes(std::span(x_.data(), static_cast<std::size_t>(x_.size()))));
    write(event::Started{}, nullptr);
    recording_->quality_points_.push_back({0, static_cast<float>(minimum_->least()), not_valid_});
}

void Recorder::on_event(const UntangleEvent& event) {
    if (const auto* started = std::get_if<event::Started>(&event)) return start(*started->mesh);
    context_.check();
    if (!problem_.empty()) return;
    try {
        std::visit([this](const auto& e) { add(StepEvent(e)); }, event);
    } catch (const InvalidInput& error) {
        problem_ = error.what();
        recording_->is_complete_ = false;
    }
}

void Recorder::write(const StepEvent& event, const StepCodec::Moved* moved) {
    bytes_.clear();
    recording_->codec().encode(event, patch_ ? &*patch_ : nullptr, moved, bytes_);
    const std::uint64_t offset = recording_->store_->append(bytes_.bytes());
    recording_->steps_.push_back(offset << 8 | static_cast<std::uint64_t>(kind_of(event)));
    const StepNumber step = recording_->step_count() - 1;
    if (!recording_->passes_.empty() && kind_of(event) != StepKind::finished) recording_->passes_.back().last = step;
    if (patch_ && !recording_->patches_.empty()) recording_->patches_.back().last = step;
}

void Recorder::place(std::span<const Index> nodes, std::span<const Position> positions) {
    for (std::size_t i = 0; i < nodes.size(); ++i)
        x_.row(nodes[i]) = Eigen::RowVector3d(positions[i][0], positions[i][1], positions[i][2]);
}

StepCodec::Moved Recorder::moved_nodes(std::span<const Index> nodes, std::span<const Position> positions) const {
    StepCodec::Moved moved;
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        const Position before = position_of(x_, nodes[i]);
        if (before == positions[i]) continue;
        moved.nodes.push_back(nodes[i]);
        moved.before.push_back(before);
        moved.after.push_back(positions[i]);
    }
    return moved;
}

std::vector<Index> Recorder::elements_at(std::span<const Index> nodes) const {
    std::vector<Index> elements;
    for (const Index node : nodes) {
        const auto of_node = recording_->node_elements_.of(node);
        elements.insert(elements.end(), of_node.begin(), of_node.end());
    }
    std::sort(elements.begin(), elements.end());
    elements.erase(std::unique(elements.begin(), elements.end()), elements.end());
    return elements;
}

void Recorder::judge(std::span<const Index> elements) {
    QualityOptions options;
    options.orientation_sign = recording_->start_quality_.orientation_sign;
    const auto qualities = certify_elements(recording_->mesh_.topology(), elements, x_, options, {context_.stop, {}});
    const StepNumber step = recording_->step_count() - 1;
    for (std::size_t i = 0; i < elements.size(); ++i) {
        if (qualities[i].validity == Validity::not_assessed) continue;
        minimum_->set(elements[i], qualities[i].scaled_jacobian);
        Validity& validity = validity_[elements[i]];
        if (validity == qualities[i].validity) continue;
        not_valid_ += (qualities[i].validity != Validity::valid) - (validity != Validity::valid);
        validity = qualities[i].validity;
        recording_->validity_changes_.push_back({step, elements[i], validity});
    }
    const QualityPoint point{step, static_cast<float>(minimum_->least()), not_valid_};
    const QualityPoint& last = recording_->quality_points_.back();
    if (last.min_scaled_jacobian != point.min_scaled_jacobian || last.not_valid != point.not_valid)
        recording_->quality_points_.push_back(point);
}

void Recorder::commit(std::size_t moved_nodes) {
    recording_->commits_.push_back({recording_->step_count() - 1, static_cast<std::uint32_t>(moved_nodes)});
    // A jump writes all positions of a keyframe and what commits changed since: about as much again at most. Reading a
    // commit is some work whatever it moves.
    constexpr std::size_t cost_of_reading = 8, least_cost = 256;
    cost_since_keyframe_ += moved_nodes + cost_of_reading;
    if (cost_since_keyframe_ < std::max(least_cost, static_cast<std::size_t>(x_.rows()))) return;
    cost_since_keyframe_ = 0;
    const std::uint64_t offset =
        recording_->keyframe_store_->append(std::as_bytes(std::span(x_.data(), static_cast<std::size_t>(x_.size()))));
    recording_->keyframes_.push_back({static_cast<std::uint32_t>(recording_->commits_.size()), offset});
}

void Recorder::add(const StepEvent& step) {
    struct Add {
        Recorder& recorder;
        const StepEvent& step;

        void simply() const { recorder.write(step, nullptr); }
        /// A commit outside a patch.
        void moved(std::span<const Index> nodes, std::span<const Position> positions) const {
            const StepCodec::Moved moved = recorder.moved_nodes(nodes, positions);
            recorder.write(step, &moved);
            recorder.place(moved.nodes, moved.after);
            recorder.commit(moved.nodes.size());
            recorder.judge(recorder.elements_at(moved.nodes));
        }

        void operator()(const event::Started&) const {}
        void operator()(const event::PassBegan& e) const {
            const StepNumber number = recorder.recording_->step_count();
            recorder.recording_->passes_.push_back({e.pass, number, number});
            recorder.patches_in_pass_ = 0;
            simply();
        }
        void operator()(const event::PatchBegan& e) const {
            auto& patches = recorder.recording_->patches_;
            RecordedPatch patch;
            patch.first = patch.last = recorder.recording_->step_count();
            patch.pass = static_cast<std::uint32_t>(std::max<std::size_t>(1, recorder.recording_->passes_.size()) - 1);
            patch.number = ++recorder.patches_in_pass_;
            patches.push_back(patch);
            recorder.patch_ = e;
            simply();
        }
        void operator()(const event::SimplexStep&) const { simply(); }
        void operator()(const event::BfgsStep&) const { simply(); }
        void operator()(const event::EnergyStep& e) const {
            simply();
            recorder.candidate_ = e.positions;
        }
        void operator()(const event::PatchCertified&) const {
            simply();
            if (!recorder.patch_ || recorder.candidate_.empty()) return;
            recorder.place(recorder.patch_->nodes, recorder.candidate_);
            recorder.judge(recorder.patch_->elements);
        }
        void operator()(const event::PatchEnded& e) const {
            simply();
            RecordedPatch& patch = recorder.recording_->patches_.back();
            patch.min_before = static_cast<float>(e.min_scaled_jacobian_before);
            patch.min_after = static_cast<float>(e.min_scaled_jacobian_after);
            recorder.place(e.nodes, e.positions);
            recorder.commit(e.nodes.size());
            recorder.judge(recorder.patch_->elements);
            recorder.patch_.reset();
            recorder.candidate_.clear();
        }
        void operator()(const event::FaceNodesMoved& e) const { moved(e.nodes, e.positions); }
        void operator()(const event::NodesPlaced& e) const {
            if (!recorder.patch_) return moved(e.nodes, e.positions);
            const StepCodec::Moved moved = recorder.moved_nodes(e.nodes, e.positions);
            recorder.write(step, &moved);
        }
        void operator()(const event::PassEnded&) const { simply(); }
        void operator()(const event::Finished&) const { simply(); }
        void operator()(const WarpIncrement&) const {}
    };
    std::visit(Add{*this, step}, step);
}

void Recorder::begin_warp(const CurvedMesh& mesh) {
    start(mesh);
    add(event::PassBegan{1});
}

void Recorder::add_increment(const WarpIncrement& increment, const Coordinates& coordinates) {
    context_.check();
    if (!problem_.empty()) return;
    try {
        const event::NodesPlaced placed = placed_nodes({}, x_, coordinates);
        const StepCodec::Moved moved = moved_nodes(placed.nodes, placed.positions);
        write(increment, &moved);
        place(moved.nodes, moved.after);
        commit(moved.nodes.size());
        judge(elements_at(moved.nodes));
    } catch (const InvalidInput& error) {
        problem_ = error.what();
        recording_->is_complete_ = false;
    }
}

void Recorder::end_warp(const Coordinates& coordinates, StopReason reason) {
    const event::NodesPlaced placed = placed_nodes(event::Placement::put_back, x_, coordinates);
    if (!placed.nodes.empty()) on_event(placed);
    on_event(event::Finished{reason, 1});
}

std::shared_ptr<const Recording> Recorder::finish() {
    recording_->steps_.shrink_to_fit();
    return std::move(recording_);
}

}  // namespace curvewright
