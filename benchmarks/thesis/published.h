#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/base/ids.h"

/// What M. Stees's thesis, "Optimization-based Methods in High-Order Mesh Generation and Untangling", prints in its
/// tables, number by number. Samples are those of sample_meshes, which remake its examples.
namespace curvewright::benchmarks::published {

/// A row of table 2.1 (circle) or 2.2 (sphere). Nodes: of low and high order.
struct FamilyLevel {
    int level = 0;
    Index elements = 0, nodes_p2 = 0, interior_p2 = 0, nodes_p3 = 0, interior_p3 = 0;
    const char* remark = "";
};
std::span<const FamilyLevel> circle_levels();
std::span<const FamilyLevel> sphere_levels();
inline std::span<const FamilyLevel> family_levels(int dimension) {
    return dimension == 2 ? circle_levels() : sphere_levels();
}

/// Scaled Jacobian over a mesh.
struct Distortion {
    double least = 0.0, mean = 0.0, largest = 0.0;
};

/// A row of tables 2.3, 2.4 and 2.5. Times in seconds.
struct WarpExample {
    const char* sample;
    const char* name;
    const char* figure;
    Index elements = 0;
    int order = 2;
    Index interior_nodes = 0;
    double neighbours = 0.0, affine_weights = 0.0, affine_solve = 0.0, convex_weights = 0.0, convex_solve = 0.0;
    Distortion affine, convex;
    const char* remark = "";
};
std::span<const WarpExample> warp_examples();

/// A row of the tables in figures 3.4 to 3.9. Avg1: over all elements, Avg2: over the curved ones.
struct UnsignedMesh {
    const char* name;  ///< "original mesh", "tangled mesh", "resulting mesh"
    double least = 0.0, largest = 0.0, avg1 = 0.0, avg2 = 0.0;
};
/// A row of table 3.1, and the table of the example's figure.
struct UnsignedExample {
    std::vector<std::string> samples;
    const char* name;
    const char* figure;
    Index elements = 0;
    double seconds = 0.0;
    std::vector<UnsignedMesh> meshes;
    const char* remark = "";
};
std::span<const UnsignedExample> unsigned_examples();

/// A row of table 4.1, and the table of the example's figure.
struct SignedExample {
    const char* sample;
    const char* name;
    const char* figure;
    Index elements = 0;
    int order = 2;
    double beta = 0.5;
    int iterations = 0;
    double first_pass = 0.0;  ///< seconds, over all iterations
    std::optional<double> second_pass;
    Index tangled = 0;                ///< elements, from the text
    double start = 0.0, least = 0.0;  ///< scaled Jacobian; the start of the annulus is that of figure 3.4
};
std::span<const SignedExample> signed_examples();

/// A row of the table in figure 4.6.
struct AnnulusBeta {
    double beta = 0.0, least = 0.0, largest = 0.0, seconds = 0.0;
};
std::span<const AnnulusBeta> annulus_betas();

/// A row of the table in figure 4.2: beta = 0.35.
struct ConvergenceStep {
    int iteration = 0;
    double displacement_term = 0.0, angle_term = 0.0, objective = 0.0;
};
std::span<const ConvergenceStep> convergence_steps();

}  // namespace curvewright::benchmarks::published
