#pragma once

#include "benchmarks/cases/untangle_case.h"
#include "benchmarks/tables/measure.h"
#include "core/base/stopwatch.h"
#include "core/untangle/guaranteed.h"

namespace curvewright::benchmarks {

/// A result and the wall clock of the whole call.
template <class Result>
struct Timed {
    double seconds = 0.0;
    Result result;
};

template <class Run>
auto timed(const Run& run) {
    const Stopwatch watch;
    Timed<decltype(run())> timed;
    timed.result = run();
    timed.seconds = watch.seconds();
    return timed;
}

/// The guaranteed method with one default setting. improves = false: stops when every element is certified.
inline Timed<GuaranteedResult> timed_guaranteed(const UntangleCase& problem, bool improves,
                                                BoundaryMode boundary = BoundaryMode::fixed) {
    GuaranteedOptions options;
    options.improves = improves;
    options.boundary.otherwise = boundary;
    return timed([&] { return untangle_guaranteed(problem.mesh, options); });
}

}  // namespace curvewright::benchmarks
