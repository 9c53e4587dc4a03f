#include "ui/palette/quality_colors.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "ui/palette/cielab.h"

namespace curvewright {
namespace {

/// Control colours from 0 (burnt orange) to 1 (pale blue-grey): lightness rises all the way, so that the order is told
/// without any sense of hue; the hue goes from orange to blue, the pair that every common colour blindness keeps.
constexpr std::array<Lab, 6> controls{{{41.0, 40.0, 50.0},
                                       {55.0, 34.0, 56.0},
                                       {68.0, 19.0, 52.0},
                                       {79.0, 6.0, 38.0},
                                       {86.0, -1.0, 16.0},
                                       {90.5, -4.0, -5.0}}};

Lab at_parameter(double t) {
    const double position = std::clamp(t, 0.0, 1.0) * (controls.size() - 1);
    const auto k = std::min(static_cast<std::size_t>(position), controls.size() - 2);
    const double u = position - static_cast<double>(k);
    Lab lab{};
    for (std::size_t i = 0; i < 3; ++i) {
        // Catmull-Rom through the control colours: no kinks, which the eye would read as features of the data.
        const double p1 = controls[k][i], p2 = controls[k + 1][i];
        const double p0 = k > 0 ? controls[k - 1][i] : 2.0 * p1 - p2;
        const double p3 = k + 2 < controls.size() ? controls[k + 2][i] : 2.0 * p2 - p1;
        lab[i] = p1 + 0.5 * u * (p2 - p0 + u * (2.0 * p0 - 5.0 * p1 + 4.0 * p2 - p3 + u * (3.0 * (p1 - p2) + p3 - p0)));
    }
    return lab;
}

constexpr std::size_t table_size = 513;

/// The map at table_size equal steps of the value, each the same colour difference from the next.
std::array<Color, table_size> make_table() {
    constexpr std::size_t fine = 4096;
    std::array<double, fine + 1> length{};
    for (std::size_t i = 1; i <= fine; ++i)
        length[i] = length[i - 1] + color_difference(at_parameter(static_cast<double>(i - 1) / fine),
                                                     at_parameter(static_cast<double>(i) / fine));
    std::array<Color, table_size> table{};
    std::size_t i = 0;
    for (std::size_t k = 0; k < table_size; ++k) {
        const double target = length[fine] * static_cast<double>(k) / (table_size - 1);
        while (i < fine && length[i + 1] < target) ++i;
        const double step = i < fine ? length[i + 1] - length[i] : 0.0;
        const double u = step > 0.0 ? (target - length[i]) / step : 0.0;
        table[k] = to_srgb(at_parameter((static_cast<double>(i) + u) / fine));
    }
    return table;
}

}  // namespace

Color quality_map(double scaled_jacobian) {
    static const std::array<Color, table_size> table = make_table();
    if (std::isnan(scaled_jacobian)) return {0.72, 0.72, 0.72};
    const double position = std::clamp(scaled_jacobian, 0.0, 1.0) * (table_size - 1);
    const auto k = std::min(static_cast<std::size_t>(position), table_size - 2);
    const double u = position - static_cast<double>(k);
    Color color{};
    for (std::size_t i = 0; i < 3; ++i) color[i] = (1.0 - u) * table[k][i] + u * table[k + 1][i];
    return color;
}

Color quality_color(double scaled_jacobian, Validity validity) {
    if (validity == Validity::undecided) return undecided_color();
    if (validity == Validity::invalid || scaled_jacobian <= 0.0) return tangled_color();
    return quality_map(scaled_jacobian);
}

Color tangled_color() {
    return {0.839, 0.0, 0.424};
}

Color undecided_color() {
    return {0.478, 0.408, 0.659};
}

}  // namespace curvewright
