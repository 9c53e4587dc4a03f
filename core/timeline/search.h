#pragma once

#include <optional>
#include <vector>

#include "core/base/task.h"
#include "core/timeline/recording.h"

namespace curvewright {

/// How far one step of the player goes.
enum class StepLevel {
    pass,       ///< to the end of a pass
    patch,      ///< to the end of a patch, or whatever else moves nodes
    iteration,  ///< to the next step
};
/// The next or previous step of that level; the last or first step where there is none.
StepNumber step_after(const Recording& recording, StepNumber step, StepLevel level);
/// The previous step of that level; the first one where there is none.
StepNumber step_before(const Recording& recording, StepNumber step, StepLevel level);

/// Where most elements are not valid and, of such steps, the scaled Jacobian is least; the first one.
StepNumber worst_step(const Recording& recording);

/// The step from which on an element is valid to the end; none if it is not valid at the end. 0 = it was all along.
std::optional<StepNumber> step_of_validity(const Recording& recording, Index element);

/// Where the player stops.
struct Breakpoints {
    std::vector<Index> elements;    ///< a patch with one of them begins, or one becomes valid or not valid
    std::vector<Index> nodes;       ///< a patch with one of them begins
    bool min_crosses_zero = false;  ///< the least scaled Jacobian of the mesh changes its sign
    bool is_empty() const { return elements.empty() && nodes.empty() && !min_crosses_zero; }
};
/// The first step after `step` where the player stops; none up to the end. Throws Cancelled.
std::optional<StepNumber> next_break(const Recording& recording, StepNumber step, const Breakpoints& breakpoints,
                                     const TaskContext& context = {});

/// All of them, ascending. Throws Cancelled.
std::vector<StepNumber> break_steps(const Recording& recording, const Breakpoints& breakpoints,
                                    const TaskContext& context = {});

/// Where one of a patch's nodes was in the steps of the patch up to a step, from the patch's start; each position once.
/// pre: the step is in a patch with this node.
std::vector<untangle_event::Position> node_path(const Recording& recording, Index node, StepNumber step);

}  // namespace curvewright
