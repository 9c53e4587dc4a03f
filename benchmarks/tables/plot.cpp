#include "benchmarks/tables/plot.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "benchmarks/tables/table.h"

namespace curvewright::benchmarks {
namespace {

constexpr double picture_height = 480;
constexpr double left = 78, right = 700, top = 48, bottom = 420;

constexpr const char* style = R"(<style>
  .paper { fill: #ffffff } .frame { fill: none; stroke: #6b7280 } .grid { stroke: #e3e6ea } .guide { stroke: #9aa1ab }
  text { fill: #1f2328; font: 13px sans-serif } .title { font-size: 16px; font-weight: 600 } .small { font-size: 12px }
  .c0 { color: #1668b0 } .c1 { color: #b84a10 } .c2 { color: #2b7d3c } .c3 { color: #7c4aa8 }
  .line { fill: none; stroke: currentColor; stroke-width: 2 } .dashed { stroke-dasharray: 6 4 }
  .dot { fill: currentColor } .box { fill: none; stroke: currentColor; stroke-width: 2 }
  @media (prefers-color-scheme: dark) {
    .paper { fill: #14181d } .frame { stroke: #8b949e } .grid { stroke: #2b323a } .guide { stroke: #6b7480 }
    text { fill: #e6edf3 }
    .c0 { color: #6db7f5 } .c1 { color: #f59a5f } .c2 { color: #6fce83 } .c3 { color: #c9a0f0 }
  }
</style>
)";

struct Range {
    double low = std::numeric_limits<double>::infinity(), high = 0.0;
    bool is_linear = false;

    void include(double value) {
        low = std::min(low, value);
        high = std::max(high, value);
    }
    /// A little room at both ends.
    void widen() {
        low = is_linear ? 0.0 : low / 1.4;
        high *= is_linear ? 1.05 : 1.4;
    }
    double fraction(double value) const {
        return is_linear ? (value - low) / (high - low) : std::log(value / low) / std::log(high / low);
    }
};

std::string power_of_ten(int exponent) {
    if (exponent >= -4 && exponent < 0) return fmt::format("{:.{}f}", std::pow(10.0, exponent), -exponent);
    if (exponent >= 0 && exponent <= 6) return Cell(static_cast<long>(std::lround(std::pow(10.0, exponent)))).shown;
    return fmt::format("10<tspan dy=\"-5\" font-size=\"10\">{}</tspan>", exponent);
}

std::string escaped(const std::string& text) {
    std::string result;
    for (const char c : text) {
        if (c == '&')
            result += "&amp;";
        else if (c == '<')
            result += "&lt;";
        else
            result += c;
    }
    return result;
}

std::string marker(const Series& series, double x, double y) {
    if (series.is_reference)
        return fmt::format("<rect class=\"box c{}\" x=\"{:.1f}\" y=\"{:.1f}\" width=\"8\" height=\"8\"/>\n",
                           series.color, x - 4, y - 4);
    return fmt::format("<circle class=\"dot c{}\" cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"4\"/>\n", series.color, x, y);
}

}  // namespace

std::string as_svg(const Plot& plot) {
    // Many curves have their legend beside the plot instead of in its upper left corner.
    const bool is_legend_beside = plot.series.size() > 4;
    const double picture_width = is_legend_beside ? 1060 : 720;
    const double legend_left = is_legend_beside ? right : left;
    Range x_range, y_range;
    x_range.is_linear = plot.has_linear_x;
    const auto is_shown = [&](double x, double y) { return (x > 0.0 || (plot.has_linear_x && x == 0.0)) && y > 0.0; };
    for (const Series& series : plot.series)
        for (const auto& [x, y] : series.points)
            if (is_shown(x, y)) {
                x_range.include(x);
                y_range.include(y);
            }
    if (!(x_range.high > 0.0)) return {};
    x_range.widen();
    y_range.widen();
    const auto place_x = [&](double x) { return left + (right - left) * x_range.fraction(x); };
    const auto place_y = [&](double y) { return bottom - (bottom - top) * y_range.fraction(y); };

    std::string svg = fmt::format(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0} {1}\" width=\"{0}\" height=\"{1}\" role=\"img\" "
        "aria-label=\"{2}\">\n{3}<rect class=\"paper\" width=\"{0}\" height=\"{1}\"/>\n"
        "<text class=\"title\" x=\"{4}\" y=\"28\">{2}</text>\n",
        picture_width, picture_height, escaped(plot.title), style, left);
    // Grid: decades, and their multiples without a label.
    const auto for_decades = [](const Range& range, const auto& call) {
        if (range.is_linear) return;
        for (int e = static_cast<int>(std::floor(std::log10(range.low))); std::pow(10.0, e) < range.high; ++e)
            for (int k = 1; k < 10; ++k) {
                const double value = k * std::pow(10.0, e);
                if (value >= range.low && value <= range.high) call(value, k == 1, e);
            }
    };
    for_decades(x_range, [&](double value, bool is_power, int exponent) {
        const double x = place_x(value);
        svg += fmt::format("<line class=\"grid\" x1=\"{0:.1f}\" x2=\"{0:.1f}\" y1=\"{1}\" y2=\"{2}\"/>\n", x, top,
                           is_power ? bottom + 5 : bottom);
        if (is_power)
            svg += fmt::format("<text x=\"{:.1f}\" y=\"{}\" text-anchor=\"middle\">{}</text>\n", x, bottom + 21,
                               power_of_ten(exponent));
    });
    if (x_range.is_linear) {
        const double step = std::pow(10.0, std::floor(std::log10(x_range.high / 4.0)));
        const double distance = step * (x_range.high / step > 20.0 ? 5.0 : x_range.high / step > 8.0 ? 2.0 : 1.0);
        for (double value = 0.0; value < x_range.high; value += distance)
            svg += fmt::format(
                "<line class=\"grid\" x1=\"{0:.1f}\" x2=\"{0:.1f}\" y1=\"{1}\" y2=\"{2}\"/>\n<text x=\"{0:.1f}\" "
                "y=\"{3}\" text-anchor=\"middle\">{4:g}</text>\n",
                place_x(value), top, bottom + 5, bottom + 21, value);
    }
    for_decades(y_range, [&](double value, bool is_power, int exponent) {
        const double y = place_y(value);
        svg += fmt::format("<line class=\"grid\" x1=\"{1}\" x2=\"{2}\" y1=\"{0:.1f}\" y2=\"{0:.1f}\"/>\n", y,
                           is_power ? left - 5 : left, right);
        if (is_power)
            svg += fmt::format("<text x=\"{}\" y=\"{:.1f}\" text-anchor=\"end\">{}</text>\n", left - 9, y + 4,
                               power_of_ten(exponent));
    });
    svg += fmt::format("<rect class=\"frame\" x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\"/>\n", left, top,
                       right - left, bottom - top);
    svg += fmt::format("<text x=\"{}\" y=\"{}\" text-anchor=\"middle\">{}</text>\n", (left + right) / 2, bottom + 46,
                       escaped(plot.x_label));
    svg += fmt::format("<text transform=\"translate(22 {}) rotate(-90)\" text-anchor=\"middle\">{}</text>\n",
                       (top + bottom) / 2, escaped(plot.y_label));

    // Proportional growth, through the last point of the first series.
    const bool has_guide = !plot.has_linear_x && !plot.series.front().points.empty();
    if (has_guide) {
        const auto [x, y] = plot.series.front().points.back();
        const double from = std::max(x_range.low, x * y_range.low / y),
                     to = std::min(x_range.high, x * y_range.high / y);
        svg += fmt::format(
            "<line class=\"guide\" stroke-dasharray=\"2 4\" x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" "
            "y2=\"{:.1f}\"/>\n",
            place_x(from), place_y(y * from / x), place_x(to), place_y(y * to / x));
    }
    double legend = top + 22;
    for (const Series& series : plot.series) {
        if (series.points.empty()) continue;
        const char* dashed = series.is_reference ? " dashed" : "";
        std::string points;
        for (const auto& [x, y] : series.points)
            if (is_shown(x, y)) points += fmt::format("{:.1f},{:.1f} ", place_x(x), place_y(y));
        svg += fmt::format("<polyline class=\"line c{}{}\" points=\"{}\"/>\n", series.color, dashed, points);
        for (const auto& [x, y] : series.points)
            if (is_shown(x, y)) svg += marker(series, place_x(x), place_y(y));
        svg += fmt::format("<line class=\"line c{0}{1}\" x1=\"{2}\" x2=\"{3}\" y1=\"{4}\" y2=\"{4}\"/>\n", series.color,
                           dashed, legend_left + 14, legend_left + 50, legend);
        svg += marker(series, legend_left + 32, legend);
        svg += fmt::format("<text x=\"{}\" y=\"{}\">{}</text>\n", legend_left + 60, legend + 4, escaped(series.name));
        legend += 20;
    }
    if (has_guide)
        svg += fmt::format(
            "<line class=\"guide\" stroke-dasharray=\"2 4\" x1=\"{0}\" x2=\"{1}\" y1=\"{2}\" y2=\"{2}\"/>\n"
            "<text class=\"small\" x=\"{3}\" y=\"{4}\">slope 1: proportional to the number of nodes</text>\n",
            legend_left + 14, legend_left + 50, legend, legend_left + 60, legend + 4);
    return svg + "</svg>\n";
}

}  // namespace curvewright::benchmarks
