/// The maps beside the one of the scaled Jacobian: even, in order, and legible for every sight.

#include <algorithm>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "tests/scene/color_sight.h"
#include "ui/palette/cielab.h"
#include "ui/palette/color_map.h"
#include "ui/scene/legend_ticks.h"

namespace curvewright {
namespace {

constexpr std::array sights = {as_is, as_deuteranope, as_protanope, as_tritanope};

Lab seen(ColorMap map, double t, Color (*sight)(const Color&)) {
    return to_lab(sight(map_color(map, t)));
}

TEST(ColorMap, LightnessTellsTheOrderForEverySight) {
    for (const ColorMap map : color_maps)
        for (const auto sight : sights)
            for (int i = 1; i <= 100; ++i) {
                const double before = seen(map, (i - 1) / 100.0, sight)[0], after = seen(map, i / 100.0, sight)[0];
                // Over light grey in the middle of the diverging map.
                if (map == ColorMap::balance && i > 50)
                    EXPECT_LT(after, before) << to_string(map) << " " << i;
                else
                    EXPECT_GT(after, before) << to_string(map) << " " << i;
            }
}

TEST(ColorMap, StepsAreEven) {
    for (const ColorMap map : color_maps) {
        double smallest = 1e9, largest = 0.0;
        for (int i = 0; i < 50; ++i) {
            const double step = color_difference(seen(map, i / 50.0, as_is), seen(map, (i + 1) / 50.0, as_is));
            smallest = std::min(smallest, step);
            largest = std::max(largest, step);
        }
        EXPECT_GT(smallest, 1.0) << to_string(map);
        EXPECT_LT(largest / smallest, 1.3) << to_string(map);
    }
}

TEST(ColorMap, PartsOfAMapAreToldApartByEverySight) {
    // Seven colours of a map, and the two halves of the diverging one.
    for (const ColorMap map : color_maps)
        for (const auto sight : sights)
            for (int i = 0; i < 6; ++i)
                for (int j = i + 1; j <= 6; ++j)
                    if (!(map == ColorMap::balance && i > 0 && j < 6)) {
                        EXPECT_GT(color_difference(seen(map, i / 6.0, sight), seen(map, j / 6.0, sight)), 8.0)
                            << to_string(map) << " " << i << " " << j;
                    }
    for (const auto sight : sights)
        for (int i = 0; i < 3; ++i)
            EXPECT_GT(color_difference(seen(ColorMap::balance, i / 6.0, sight),
                                       seen(ColorMap::balance, 1.0 - i / 6.0, sight)),
                      15.0)
                << i;
}

TEST(ColorMap, ColoursAreInsideTheGamut) {
    for (const ColorMap map : color_maps)
        for (int i = 0; i <= 100; ++i)
            for (const double channel : map_color(map, i / 100.0)) {
                EXPECT_GT(channel, 0.0) << to_string(map) << " " << i;
                EXPECT_LT(channel, 1.0) << to_string(map) << " " << i;
            }
}

TEST(ColorMap, NamesAreKnown) {
    for (const ColorMap map : color_maps) EXPECT_EQ(color_map_of(to_string(map)), map);
    EXPECT_EQ(color_map_of("rainbow"), std::nullopt);
}

TEST(ColorScale, ClampsReversesAndKnowsWhatIsNoNumber) {
    const double none = std::numeric_limits<double>::quiet_NaN();
    const ColorScale scale{ColorMap::deep, false, -2.0, 6.0};
    EXPECT_EQ(scale.color_of(2.0), map_color(ColorMap::deep, 0.5));
    EXPECT_EQ(scale.color_of(-50.0), map_color(ColorMap::deep, 0.0));
    EXPECT_EQ(scale.color_of(50.0), map_color(ColorMap::deep, 1.0));
    EXPECT_EQ(scale.color_of(none), no_value_color());
    ColorScale reversed = scale;
    reversed.is_reversed = true;
    EXPECT_EQ(reversed.color_of(-2.0), scale.color_of(6.0));
    const ColorScale empty{ColorMap::grey, false, 1.0, 1.0};
    EXPECT_EQ(empty.color_of(1.0), map_color(ColorMap::grey, 0.5));
    EXPECT_EQ(empty.color_of(none), no_value_color());
}

TEST(ColorScale, FitsTheData) {
    const auto range = [](ColorMap map, double lower, double upper) {
        const ColorScale scale = fitted({map, true, 0.0, 1.0}, lower, upper);
        EXPECT_EQ(scale.map, map);
        EXPECT_TRUE(scale.is_reversed);
        return std::pair(scale.lower, scale.upper);
    };
    EXPECT_EQ(range(ColorMap::deep, -1.0, 3.0), std::pair(-1.0, 3.0));
    EXPECT_EQ(range(ColorMap::balance, -1.0, 3.0), std::pair(-3.0, 3.0));  // 0 in the middle
    EXPECT_EQ(range(ColorMap::balance, 1.0, 3.0), std::pair(1.0, 3.0));
    EXPECT_EQ(range(ColorMap::deep, 5.0, 5.0), std::pair(4.5, 5.5));
    EXPECT_EQ(range(ColorMap::deep, 0.0, 0.0), std::pair(-1.0, 1.0));
    EXPECT_NEAR(range(ColorMap::deep, 5.0, 5.0 + 1e-14).second, 5.5, 1e-12);  // rounding
    EXPECT_EQ(range(ColorMap::deep, 1e-20, 2e-20), std::pair(1e-20, 2e-20));  // small numbers are numbers
}

std::string labels(double lower, double upper) {
    std::string text;
    double last = -std::numeric_limits<double>::infinity();
    for (const Tick& tick : legend_ticks(lower, upper)) {
        EXPECT_GT(tick.value, last);
        last = tick.value;
        text += (text.empty() ? "" : " ") + tick.label;
    }
    return text;
}

TEST(LegendTicks, AreRoundAndToldApart) {
    EXPECT_EQ(labels(0.0, 1.0), "0 0.25 0.5 0.75 1");
    EXPECT_EQ(labels(0.0, 0.3), "0 0.1 0.2 0.3");
    EXPECT_EQ(labels(-3.0, 3.0), "\u22123 \u22122 0 2 3");
    EXPECT_EQ(labels(101300.0, 101400.0), "101300 101320 101340 101360 101380 101400");
    EXPECT_EQ(labels(1.2e-7, 9.3e-7), "1.2e\u22127 2e\u22127 4e\u22127 6e\u22127 8e\u22127 9.3e\u22127");
    EXPECT_EQ(labels(0.0, 2.5e9), "0 5e8 1e9 1.5e9 2e9 2.5e9");
    EXPECT_EQ(labels(-0.013, 1.37), "\u22120.01 0.5 1 1.37");
    EXPECT_EQ(labels(2.0, 2.0), "2");
    for (double lower = -1e9; lower < 1e9; lower = lower * 0.37 + 12345.678) {
        for (const double extent : {1e-3, 1.0, 7e5, 3e12}) {
            const auto ticks = legend_ticks(lower, lower + extent);
            EXPECT_LE(ticks.size(), 9u);
            for (std::size_t i = 1; i < ticks.size(); ++i) EXPECT_NE(ticks[i].label, ticks[i - 1].label);
        }
        if (std::abs(lower) < 1e5) break;
    }
}

}  // namespace
}  // namespace curvewright
