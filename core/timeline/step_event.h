#pragma once

#include <cstdint>
#include <variant>

#include "core/quality/quality.h"
#include "core/untangle/observer.h"

namespace curvewright {

/// A state on the way of a warp in increments.
struct WarpIncrement {
    double fraction = 0.0;  ///< of the motion
    bool is_accepted = false;
    double min_scaled_jacobian = 0.0;
    Index invalid = 0, undecided = 0;
};

/// In the order of StepEvent's alternatives.
enum class StepKind : std::uint8_t {
    started,
    pass_began,
    patch_began,
    simplex_step,
    bfgs_step,
    energy_step,
    patch_certified,
    patch_ended,
    face_nodes_moved,
    nodes_placed,
    pass_ended,
    finished,
    increment,
};

/// What happened in a step of a timeline. Pointers of the events are null.
using StepEvent =
    std::variant<untangle_event::Started, untangle_event::PassBegan, untangle_event::PatchBegan,
                 untangle_event::SimplexStep, untangle_event::BfgsStep, untangle_event::EnergyStep,
                 untangle_event::PatchCertified, untangle_event::PatchEnded, untangle_event::FaceNodesMoved,
                 untangle_event::NodesPlaced, untangle_event::PassEnded, untangle_event::Finished, WarpIncrement>;

/// What kind of event it is.
inline StepKind kind_of(const StepEvent& event) {
    return static_cast<StepKind>(event.index());
}

}  // namespace curvewright
