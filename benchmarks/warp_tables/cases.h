#pragma once

#include "benchmarks/cases/warp_case.h"
#include "benchmarks/warp_tables/settings.h"

namespace curvewright::benchmarks {

inline WarpCase family_case(const Settings& settings, int dimension, int level, int order) {
    return family_case(settings.families, dimension, level, order);
}

/// The sample moving_sphere (quick: moving_sphere_small) with its deformation.
inline WarpCase moving_sphere_case(const Settings& settings) {
    return sample_warp_case(settings.samples, settings.is_quick ? "moving_sphere_small" : "moving_sphere");
}

}  // namespace curvewright::benchmarks
