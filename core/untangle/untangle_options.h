#pragma once

#include <variant>

#include "core/untangle/guaranteed.h"
#include "core/untangle/signed_angles.h"
#include "core/untangle/unsigned_angles.h"

namespace curvewright {

/// In the order of UntangleOptions' alternatives.
enum class UntangleMethod { guaranteed, signed_angles, unsigned_angles };
/// The options of a method tell which it is.
using UntangleOptions = std::variant<GuaranteedOptions, SignedAngleOptions, UnsignedAngleOptions>;

/// The method that the options are of.
inline UntangleMethod method_of(const UntangleOptions& options) {
    return static_cast<UntangleMethod>(options.index());
}

}  // namespace curvewright
