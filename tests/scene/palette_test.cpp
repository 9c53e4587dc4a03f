#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "tests/scene/color_sight.h"
#include "ui/palette/cielab.h"
#include "ui/palette/quality_colors.h"

namespace curvewright {
namespace {

TEST(Palette, LabOfKnownColours) {
    const Lab white = to_lab({1, 1, 1}), red = to_lab({1, 0, 0});
    EXPECT_NEAR(white[0], 100.0, 0.01);
    EXPECT_NEAR(white[1], 0.0, 0.02);
    EXPECT_NEAR(white[2], 0.0, 0.02);
    EXPECT_NEAR(red[0], 53.24, 0.01);
    EXPECT_NEAR(red[1], 80.09, 0.02);
    EXPECT_NEAR(red[2], 67.20, 0.02);
    const Color back = to_srgb(to_lab({0.2, 0.5, 0.7}));
    EXPECT_NEAR(back[0], 0.2, 1e-4);
    EXPECT_NEAR(back[1], 0.5, 1e-4);
    EXPECT_NEAR(back[2], 0.7, 1e-4);
}

TEST(Palette, LightnessRisesWithQualityForEverySight) {
    for (const auto sight : {as_is, as_deuteranope, as_protanope}) {
        double last = to_lab(sight(quality_map(0.0)))[0];
        for (int i = 1; i <= 100; ++i) {
            const double lightness = to_lab(sight(quality_map(i / 100.0)))[0];
            EXPECT_GT(lightness, last) << i;
            last = lightness;
        }
    }
}

TEST(Palette, StepsAreEven) {
    double smallest = 1e9, largest = 0.0;
    for (int i = 0; i < 50; ++i) {
        const double step = color_difference(to_lab(quality_map(i / 50.0)), to_lab(quality_map((i + 1) / 50.0)));
        smallest = std::min(smallest, step);
        largest = std::max(largest, step);
    }
    EXPECT_GT(smallest, 1.0);
    EXPECT_LT(largest / smallest, 1.25);
}

TEST(Palette, ControlColoursAreInsideTheGamut) {
    // Clamping would bend the map: going to Lab and back must not change it.
    for (int i = 0; i <= 100; ++i) {
        const Color color = quality_map(i / 100.0);
        for (double channel : color) {
            EXPECT_GT(channel, 0.0);
            EXPECT_LT(channel, 1.0);
        }
    }
}

TEST(Palette, AlarmAndUndecidedStandOutFromTheMap) {
    for (const auto sight : {as_is, as_deuteranope, as_protanope}) {
        const Lab alarm = to_lab(sight(tangled_color())), undecided = to_lab(sight(undecided_color()));
        for (int i = 0; i <= 100; ++i) {
            const Lab on_map = to_lab(sight(quality_map(i / 100.0)));
            EXPECT_GT(color_difference(alarm, on_map), 25.0) << i;
            EXPECT_GT(color_difference(undecided, on_map), 25.0) << i;
        }
        EXPECT_GT(color_difference(alarm, undecided), 12.0);
    }
}

TEST(Palette, ValidityDecidesBeforeTheValue) {
    EXPECT_EQ(quality_color(0.7, Validity::valid), quality_map(0.7));
    EXPECT_EQ(quality_color(0.7, Validity::invalid), tangled_color());
    EXPECT_EQ(quality_color(-0.1, Validity::valid), tangled_color());
    EXPECT_EQ(quality_color(0.0, Validity::undecided), undecided_color());
    // Whatever the map and the range are.
    const ColorScale scale{ColorMap::grey, true, 0.25, 0.75};
    EXPECT_EQ(quality_color(0.5, Validity::valid, scale), map_color(ColorMap::grey, 0.5));
    EXPECT_EQ(quality_color(0.9, Validity::valid, scale), map_color(ColorMap::grey, 0.0));
    EXPECT_EQ(quality_color(0.3, Validity::invalid, scale), tangled_color());
    EXPECT_EQ(quality_color(-0.1, Validity::valid, scale), tangled_color());
    EXPECT_EQ(quality_color(0.3, Validity::undecided, scale), undecided_color());
    EXPECT_EQ(quality_map(-3.0), quality_map(0.0));
    EXPECT_EQ(quality_map(3.0), quality_map(1.0));
    const Color none = quality_map(std::numeric_limits<double>::quiet_NaN());
    EXPECT_EQ(none[0], none[1]);
    EXPECT_EQ(none[1], none[2]);
}

}  // namespace
}  // namespace curvewright
