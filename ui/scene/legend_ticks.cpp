#include "ui/scene/legend_ticks.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace curvewright {
namespace {

/// With a true minus sign and without what says nothing: "2.50" is "2.5", "1e-05" is "1e−5".
std::string tidy(std::string text) {
    const std::size_t exponent = text.find('e');
    std::string mantissa = text.substr(0, exponent), power = exponent == text.npos ? "" : text.substr(exponent + 1);
    if (mantissa.find('.') != mantissa.npos) {
        while (mantissa.back() == '0') mantissa.pop_back();
        if (mantissa.back() == '.') mantissa.pop_back();
    }
    if (mantissa == "-0") mantissa = "0";
    if (!power.empty() && mantissa != "0") {
        const bool is_negative = power.front() == '-';
        const std::size_t first = power.find_first_not_of("+-0");
        if (first != power.npos) mantissa += (is_negative ? "e-" : "e") + power.substr(first);
    }
    std::string result;
    for (const char c : mantissa) result += c == '-' ? std::string("\u2212") : std::string(1, c);
    return result;
}

/// A number whose neighbours are about `step` away.
std::string label(double value, double step) {
    const double size = std::abs(value);
    const int step_power = static_cast<int>(std::floor(std::log10(step) + 1e-9));
    if (size < 1e6 && step_power >= -4) return tidy(fmt::format("{:.{}f}", value, std::max(0, -step_power)));
    const int power = size > 0.0 ? static_cast<int>(std::floor(std::log10(size))) : step_power;
    return tidy(fmt::format("{:.{}e}", value, std::clamp(power - step_power, 0, 15)));
}

}  // namespace

std::vector<Tick> legend_ticks(double lower, double upper) {
    if (lower == 0.0 && upper == 1.0) return {{0.0, "0"}, {0.25, "0.25"}, {0.5, "0.5"}, {0.75, "0.75"}, {1.0, "1"}};
    const double extent = upper - lower;
    if (!(extent > 0.0) || !std::isfinite(extent)) return {{lower, tidy(fmt::format("{:.4g}", lower))}};
    const double rough = extent / 5.0, decade = std::pow(10.0, std::floor(std::log10(rough)));
    const double step = rough <= decade         ? decade
                        : rough <= 2.0 * decade ? 2.0 * decade
                        : rough <= 5.0 * decade ? 5.0 * decade
                                                : 10.0 * decade;
    std::vector<Tick> ticks = {{lower, label(lower, step / 10.0)}};
    // Not where the numbers at the ends stand.
    constexpr double near_end = 0.06;
    for (double k = std::ceil(lower / step); k * step < upper; k += 1.0)
        if (k * step > lower + near_end * extent && k * step < upper - near_end * extent)
            ticks.push_back({k * step, label(k * step, step)});
    ticks.push_back({upper, label(upper, step / 10.0)});
    return ticks;
}

}  // namespace curvewright
