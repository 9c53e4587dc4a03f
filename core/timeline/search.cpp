#include "core/timeline/search.h"

#include <algorithm>

namespace curvewright {
namespace {

namespace event = untangle_event;

bool ends(StepKind kind, StepLevel level) {
    switch (kind) {
        case StepKind::started:
        case StepKind::pass_ended:
        case StepKind::finished:
            return true;
        case StepKind::patch_ended:
        case StepKind::face_nodes_moved:
        case StepKind::increment:
            return level != StepLevel::pass;
        default:
            return level == StepLevel::iteration;
    }
}

bool have_common(const std::vector<Index>& sorted, const std::vector<Index>& others) {
    return std::any_of(others.begin(), others.end(),
                       [&](Index i) { return std::binary_search(sorted.begin(), sorted.end(), i); });
}

}  // namespace

StepNumber step_after(const Recording& recording, StepNumber step, StepLevel level) {
    const StepNumber last = recording.step_count() - 1;
    while (step < last)
        if (ends(recording.kind(++step), level)) return step;
    return last;
}

StepNumber step_before(const Recording& recording, StepNumber step, StepLevel level) {
    while (step > 0)
        if (ends(recording.kind(--step), level)) return step;
    return 0;
}

StepNumber worst_step(const Recording& recording) {
    const auto points = recording.quality_points();
    return std::min_element(points.begin(), points.end(),
                            [](const QualityPoint& a, const QualityPoint& b) {
                                return a.not_valid != b.not_valid ? a.not_valid > b.not_valid
                                                                  : a.min_scaled_jacobian < b.min_scaled_jacobian;
                            })
        ->step;
}

std::optional<StepNumber> step_of_validity(const Recording& recording, Index element) {
    Validity validity = recording.start_quality().elements[element].validity;
    StepNumber since = 0;
    for (const ValidityChange& change : recording.validity_changes()) {
        if (change.element != element) continue;
        validity = change.validity;
        since = change.step;
    }
    if (validity != Validity::valid) return std::nullopt;
    return since;
}

std::optional<StepNumber> next_break(const Recording& recording, StepNumber step, const Breakpoints& breakpoints,
                                     const TaskContext& context) {
    std::optional<StepNumber> first;
    const auto offer = [&](StepNumber candidate) {
        if (candidate > step && (!first || candidate < *first)) first = candidate;
    };
    if (breakpoints.min_crosses_zero) {
        const auto points = recording.quality_points();
        for (std::size_t i = 1; i < points.size() && !first; ++i)
            if ((points[i].min_scaled_jacobian > 0.0f) != (points[i - 1].min_scaled_jacobian > 0.0f))
                offer(points[i].step);
    }
    std::vector<Index> elements = breakpoints.elements, nodes = breakpoints.nodes;
    std::sort(elements.begin(), elements.end());
    std::sort(nodes.begin(), nodes.end());
    for (const ValidityChange& change : recording.validity_changes())
        if (change.step > step && std::binary_search(elements.begin(), elements.end(), change.element)) {
            offer(change.step);
            break;
        }
    if (elements.empty() && nodes.empty()) return first;
    const auto patches = recording.patches();
    auto patch = std::upper_bound(patches.begin(), patches.end(), step,
                                  [](StepNumber s, const RecordedPatch& p) { return s < p.first; });
    for (; patch != patches.end() && (!first || patch->first < *first); ++patch) {
        context.check();
        const auto began = std::get<event::PatchBegan>(recording.read(patch->first));
        if (have_common(elements, began.elements) || have_common(nodes, began.nodes)) return patch->first;
    }
    return first;
}

std::vector<StepNumber> break_steps(const Recording& recording, const Breakpoints& breakpoints,
                                    const TaskContext& context) {
    std::vector<StepNumber> steps;
    const auto points = recording.quality_points();
    for (std::size_t i = 1; breakpoints.min_crosses_zero && i < points.size(); ++i)
        if ((points[i].min_scaled_jacobian > 0.0f) != (points[i - 1].min_scaled_jacobian > 0.0f))
            steps.push_back(points[i].step);
    std::vector<Index> elements = breakpoints.elements, nodes = breakpoints.nodes;
    std::sort(elements.begin(), elements.end());
    std::sort(nodes.begin(), nodes.end());
    if (!elements.empty())
        for (const ValidityChange& change : recording.validity_changes())
            if (std::binary_search(elements.begin(), elements.end(), change.element)) steps.push_back(change.step);
    if (!elements.empty() || !nodes.empty())
        for (const RecordedPatch& patch : recording.patches()) {
            context.check();
            const auto began = std::get<event::PatchBegan>(recording.read(patch.first));
            if (have_common(elements, began.elements) || have_common(nodes, began.nodes)) steps.push_back(patch.first);
        }
    std::sort(steps.begin(), steps.end());
    steps.erase(std::unique(steps.begin(), steps.end()), steps.end());
    return steps;
}

std::vector<event::Position> node_path(const Recording& recording, Index node, StepNumber step) {
    const RecordedPatch& patch = recording.patches()[*recording.patch_of(step)];
    const auto began = std::get<event::PatchBegan>(recording.read(patch.first));
    const auto found = std::find(began.nodes.begin(), began.nodes.end(), node);
    const auto at = static_cast<std::size_t>(found - began.nodes.begin());
    std::vector<event::Position> path{began.positions[at]};
    const auto add = [&](const event::Position& position) {
        if (path.back() != position) path.push_back(position);
    };
    for (StepNumber s = patch.first + 1; s <= step; ++s) {
        const StepEvent read = recording.read(s);
        if (const auto* simplex = std::get_if<event::SimplexStep>(&read)) {
            if (simplex->node == node) add({simplex->simplex[0][0], simplex->simplex[0][1], began.positions[at][2]});
        } else if (const auto* bfgs = std::get_if<event::BfgsStep>(&read)) {
            // A further attempt begins where the patch began.
            if (bfgs->iteration == 0) path.clear(), path.push_back(began.positions[at]);
            if (at < bfgs->positions.size()) add(bfgs->positions[at]);
        } else if (const auto* energy = std::get_if<event::EnergyStep>(&read)) {
            add(energy->positions[at]);
        } else if (const auto* placed = std::get_if<event::NodesPlaced>(&read)) {
            for (std::size_t i = 0; i < placed->nodes.size(); ++i)
                if (placed->nodes[i] == node) add(placed->positions[i]);
        } else if (const auto* ended = std::get_if<event::PatchEnded>(&read)) {
            add(ended->positions[at]);
        }
    }
    return path;
}

}  // namespace curvewright
