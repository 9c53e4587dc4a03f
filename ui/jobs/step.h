#pragma once

#include <QString>

#include "core/mesh/curved_mesh.h"

namespace curvewright {

/// A new state of the mesh and what to say about it.
struct Step {
    Coordinates coordinates;
    QString name;
    QString details;  ///< with what it was made; with the note, what the history tells about it
    QString note;
    QString advice;  ///< what to do next if elements are tangled in the new state
};

}  // namespace curvewright
