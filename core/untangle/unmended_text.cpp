#include "core/untangle/unmended_text.h"

#include <fmt/format.h>

namespace curvewright {

std::string describe(const UnmendedElement& element, const MeshTopology& topology) {
    std::string interfaces;
    for (const std::string& name : element.fixed_interfaces)
        interfaces += fmt::format("{}\"{}\"", interfaces.empty() ? "" : ", ", name);
    if (!interfaces.empty())
        interfaces =
            fmt::format(" (it has nodes on {}, fixed inside the domain: --boundary \"{}=slide\" lets them slide)",
                        interfaces, element.fixed_interfaces.front());
    return fmt::format("Element {} {}: {}{}.", topology.element_tag(element.element).value,
                       element.is_proved ? "cannot be mended with the boundary as it is" : "was not mended",
                       element.reason, interfaces);
}

}  // namespace curvewright
