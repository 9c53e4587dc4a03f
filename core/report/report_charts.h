#pragma once

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "core/report/run_report.h"

namespace curvewright {

/// Colours of a report as CSS has them ("#d6006c"): those of the window.
struct ReportColors {
    std::function<std::string(double scaled_jacobian)> of;  ///< of valid elements
    std::string tangled, undecided;
};

/// What a page needs once for its histograms: the hatching of the tangled elements.
std::string hatch_svg(const ReportColors& colors);
/// Bars of the scaled Jacobian, counts drawn logarithmically up to `highest`.
std::string histogram_svg(const ReportHistogram& histogram, Index highest, const ReportColors& colors,
                          const std::string& title);

/// A histogram among others, and what stands above and below it.
struct HistogramPanel {
    std::string title;
    QualitySummary summary;
    ReportHistogram histogram;
};
/// A picture that needs nothing else, as the text of an SVG file: histograms two in a row, all on one scale, each with
/// its title and its numbers.
std::string histograms_document(const std::vector<HistogramPanel>& panels, const ReportColors& colors);

/// A polyline of a chart.
struct ChartLine {
    std::vector<std::pair<double, double>> points;  ///< x ascending
    bool is_accent = false;                         ///< drawn last, and strongly
};
/// Lines over a common axis.
struct Chart {
    std::string title, x_label;
    std::vector<ChartLine> lines;
    bool is_logarithmic = false;  ///< y; what is not positive is left out
    bool is_count = false;        ///< y: whole numbers, from 0 on
    bool has_zero = false;        ///< 0 is marked, as the limit between tangled and valid
    double width = 440.0;         ///< of the picture; its height is half of 440
};
/// "" if there is nothing to draw.
std::string chart_svg(const Chart& chart);

}  // namespace curvewright
