#pragma once

#include "benchmarks/tables/report.h"
#include "benchmarks/warp_tables/settings.h"

namespace curvewright::benchmarks {

/// A million nodes, in a process of its own so that its peak of memory is its own. To be called before any thread is
/// started.
void measure_million(const Settings& settings, Report& report);
/// Convex weights against Algorithm 3.
void measure_weights(const Settings& settings, Report& report);
/// A family, both orders, all levels. dimension: 2 = circle, 3 = sphere.
void measure_scaling(const Settings& settings, int dimension, Report& report);
/// The moving sphere by all weightings.
void measure_moving_sphere(const Settings& settings, Report& report);
/// Frames of a drag.
void measure_responses(const Settings& settings, Report& report);

}  // namespace curvewright::benchmarks
