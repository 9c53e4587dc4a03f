#include "core/untangle/unmended_text.h"

#include <fmt/format.h>

namespace curvewright {

std::string describe(const UnmendedElement& element, const MeshTopology& topology) {
    return fmt::format("Element {} {}: {}.", topology.element_tag(element.element).value,
                       element.is_proved ? "cannot be mended with the boundary as it is" : "was not mended",
                       element.reason);
}

}  // namespace curvewright
