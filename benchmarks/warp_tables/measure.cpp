#include "benchmarks/warp_tables/measure.h"

#include <sys/resource.h>

#include "core/base/stopwatch.h"

namespace curvewright::benchmarks {

TimedWarp timed_warp(const Case& problem) {
    const Stopwatch watch;
    TimedWarp timed;
    timed.result = warp(problem.mesh, problem.boundary_positions, problem.options);
    timed.seconds = watch.seconds();
    return timed;
}

double peak_memory_mb() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return static_cast<double>(usage.ru_maxrss) / 1024.0;
}

}  // namespace curvewright::benchmarks
