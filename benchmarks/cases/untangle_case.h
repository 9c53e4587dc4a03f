#pragma once

#include <filesystem>
#include <string>

#include "core/mesh/curved_mesh.h"

namespace curvewright::benchmarks {

/// A mesh to be untangled.
struct UntangleCase {
    std::string name;
    CurvedMesh mesh;
    Coordinates ideal;  ///< its corners are those of the elements that shapes are measured against
};

/// A sample with its deformation applied. Throws InvalidInput if it is not there.
UntangleCase load_untangle_case(const std::filesystem::path& samples, const std::string& name);

/// What assess_quality and assess_shape say of a mesh.
struct Judgement {
    Index invalid = 0;                         ///< elements that are not certified valid
    double min = 0.0, mean = 0.0, max = 0.0;   ///< scaled Jacobian
    double shape_min = 0.0, shape_mean = 0.0;  ///< mean ratio against the ideal
};
Judgement judge(const UntangleCase& problem, const Coordinates& coordinates);

}  // namespace curvewright::benchmarks
