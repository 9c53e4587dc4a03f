#pragma once

#include <vector>

#include "benchmarks/cases/untangle_case.h"
#include "benchmarks/tables/table.h"

namespace curvewright::benchmarks {

/// The numbers of the tables in figures 3.4 to 3.9.
struct MeshDistortion {
    double least = 0.0, largest = 0.0;
    double avg1 = 0.0;  ///< over all elements
    double avg2 = 0.0;  ///< over the curved elements of this state of the mesh; 1 if there are none
    Index curved = 0, not_valid = 0;
};

/// Scaled Jacobians, certified, with the orientation of the problem's mesh. An element of triangles is curved if a node
/// is farther from where a straight-sided element has it than 1e-9 of the element's size.
MeshDistortion distortion_of(const UntangleCase& problem, const Coordinates& coordinates);

/// least, largest, Avg1, Avg2, not valid
std::vector<Cell> cells(const MeshDistortion& distortion);

}  // namespace curvewright::benchmarks
