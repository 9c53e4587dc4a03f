#pragma once

#include <string>
#include <vector>

namespace curvewright {

/// A number beside the bar of a legend.
struct Tick {
    double value = 0.0;
    std::string label;
};

/// Both ends of a range and round numbers between them, ascending, with as many digits as tell them apart; 0, 0.25 ...
/// 1 for 0 to 1. At most seven. Empty ranges have one tick.
std::vector<Tick> legend_ticks(double lower, double upper);

}  // namespace curvewright
