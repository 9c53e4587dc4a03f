#pragma once

#include <optional>
#include <span>
#include <string>

#include "benchmarks/cases/untangle_case.h"
#include "benchmarks/untangle_tables/settings.h"

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

inline UntangleCase load_case(const Settings& settings, const std::string& name) {
    return load_untangle_case(settings.samples, name);
}

}  // namespace curvewright::benchmarks
