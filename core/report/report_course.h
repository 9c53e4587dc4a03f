#pragma once

#include <string>

#include "core/report/run_report.h"

namespace curvewright {

/// The part of the page that tells how the run went: passes, and patches and rounds of the guaranteed method.
std::string course_section(const RunReport& report);

}  // namespace curvewright
