#pragma once

#include <array>
#include <optional>
#include <string_view>

namespace curvewright {

/// Red, green, blue in [0, 1] (sRGB).
using Color = std::array<double, 3>;

/// Maps of numbers to colours, all made in CIELAB of equal colour differences, legible for the colour-blind.
enum class ColorMap {
    warm,     ///< burnt orange to pale blue-grey: what is low speaks
    deep,     ///< dark blue over green to pale yellow
    balance,  ///< blue over light grey to orange: what is on either side of the middle
    grey,     ///< dark to light grey
};
inline constexpr std::array<ColorMap, 4> color_maps = {ColorMap::warm, ColorMap::deep, ColorMap::balance,
                                                       ColorMap::grey};
/// "warm", "deep", "balance", "grey".
const char* to_string(ColorMap map);
std::optional<ColorMap> color_map_of(std::string_view name);

/// The colour at t, clamped to [0, 1]; no_value_color() for NaN.
Color map_color(ColorMap map, double t);
/// Where there is no number.
Color no_value_color();

/// A map over a range of numbers. What is outside has the colour of the nearer end.
struct ColorScale {
    ColorMap map = ColorMap::warm;
    bool is_reversed = false;
    double lower = 0.0, upper = 1.0;  ///< if upper <= lower, all numbers have the colour of the middle

    /// Position in the range, not clamped; 0.5 where the range is empty.
    double position(double value) const {
        return upper > lower ? (value - lower) / (upper - lower) : 0.5 + 0.0 * value;
    }
    Color color_of(double value) const {
        const double t = position(value);
        return map_color(map, is_reversed ? 1.0 - t : t);
    }
    friend bool operator==(const ColorScale&, const ColorScale&) = default;
};

/// The scale over a range of data: of a diverging map about 0 if there are data on either side of it, and never so
/// narrow that only rounding would be seen.
ColorScale fitted(ColorScale scale, double lower, double upper);

}  // namespace curvewright
