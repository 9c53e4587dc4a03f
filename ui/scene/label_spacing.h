#pragma once

#include <vector>

namespace curvewright {

/// Where a short text stands, in pixels.
struct LabelBox {
    double x = 0.0, y = 0.0;  ///< of its middle
    double width = 0.0, height = 0.0;
};

/// Moves texts that lie over each other apart, each by half of what is missing, along the axis on which less is
/// missing. Many texts in one place may still touch at the end.
void keep_apart(std::vector<LabelBox>& boxes);

}  // namespace curvewright
