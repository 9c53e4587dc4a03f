#pragma once

#include "core/quality/quality.h"
#include "ui/palette/color_map.h"

namespace curvewright {

/// The one colour of a scaled Jacobian, in view, legend, histogram and tables. By default a sequential, perceptually
/// even, colour-blind-safe map over [0, 1], warm (bad) to light and calm (good); outside the map: an alarm colour for
/// tangled elements (invalid, or value <= 0) and a grey-violet one for undecided elements. NaN gives a neutral grey.
Color quality_color(double scaled_jacobian, Validity validity, const ColorScale& scale = {});
/// The default map alone, value clamped to [0, 1].
Color quality_map(double scaled_jacobian);
Color tangled_color();
Color undecided_color();

}  // namespace curvewright
