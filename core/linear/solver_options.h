#pragma once

#include <string>

namespace curvewright {

/// Which solver is taken; automatic: the iterative one, and the direct one for few unknowns and where that fails.
enum class SolverChoice { automatic, direct, iterative };
/// "auto", "direct", "iterative".
const char* to_string(SolverChoice solver);

/// Order of elimination of a direct factorisation.
enum class Ordering {
    nested_dissection,  ///< METIS (Karypis, Kumar 1998): least fill on large meshes
    minimum_degree,     ///< COLAMD for general, AMD for symmetric matrices: what the thesis uses
};

/// How a linear system is solved.
struct SolverOptions {
    SolverChoice choice = SolverChoice::automatic;
    Ordering ordering = Ordering::nested_dissection;
    double tolerance = 1e-12;  ///< relative residual at which the iterative solver stops
    int max_iterations = 500;
};

/// How a linear system was solved.
struct SolveReport {
    SolverChoice solver = SolverChoice::iterative;  ///< the one that gave the result
    std::string note;                               ///< which and why, one sentence
    int iterations = 0;                             ///< largest over the right-hand sides; 0 = direct
    double residual = 0.0;                          ///< largest relative residual over the right-hand sides
};

}  // namespace curvewright
