#pragma once

#include <string>
#include <utility>

#include "benchmarks/warp_tables/cases.h"

namespace curvewright::benchmarks {

/// Calls run, which returns something with a member `seconds`, several times and returns the quickest: once if it takes
/// more than ten seconds, otherwise 3 to 20 times until three seconds are spent.
template <class Run>
auto best_of(const Run& run) {
    auto best = run();
    double spent = best.seconds;
    for (int i = 1; (i < 3 && spent < 10.0) || (i < 20 && spent < 3.0); ++i) {
        auto next = run();
        spent += next.seconds;
        if (next.seconds < best.seconds) best = std::move(next);
    }
    return best;
}

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

/// A line on standard error.
void tell(const std::string& line);

}  // namespace curvewright::benchmarks
