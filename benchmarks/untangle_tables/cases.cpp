#include "benchmarks/untangle_tables/cases.h"

#include "core/base/error.h"
#include "core/deform/deformation.h"
#include "core/io/deformation_file.h"
#include "core/io/mesh_io.h"
#include "core/quality/quality.h"
#include "core/quality/shape_quality.h"

namespace curvewright::benchmarks {
namespace {

const std::vector<ThesisCase> all_cases{
    {"annulus", 4, 0.472, {}},        {"mech_ch4", 4, 0.228, {}}, {"bike_gear", 4, 0.211, {}},
    {"pressure_plate", 4, 0.345, {}}, {"gear", 4, 0.092, {}},     {"brake_rotor", 4, 0.346, {}},
    {"bl_airfoil", 4, 0.053, {}},     {"naca_le", 3, 0.05, {}},   {"mech_ch3", 3, 0.008, 0.14},
    {"plate1", 3, 0.027, {}},         {"plate2", 3, 0.042, 0.08}, {"plate2_p2", 3, 0.042, 0.30},
    {"beam", 3, 0.032, 0.11},
};

}  // namespace

std::span<const ThesisCase> thesis_cases(const Settings& settings) {
    const std::span<const ThesisCase> cases(all_cases);
    return settings.is_quick ? cases.first(2) : cases;
}

Case load_case(const Settings& settings, const std::string& name) {
    const std::filesystem::path folder = settings.samples / name;
    std::filesystem::path file = folder / (name + ".msh");
    if (!std::filesystem::exists(file)) file += ".gz";
    const CurvedMesh straight = read_mesh(file).mesh;
    const Coordinates moved = apply_deformation(straight, read_deformation(folder / "deformation.json"));
    return {name, straight.with_coordinates(moved), straight.coordinates()};
}

Judgement judge(const Case& problem, const Coordinates& coordinates) {
    QualityOptions options;
    options.orientation_sign = assess_quality(problem.mesh).orientation_sign;
    const CurvedMesh mesh = problem.mesh.with_coordinates(coordinates);
    const QualitySummary quality = assess_quality(mesh, options).summary;
    const ShapeSummary shape = assess_shape(mesh, problem.ideal);
    return {quality.invalid + quality.undecided, quality.min, quality.mean, shape.min, shape.mean};
}

}  // namespace curvewright::benchmarks
