#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/mesh/curved_mesh.h"
#include "core/warp/warp.h"

namespace curvewright::benchmarks {

/// A mesh and where its boundary goes.
struct WarpCase {
    std::string name;  ///< "circle 4, P3"
    CurvedMesh mesh;
    Coordinates boundary_positions;  ///< nodes × 3
    WarpOptions options;             ///< defaults, with the prescribed nodes of the case

    int dimension() const { return mesh.topology().dimension(); }
};

/// A level of the family circle (dimension 2) or sphere (3), raised to an order. The boundary goes onto the unit circle
/// or sphere, and from there smoothly onto a bent ellipse or ellipsoid. families: where
/// sample_meshes/families/generate.sh put its meshes. Throws InvalidInput if the mesh is not there.
WarpCase family_case(const std::filesystem::path& families, int dimension, int level, int order);

/// A sample with its deformation. Throws InvalidInput that says how to make the mesh if it is not there.
WarpCase sample_warp_case(const std::filesystem::path& samples, const std::string& name);

/// Nodes whose motion is given, per node of the mesh.
std::vector<bool> given_nodes(const WarpCase& problem);

/// A whole warp.
struct TimedWarp {
    double seconds = 0.0;  ///< wall clock of the call, everything included
    WarpResult result;
    double equations_seconds() const { return result.report.neighbours_seconds + result.report.weights_seconds; }
    /// Numbering, condensation, preconditioner, solve and back to the mesh.
    double remaining_seconds() const { return seconds - equations_seconds(); }
    double microseconds_per_node() const { return 1e6 * seconds / result.report.interior_nodes; }
};
TimedWarp timed_warp(const WarpCase& problem);

}  // namespace curvewright::benchmarks
