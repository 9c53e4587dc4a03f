#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "benchmarks/untangle_tables/settings.h"
#include "core/mesh/curved_mesh.h"

namespace curvewright::benchmarks {

/// An untangling example of the literature: M. Stees, "Optimization-based Methods in High-Order Mesh Generation and
/// Untangling". The meshes are remade: names, counts and least scaled Jacobians are the thesis's, dimensions are not.
struct ThesisCase {
    std::string name;      ///< of the sample
    int chapter = 3;       ///< 3: unsigned angles, 4: signed angles
    double minimum = 0.0;  ///< least scaled Jacobian of the thesis's result
    /// Chapter 3: what the method must reach; the thesis's own minimum on its mesh is lower. None: get what can be got.
    std::optional<double> wanted;
};
std::span<const ThesisCase> thesis_cases(const Settings& settings);

/// A mesh to be untangled.
struct Case {
    std::string name;
    CurvedMesh mesh;
    Coordinates ideal;  ///< its corners are those of the elements that shapes are measured against
};

/// A sample with its deformation applied. Throws InvalidInput if it is not there.
Case load_case(const Settings& settings, const std::string& name);

/// What assess_quality and assess_shape say of a mesh.
struct Judgement {
    Index invalid = 0;                         ///< elements that are not certified valid
    double min = 0.0, mean = 0.0;              ///< scaled Jacobian
    double shape_min = 0.0, shape_mean = 0.0;  ///< mean ratio against the ideal
};
Judgement judge(const Case& problem, const Coordinates& coordinates);

}  // namespace curvewright::benchmarks
