#pragma once

#include "benchmarks/tables/measure.h"
#include "benchmarks/warp_tables/cases.h"

namespace curvewright::benchmarks {

/// Most memory that this process has used so far, in MB.
double peak_memory_mb();

}  // namespace curvewright::benchmarks
