#pragma once

#include "benchmarks/tables/measure.h"
#include "benchmarks/warp_tables/cases.h"

namespace curvewright::benchmarks {

/// A whole warp.
struct TimedWarp {
    double seconds = 0.0;  ///< wall clock of the call, everything included
    WarpResult result;
    double equations_seconds() const { return result.report.neighbours_seconds + result.report.weights_seconds; }
    /// Numbering, condensation, preconditioner, solve and back to the mesh.
    double remaining_seconds() const { return seconds - equations_seconds(); }
    double microseconds_per_node() const { return 1e6 * seconds / result.report.interior_nodes; }
};
TimedWarp timed_warp(const Case& problem);

/// Most memory that this process has used so far, in MB.
double peak_memory_mb();

}  // namespace curvewright::benchmarks
