#include "benchmarks/cases/warp_case.h"

#include <cmath>

#include <fmt/format.h>

#include "benchmarks/cases/sample_files.h"
#include "core/base/error.h"
#include "core/base/stopwatch.h"
#include "core/deform/deformation.h"
#include "core/io/deformation_file.h"
#include "core/io/mesh_io.h"
#include "core/mesh/elevate.h"

namespace curvewright::benchmarks {
namespace {

/// Where a point of the unit circle or sphere goes: an ellipse or ellipsoid, bent, with a wave on it.
Eigen::RowVector3d family_motion(Eigen::RowVector3d x, int dimension) {
    x.normalize();
    Eigen::RowVector3d moved = x;
    moved[0] = 1.2 * x[0] + 0.15 * x[1] * x[1];
    moved[1] = 0.9 * x[1] + 0.05 * std::cos(4.0 * x[0]);
    if (dimension == 3) moved[2] = x[2] + 0.1 * std::sin(2.0 * x[0] * x[1]);
    return moved;
}

}  // namespace

WarpCase family_case(const std::filesystem::path& families, int dimension, int level, int order) {
    const char* family = dimension == 2 ? "circle" : "sphere";
    const std::filesystem::path file = families / fmt::format("{}_{}.msh", family, level);
    if (!std::filesystem::exists(file))
        throw InvalidInput(fmt::format("{} is missing; make the meshes with sample_meshes/families/generate.sh {}.",
                                       file.string(), families.string()));
    const CurvedMesh mesh = elevate(read_mesh(file).mesh, ElevateOptions{order, ElevatedGeometry::straight}).mesh;
    Coordinates target = mesh.coordinates();
    for (const Index node : mesh.topology().boundary_nodes())
        target.row(node) = family_motion(target.row(node), dimension);
    return {fmt::format("{} {}, P{}", family, level, order), mesh, target, {}};
}

WarpCase sample_warp_case(const std::filesystem::path& samples, const std::string& name) {
    const CurvedMesh mesh = read_mesh(sample_mesh_file(samples, name)).mesh;
    const Deformation deformation = read_deformation(samples / name / "deformation.json");
    WarpOptions options;
    options.prescribed_nodes = prescribed_interior_nodes(mesh, deformation);
    return {fmt::format("{}, P{}", name, mesh.topology().order()), mesh, apply_deformation(mesh, deformation), options};
}

std::vector<bool> given_nodes(const WarpCase& problem) {
    const MeshTopology& topology = problem.mesh.topology();
    std::vector<bool> is_given(static_cast<std::size_t>(topology.node_count()), false);
    for (const Index node : topology.boundary_nodes()) is_given[static_cast<std::size_t>(node)] = true;
    for (const Index node : problem.options.prescribed_nodes) is_given[static_cast<std::size_t>(node)] = true;
    return is_given;
}

TimedWarp timed_warp(const WarpCase& problem) {
    const Stopwatch watch;
    TimedWarp timed;
    timed.result = warp(problem.mesh, problem.boundary_positions, problem.options);
    timed.seconds = watch.seconds();
    return timed;
}

}  // namespace curvewright::benchmarks
