#include "ui/palette/color_map.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>

#include "ui/palette/cielab.h"

namespace curvewright {
namespace {

/// Control colours from 0 (burnt orange) to 1 (pale blue-grey): lightness rises all the way, so that the order is told
/// without any sense of hue; the hue goes from orange to blue, the pair that every common colour blindness keeps.
constexpr std::array<Lab, 6> warm_controls{{{41.0, 40.0, 50.0},
                                            {55.0, 34.0, 56.0},
                                            {68.0, 19.0, 52.0},
                                            {79.0, 6.0, 38.0},
                                            {86.0, -1.0, 16.0},
                                            {90.5, -4.0, -5.0}}};
/// Rising lightness again, from blue to yellow, which tritanopes too tell apart by it.
constexpr std::array<Lab, 6> deep_controls{{{17.0, 12.0, -30.0},
                                            {33.0, 2.0, -32.0},
                                            {50.0, -14.0, -22.0},
                                            {66.0, -26.0, 2.0},
                                            {81.0, -22.0, 32.0},
                                            {94.0, -10.0, 50.0}}};
/// Two halves that meet in light grey: equally dark at their ends.
constexpr std::array<Lab, 4> low_controls{
    {{38.0, 0.0, -38.0}, {57.0, -4.0, -29.0}, {75.0, -4.0, -15.0}, {91.0, 0.0, 0.0}}};
constexpr std::array<Lab, 4> high_controls{
    {{91.0, 0.0, 0.0}, {75.0, 13.0, 22.0}, {57.0, 23.0, 38.0}, {38.0, 29.0, 42.0}}};
constexpr std::array<Lab, 2> grey_controls{{{16.0, 0.0, 0.0}, {92.0, 0.0, 0.0}}};

Lab at_parameter(std::span<const Lab> controls, double t) {
    const double position = std::clamp(t, 0.0, 1.0) * static_cast<double>(controls.size() - 1);
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
using Table = std::array<Color, table_size>;

/// Fills count colours at equal steps of the value, each the same colour difference from the next.
void fill_evenly(std::span<const Lab> controls, Color* colors, std::size_t count) {
    constexpr std::size_t fine = 4096;
    std::array<double, fine + 1> length{};
    for (std::size_t i = 1; i <= fine; ++i)
        length[i] = length[i - 1] + color_difference(at_parameter(controls, static_cast<double>(i - 1) / fine),
                                                     at_parameter(controls, static_cast<double>(i) / fine));
    std::size_t i = 0;
    for (std::size_t k = 0; k < count; ++k) {
        const double target = length[fine] * static_cast<double>(k) / static_cast<double>(count - 1);
        while (i < fine && length[i + 1] < target) ++i;
        const double step = i < fine ? length[i + 1] - length[i] : 0.0;
        const double u = step > 0.0 ? (target - length[i]) / step : 0.0;
        colors[k] = to_srgb(at_parameter(controls, (static_cast<double>(i) + u) / fine));
    }
}

Table make_table(ColorMap map) {
    Table table{};
    switch (map) {
        case ColorMap::warm:
            fill_evenly(warm_controls, table.data(), table_size);
            break;
        case ColorMap::deep:
            fill_evenly(deep_controls, table.data(), table_size);
            break;
        case ColorMap::balance: {
            constexpr std::size_t middle = table_size / 2;
            fill_evenly(low_controls, table.data(), middle + 1);
            fill_evenly(high_controls, table.data() + middle, middle + 1);
            break;
        }
        case ColorMap::grey:
            fill_evenly(grey_controls, table.data(), table_size);
            break;
    }
    return table;
}

const Table& table_of(ColorMap map) {
    static const std::array<Table, color_maps.size()> tables = {make_table(ColorMap::warm), make_table(ColorMap::deep),
                                                                make_table(ColorMap::balance),
                                                                make_table(ColorMap::grey)};
    return tables[static_cast<std::size_t>(map)];
}

}  // namespace

const char* to_string(ColorMap map) {
    switch (map) {
        case ColorMap::warm:
            return "warm";
        case ColorMap::deep:
            return "deep";
        case ColorMap::balance:
            return "balance";
        case ColorMap::grey:
            return "grey";
    }
    return "";
}

std::optional<ColorMap> color_map_of(std::string_view name) {
    for (const ColorMap map : color_maps)
        if (name == to_string(map)) return map;
    return std::nullopt;
}

Color map_color(ColorMap map, double t) {
    if (std::isnan(t)) return no_value_color();
    const Table& table = table_of(map);
    const double position = std::clamp(t, 0.0, 1.0) * (table_size - 1);
    const auto k = std::min(static_cast<std::size_t>(position), table_size - 2);
    const double u = position - static_cast<double>(k);
    Color color{};
    for (std::size_t i = 0; i < 3; ++i) color[i] = (1.0 - u) * table[k][i] + u * table[k + 1][i];
    return color;
}

ColorScale fitted(ColorScale scale, double lower, double upper) {
    // What differs by no more than rounding is one number.
    const double size = std::max(std::abs(lower), std::abs(upper));
    if (!(upper - lower > 1e-9 * size)) {
        const double room = size > 0.0 ? 0.1 * size : 1.0;
        lower -= room;
        upper += room;
    }
    if (scale.map == ColorMap::balance && lower < 0.0 && upper > 0.0) {
        upper = std::max(-lower, upper);
        lower = -upper;
    }
    scale.lower = lower;
    scale.upper = upper;
    return scale;
}

Color no_value_color() {
    return {0.72, 0.72, 0.72};
}

}  // namespace curvewright
