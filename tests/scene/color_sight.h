#pragma once

#include "ui/palette/cielab.h"

namespace curvewright {

inline Color as_is(const Color& color) {
    return color;
}

/// What a person without green receptors sees: Viénot, Brettel, Mollon, "Digital video colourmaps for checking the
/// legibility of displays by dichromats", Color Res. Appl. 24, 1999, in linear RGB.
inline Color as_deuteranope(const Color& color) {
    const double r = to_linear(color[0]), g = to_linear(color[1]), b = to_linear(color[2]);
    const double yellow = 0.29275 * r + 0.70725 * g;
    return {from_linear(yellow), from_linear(yellow), from_linear(-0.02234 * r + 0.02234 * g + b)};
}

/// The same without red receptors.
inline Color as_protanope(const Color& color) {
    const double r = to_linear(color[0]), g = to_linear(color[1]), b = to_linear(color[2]);
    const double yellow = 0.11238 * r + 0.88762 * g;
    return {from_linear(yellow), from_linear(yellow), from_linear(0.00401 * r - 0.00401 * g + b)};
}

/// Without blue receptors: Machado, Oliveira, Fernandes, "A physiologically-based model for simulation of color vision
/// deficiency", IEEE Trans. Vis. Comput. Graph. 15, 2009, full severity, in linear RGB.
inline Color as_tritanope(const Color& color) {
    const double r = to_linear(color[0]), g = to_linear(color[1]), b = to_linear(color[2]);
    return {from_linear(1.255528 * r - 0.076749 * g - 0.178779 * b),
            from_linear(-0.078411 * r + 0.930809 * g + 0.147602 * b),
            from_linear(0.004733 * r + 0.691367 * g + 0.303900 * b)};
}

}  // namespace curvewright
