#pragma once

#include <string>

#include "benchmarks/warp_tables/settings.h"
#include "core/mesh/curved_mesh.h"
#include "core/warp/warp.h"

namespace curvewright::benchmarks {

/// A mesh and where its boundary goes.
struct Case {
    std::string name;  ///< "circle 4, P3"
    CurvedMesh mesh;
    Coordinates boundary_positions;  ///< nodes × 3
    WarpOptions options;             ///< defaults, with the prescribed nodes of the case

    int dimension() const { return mesh.topology().dimension(); }
};

/// A level of the family circle (dimension 2) or sphere (3), raised to an order. The boundary goes onto the unit circle
/// or sphere, and from there smoothly onto a bent ellipse or ellipsoid. Throws InvalidInput if the mesh is not there.
Case family_case(const Settings& settings, int dimension, int level, int order);

/// The sample moving_sphere (quick: moving_sphere_small) with its deformation.
Case moving_sphere_case(const Settings& settings);

/// Nodes whose motion is given, per node of the mesh.
std::vector<bool> given_nodes(const Case& problem);

}  // namespace curvewright::benchmarks
