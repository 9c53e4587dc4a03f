#pragma once

#include <array>

#include "core/quality/quality.h"

namespace curvewright {

/// Red, green, blue in [0, 1] (sRGB).
using Color = std::array<double, 3>;

/// The one colour of a scaled Jacobian, in view, legend, histogram and tables. A sequential, perceptually even,
/// colour-blind-safe map over [0, 1], warm (bad) to light and calm (good); outside the map: an alarm colour for tangled
/// elements (invalid, or value <= 0) and a grey-violet one for undecided elements. NaN gives a neutral grey.
Color quality_color(double scaled_jacobian, Validity validity);
/// The map alone, value clamped to [0, 1].
Color quality_map(double scaled_jacobian);
Color tangled_color();
Color undecided_color();

}  // namespace curvewright
