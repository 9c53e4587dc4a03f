#pragma once

#include "benchmarks/cases/untangle_case.h"
#include "benchmarks/tables/measure.h"
#include "core/base/stopwatch.h"
#include "core/untangle/guaranteed.h"
#include "core/untangle/improve.h"

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

/// The guaranteed method with one default setting. improves = false: stops when every element is certified. A mesh
/// that is valid at the start, which the method does not change, is improved by improve().
inline Timed<GuaranteedResult> timed_guaranteed(const UntangleCase& problem, bool improves,
                                                BoundaryMode boundary = BoundaryMode::fixed) {
    GuaranteedOptions options;
    options.improves = improves;
    options.boundary.otherwise = boundary;
    return timed([&] {
        GuaranteedResult result = untangle_guaranteed(problem.mesh, options);
        if (!improves || !result.unmended.empty() || result.coordinates != problem.mesh.coordinates()) return result;
        ImproveOptions improving;
        improving.boundary = options.boundary;
        result.coordinates = improve(problem.mesh, improving).coordinates;
        return result;
    });
}

}  // namespace curvewright::benchmarks
