#include "ui/palette/quality_colors.h"

namespace curvewright {

Color quality_map(double scaled_jacobian) {
    return map_color(ColorMap::warm, scaled_jacobian);
}

Color quality_color(double scaled_jacobian, Validity validity, const ColorScale& scale) {
    if (validity == Validity::undecided) return undecided_color();
    if (validity == Validity::invalid || scaled_jacobian <= 0.0) return tangled_color();
    return scale.color_of(scaled_jacobian);
}

Color tangled_color() {
    return {0.839, 0.0, 0.424};
}

Color undecided_color() {
    return {0.478, 0.408, 0.659};
}

}  // namespace curvewright
