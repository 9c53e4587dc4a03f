#pragma once

#include <string>

#include "core/untangle/guaranteed.h"

namespace curvewright {

/// "Element 17 cannot be mended with the boundary as it is: …." where that is proved, else "Element 17 was not mended:
/// …."
std::string describe(const UnmendedElement& element, const MeshTopology& topology);

}  // namespace curvewright
