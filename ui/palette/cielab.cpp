#include "ui/palette/cielab.h"

#include <algorithm>
#include <cmath>

namespace curvewright {
namespace {

constexpr std::array<double, 3> white{0.95047, 1.0, 1.08883};
constexpr double delta = 6.0 / 29.0;

double compress(double t) {
    return t > delta * delta * delta ? std::cbrt(t) : t / (3.0 * delta * delta) + 4.0 / 29.0;
}

double expand(double t) {
    return t > delta ? t * t * t : 3.0 * delta * delta * (t - 4.0 / 29.0);
}

}  // namespace

double to_linear(double channel) {
    return channel <= 0.04045 ? channel / 12.92 : std::pow((channel + 0.055) / 1.055, 2.4);
}

double from_linear(double channel) {
    const double c = std::clamp(channel, 0.0, 1.0);
    return c <= 0.0031308 ? 12.92 * c : 1.055 * std::pow(c, 1.0 / 2.4) - 0.055;
}

// Matrices of IEC 61966-2-1 (sRGB), D65.
Lab to_lab(const Color& srgb) {
    const double r = to_linear(srgb[0]), g = to_linear(srgb[1]), b = to_linear(srgb[2]);
    const double x = compress((0.4124564 * r + 0.3575761 * g + 0.1804375 * b) / white[0]);
    const double y = compress((0.2126729 * r + 0.7151522 * g + 0.0721750 * b) / white[1]);
    const double z = compress((0.0193339 * r + 0.1191920 * g + 0.9503041 * b) / white[2]);
    return {116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)};
}

Color to_srgb(const Lab& lab) {
    const double level = (lab[0] + 16.0) / 116.0;
    const double x = white[0] * expand(level + lab[1] / 500.0);
    const double y = white[1] * expand(level);
    const double z = white[2] * expand(level - lab[2] / 200.0);
    return {from_linear(3.2404542 * x - 1.5371385 * y - 0.4985314 * z),
            from_linear(-0.9692660 * x + 1.8760108 * y + 0.0415560 * z),
            from_linear(0.0556434 * x - 0.2040259 * y + 1.0572252 * z)};
}

double color_difference(const Lab& a, const Lab& b) {
    return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

}  // namespace curvewright
