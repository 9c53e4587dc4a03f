#include "benchmarks/tables/measure.h"

#include <cstdio>

#include <fmt/format.h>

namespace curvewright::benchmarks {

void tell(const std::string& line) {
    fmt::print(stderr, "{}\n", line);
    std::fflush(stderr);
}

}  // namespace curvewright::benchmarks
