#include "core/untangle/unsigned_angles.h"

namespace curvewright {

UnsignedAngleOptions UnsignedAngleOptions::literal() {
    UnsignedAngleOptions options;
    options.gradient = AngleGradient::central_differences;
    options.first_steps = {0.01};
    options.tries_straight_edge = options.moves_face_nodes = options.is_guarded = false;
    options.target = 0.0;
    return options;
}

}  // namespace curvewright
