#pragma once

#include <QString>

#include "core/basis/element_type.h"

namespace curvewright {

// What the core calls things, in the language of the window: the core itself speaks English.

/// "triangle", "3 tetrahedra" without the number.
QString shape_name(Shape shape, long count);
/// "P3 triangle".
QString type_name(ElementType type);
/// What a job is at: "Certifying elements", "Untangling, pass 3".
QString phase_text(const QString& phase);

}  // namespace curvewright
