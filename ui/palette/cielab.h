#pragma once

#include "ui/palette/color_map.h"

namespace curvewright {

/// CIE 1976 L*, a*, b* for the white point D65.
using Lab = std::array<double, 3>;

Lab to_lab(const Color& srgb);
/// Clamped to the sRGB gamut.
Color to_srgb(const Lab& lab);
/// CIE 1976 colour difference: Euclidean distance; about 2.3 is just noticeable.
double color_difference(const Lab& a, const Lab& b);

/// sRGB to linear light and back, one channel in [0, 1].
double to_linear(double channel);
double from_linear(double channel);

}  // namespace curvewright
