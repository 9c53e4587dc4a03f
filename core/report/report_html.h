#pragma once

#include <string>

#include "core/report/report_charts.h"
#include "core/report/report_pictures.h"

namespace curvewright {

/// The report for people: one page of XHTML that needs nothing else, for the screen and for A4. What differs between
/// two runs of the same is in its section "run" alone.
std::string to_html(const RunReport& report, const ReportPictures& pictures, const ReportColors& colors);

}  // namespace curvewright
