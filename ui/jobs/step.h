#pragma once

#include <optional>
#include <vector>

#include <QString>

#include "core/session/action.h"
#include "ui/document/notice.h"

namespace curvewright {

/// A new state of the mesh and what to say about it.
struct Step {
    Coordinates coordinates;
    QString name;
    QString details;  ///< with what it was made; with the note, what the history tells about it
    QString note;
    /// What was done, for the session; none: it would not come out the same again, so the moved nodes are recorded.
    std::optional<Action> action;
    QString advice;  ///< what to do next if elements are tangled in the new state
    /// What stays told until somebody has read it, about the new state.
    std::vector<Notice> notices;
    /// Whether a notice with the advice is to be made of elements that are tangled in the new state.
    bool warns_of_tangled = true;
    /// Least scaled Jacobian that was asked for explicitly; a notice tells if the new state does not have it.
    std::optional<double> target;
};

}  // namespace curvewright
