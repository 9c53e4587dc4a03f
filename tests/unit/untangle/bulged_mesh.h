#pragma once

#include <cmath>

#include "tests/support/mesh_factory.h"

namespace curvewright::testing {

/// A square whose bottom side bulges into the mesh so that triangles on it are tangled.
inline CurvedMesh bulged(int n, int order, double height) {
    const CurvedMesh mesh = square_mesh(n, order);
    Coordinates x = mesh.coordinates();
    const auto bottom = mesh.topology().find_group_nodes("bottom").value();
    for (Index node : bottom) {
        const double t = x(node, 0) * n - std::floor(x(node, 0) * n);
        x(node, 1) += height * 4 * t * (1 - t);  // corners stay
    }
    return mesh.with_coordinates(x);
}

}  // namespace curvewright::testing
