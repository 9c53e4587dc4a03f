#pragma once

#include <string>
#include <utility>
#include <vector>

namespace curvewright::benchmarks {

struct Series {
    std::string name;
    int color = 0;              ///< 0 to 3
    bool is_reference = false;  ///< dashed, hollow squares
    std::vector<std::pair<double, double>> points;
};

/// A plot with logarithmic axes, or with a linear x axis from zero on.
struct Plot {
    std::string name;  ///< of the SVG file, without suffix
    std::string title, x_label, y_label;
    std::vector<Series> series;
    bool has_linear_x = false;
};

/// An SVG picture with colours for light and for dark surroundings, and a line of slope 1 through the first series if
/// both axes are logarithmic.
/// Empty if there are no positive numbers to show.
std::string as_svg(const Plot& plot);

}  // namespace curvewright::benchmarks
