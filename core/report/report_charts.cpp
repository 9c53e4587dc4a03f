#include "core/report/report_charts.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

#include <fmt/format.h>

#include "core/report/report_markup.h"

namespace curvewright {
namespace {

constexpr double histogram_width = 440, histogram_height = 190;
constexpr const char* axis_style = "stroke='#9aa0a6' stroke-width='1'";
constexpr const char* grid_style = "stroke='#e3e5e8' stroke-width='1'";

std::string text_svg(double x, double y, const char* anchor, const std::string& text) {
    return fmt::format("<text x='{:.1f}' y='{:.1f}' text-anchor='{}'>{}</text>", x, y, anchor, escaped(text));
}

std::string hatch_pattern(const ReportColors& colors) {
    return fmt::format(
        "<defs><pattern id='hatch' width='5' height='5' patternUnits='userSpaceOnUse' patternTransform='rotate(45)'>"
        "<rect width='5' height='5' fill='{}'/><rect width='1.6' height='5' fill='#ffffff'/></pattern></defs>",
        colors.tangled);
}

/// "min −0.2220, mean 0.6340; 2 of 30 tangled".
std::string summary_text(const QualitySummary& summary) {
    std::string text = fmt::format("min {}, mean {}; ", number_text(summary.min), number_text(summary.mean));
    const std::string total = count_text(summary.elements());
    if (summary.invalid > 0)
        text += fmt::format("{} of {} tangled", count_text(summary.invalid), total);
    else
        text += summary.undecided > 0 ? total + " elements" : fmt::format("all {} valid", total);
    if (summary.undecided > 0) text += fmt::format(", {} undecided", count_text(summary.undecided));
    return text;
}

/// The range of an axis and the numbers written at it.
struct Axis {
    double low = 0.0, high = 1.0;
    std::vector<double> ticks;
    double position(double value) const { return (value - low) / (high - low); }
};

Axis linear_axis(double low, double high, bool is_whole) {
    if (!(high > low)) high = low + (is_whole ? 1.0 : std::max(1e-12, 0.1 * std::abs(low)));
    const double rough = (high - low) / 4.0, decade = std::pow(10.0, std::floor(std::log10(rough)));
    double step = decade;
    for (const double factor : {1.0, 2.0, 5.0, 10.0}) {
        step = factor * decade;
        if (step >= rough) break;
    }
    if (is_whole) step = std::max(1.0, std::round(step));
    Axis axis{std::floor(low / step) * step, std::ceil(high / step) * step, {}};
    const auto steps = static_cast<int>(std::lround((axis.high - axis.low) / step));
    for (int i = 0; i <= steps; ++i) {
        const double tick = axis.low + i * step;
        axis.ticks.push_back(std::abs(tick) < 1e-9 * step ? 0.0 : tick);
    }
    return axis;
}

/// Of decimal logarithms.
Axis logarithmic_axis(double low, double high) {
    Axis axis{std::floor(low), std::ceil(high), {}};
    if (axis.high <= axis.low) axis.high = axis.low + 1.0;
    const double step = std::ceil((axis.high - axis.low) / 5.0);
    for (double tick = axis.low; tick <= axis.high; tick += step) axis.ticks.push_back(tick);
    return axis;
}

}  // namespace

std::string hatch_svg(const ReportColors& colors) {
    return "<svg width='0' height='0' style='position:absolute' aria-hidden='true'>" + hatch_pattern(colors) + "</svg>";
}

std::string histogram_svg(const ReportHistogram& histogram, Index highest, const ReportColors& colors,
                          const std::string& title) {
    constexpr double width = histogram_width, height = histogram_height, left = 48, right = 8, top = 12, bottom = 32,
                     gap = 26;
    constexpr double bar = (width - left - right - gap) / (ReportHistogram::bins + 2), base = height - bottom;
    const auto height_of = [&](Index count) {
        if (count == 0) return 0.0;
        return (base - top) * std::log1p(static_cast<double>(count)) / std::log1p(static_cast<double>(highest));
    };
    std::string svg = fmt::format("<svg class='chart' viewBox='0 0 {} {}' role='img' aria-label='{}'>", width, height,
                                  escaped(title));
    for (Index tick = 1; tick <= highest && tick <= 100000000; tick *= 10) {
        const double y = base - height_of(tick);
        svg += fmt::format("<line x1='{}' x2='{}' y1='{:.1f}' y2='{:.1f}' {}/>", left, width - right, y, y, grid_style);
        svg += text_svg(left - 5, y + 3.5, "end", count_text(tick));
    }
    const auto rect = [&](double x, double from, Index count, double w, const std::string& fill) {
        const double h = height_of(count);
        if (h > 0.0)
            svg += fmt::format("<rect x='{:.2f}' y='{:.2f}' width='{:.2f}' height='{:.2f}' fill='{}'/>", x,
                               base - from - h, w, h, fill);
    };
    rect(left, 0.0, histogram.tangled, 2.0 * bar - 1.0, "url(#hatch)");
    if (histogram.tangled > 0)
        svg += fmt::format("<text x='{:.1f}' y='{:.1f}' text-anchor='middle' class='strong'>{}</text>", left + bar,
                           base - height_of(histogram.tangled) - 4, count_text(histogram.tangled));
    for (std::size_t i = 0; i < histogram.valid.size(); ++i) {
        const double x = left + gap + bar * (2.0 + static_cast<double>(i));
        const Index both = histogram.valid[i] + histogram.undecided[i];
        // The whole bar first: the logarithm of a sum is no sum.
        if (histogram.undecided[i] > 0) rect(x, 0.0, both, bar - 1.0, colors.undecided);
        rect(x, 0.0, histogram.valid[i], bar - 1.0, colors.of((static_cast<double>(i) + 0.5) / ReportHistogram::bins));
    }
    svg += fmt::format("<line x1='{}' x2='{}' y1='{}' y2='{}' {}/>", left, width - right, base, base, axis_style);
    svg += text_svg(left + bar, base + 14, "middle", "tangled");
    const double begin = left + gap + 2.0 * bar;
    for (const double tick : {0.0, 0.2, 0.4, 0.6, 0.8, 1.0})
        svg += text_svg(begin + tick * bar * ReportHistogram::bins, base + 14, tick == 1.0 ? "end" : "middle",
                        fmt::format("{:.1f}", tick));
    svg += text_svg(begin + 0.5 * bar * ReportHistogram::bins, height - 4, "middle", "scaled Jacobian");
    return svg + "</svg>";
}

std::string histograms_document(const std::vector<HistogramPanel>& panels, const ReportColors& colors) {
    constexpr double margin = 12, gap = 24, head = 40;
    const std::size_t columns = std::min<std::size_t>(2, panels.size()), rows = (panels.size() + 1) / 2;
    const double width = 2 * margin + static_cast<double>(columns) * (histogram_width + gap) - gap;
    const double height = 2 * margin + static_cast<double>(rows) * (head + histogram_height + gap) - gap;
    Index highest = 1;
    for (const HistogramPanel& panel : panels) highest = std::max(highest, panel.histogram.highest());
    std::string svg = fmt::format(
        "<svg xmlns='http://www.w3.org/2000/svg' width='{0}' height='{1}' viewBox='0 0 {0} {1}'>\n"
        "<style>text {{ font: 11px system-ui, \"Segoe UI\", \"Noto Sans\", \"DejaVu Sans\", sans-serif; fill: #565d66; "
        "}} "
        ".strong {{ font-weight: 600; fill: #1d2125; }} .title {{ font-size: 14px; }}</style>\n"
        "{2}<rect width='{0}' height='{1}' fill='#ffffff'/>\n",
        width, height, hatch_pattern(colors));
    for (std::size_t i = 0; i < panels.size(); ++i) {
        const HistogramPanel& panel = panels[i];
        const double x = margin + static_cast<double>(i % 2) * (histogram_width + gap);
        const double y = margin + static_cast<double>(i / 2) * (head + histogram_height + gap);
        svg += fmt::format("<text x='{}' y='{}' class='strong title'>{}</text>", x, y + 13, escaped(panel.title));
        svg += fmt::format("<text x='{}' y='{}'>{}</text>\n", x, y + 30, escaped(summary_text(panel.summary)));
        svg += fmt::format("<svg x='{}' y='{}' width='{}' height='{}'>{}</svg>\n", x, y + head, histogram_width,
                           histogram_height, histogram_svg(panel.histogram, highest, colors, panel.title));
    }
    return svg + "</svg>\n";
}

std::string chart_svg(const Chart& chart) {
    constexpr double height = 220, left = 56, right = 10, top = 24, bottom = 34;
    const double width = chart.width;
    std::vector<ChartLine> lines = chart.lines;
    double x_low = std::numeric_limits<double>::infinity(), x_high = -x_low, low = x_low, high = -x_low;
    for (ChartLine& line : lines) {
        std::erase_if(line.points, [&](const auto& point) {
            return !std::isfinite(point.second) || (chart.is_logarithmic && point.second <= 0.0);
        });
        for (auto& [x, y] : line.points) {
            if (chart.is_logarithmic) y = std::log10(y);
            x_low = std::min(x_low, x), x_high = std::max(x_high, x);
            low = std::min(low, y), high = std::max(high, y);
        }
    }
    if (x_low > x_high) return {};
    if (chart.is_count) low = 0.0;
    if (chart.has_zero) low = std::min(low, 0.0), high = std::max(high, 0.0);
    const Axis x_axis = linear_axis(x_low, x_high, true);
    const Axis y_axis = chart.is_logarithmic ? logarithmic_axis(low, high) : linear_axis(low, high, chart.is_count);
    // Not beyond the last step that there is.
    const double span = std::max(1.0, x_high - x_low);
    const auto x_of = [&](double x) { return left + (width - left - right) * (x - x_low) / span; };
    const auto y_of = [&](double y) { return height - bottom - (height - top - bottom) * y_axis.position(y); };

    std::string svg = fmt::format("<svg class='chart' viewBox='0 0 {} {}' role='img' aria-label='{}'>", width, height,
                                  escaped(chart.title));
    svg += fmt::format("<text x='{}' y='12' class='strong'>{}</text>", left, escaped(chart.title));
    for (const double tick : y_axis.ticks) {
        svg += fmt::format("<line x1='{}' x2='{}' y1='{:.1f}' y2='{:.1f}' {}/>", left, width - right, y_of(tick),
                           y_of(tick), grid_style);
        svg += text_svg(left - 6, y_of(tick) + 3.5, "end",
                        short_number_text(chart.is_logarithmic ? std::pow(10.0, tick) : tick));
    }
    for (const double tick : x_axis.ticks)
        if (tick >= x_low && tick <= x_low + span)
            svg += text_svg(x_of(tick), height - bottom + 14, "middle", short_number_text(tick));
    svg += fmt::format("<line x1='{}' x2='{}' y1='{}' y2='{}' {}/>", left, width - right, height - bottom,
                       height - bottom, axis_style);
    if (chart.has_zero && y_axis.low < 0.0)
        svg += fmt::format(
            "<line x1='{}' x2='{}' y1='{:.1f}' y2='{:.1f}' stroke='#4a4f55' stroke-width='1.2' "
            "stroke-dasharray='4 3'/>",
            left, width - right, y_of(0.0), y_of(0.0));
    svg += text_svg((left + width - right) / 2, height - 4, "middle", chart.x_label);
    std::stable_partition(lines.begin(), lines.end(), [](const ChartLine& line) { return !line.is_accent; });
    for (const ChartLine& line : lines) {
        const char* color = line.is_accent ? "#1c62c4" : "#a9afb7";
        std::string points;
        for (const auto& [x, y] : line.points) points += fmt::format("{:.1f},{:.1f} ", x_of(x), y_of(y));
        if (line.points.size() > 1)
            svg += fmt::format("<polyline points='{}' fill='none' stroke='{}' stroke-width='{}'/>", points, color,
                               line.is_accent ? 2.0 : 1.0);
        if (line.points.size() == 1 || (line.is_accent && line.points.size() <= 60))
            for (const auto& [x, y] : line.points)
                svg += fmt::format("<circle cx='{:.1f}' cy='{:.1f}' r='{}' fill='{}'/>", x_of(x), y_of(y),
                                   line.is_accent ? 2.8 : 1.8, color);
    }
    return svg + "</svg>";
}

}  // namespace curvewright
