#include "benchmarks/warp_tables/measure.h"

#include <sys/resource.h>

namespace curvewright::benchmarks {

double peak_memory_mb() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return static_cast<double>(usage.ru_maxrss) / 1024.0;
}

}  // namespace curvewright::benchmarks
