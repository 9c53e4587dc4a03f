#pragma once

#include <optional>

#include "benchmarks/cases/warp_case.h"
#include "benchmarks/thesis/settings.h"

namespace curvewright::benchmarks {

/// Seconds of the phases of a warp.
struct PhaseTimes {
    double neighbours = 0.0;
    double affine_weights = 0.0, convex_weights = 0.0;
    std::optional<double> affine_solve, convex_solve;
};

struct WarpTimes {
    /// Alg. 2 (QR), Alg. 3 (Newton's method on the KKT system, dense up to 32 unknowns, else sparse) and SparseLU with
    /// COLAMD; weights without assembly.
    PhaseTimes literal;
    Index unconverged = 0;    ///< nodes at which Alg. 3 did not end with a residual of 1e-8
    double difference = 0.0;  ///< between SparseLU's and this program's result, over the size of the mesh
    /// This program's own weights, and its solution: all the rest of a warp.
    PhaseTimes own;
};

/// Which of the literal linear systems are solved.
enum class LiteralSolves { none, convex, both };

/// Both literal systems are solved at the same time.
WarpTimes measure_warp_times(const WarpCase& problem, const Settings& settings, LiteralSolves solves);

/// The same problem with the thesis's weights, in which all neighbours count alike, of one kind.
WarpCase as_published(const WarpCase& problem, Weighting weighting);

}  // namespace curvewright::benchmarks
