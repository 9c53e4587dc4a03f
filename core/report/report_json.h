#pragma once

#include <string>

#include "core/report/report_pictures.h"

namespace curvewright {

/// The report for programs: one JSON object with all digits of its numbers. What differs between two runs of the same
/// is in its member "run" alone.
std::string to_json(const RunReport& report, const ReportPictures& pictures);

}  // namespace curvewright
