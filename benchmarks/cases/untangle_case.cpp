#include "benchmarks/cases/untangle_case.h"

#include "benchmarks/cases/sample_files.h"
#include "core/deform/deformation.h"
#include "core/io/deformation_file.h"
#include "core/io/mesh_io.h"
#include "core/quality/quality.h"
#include "core/quality/shape_quality.h"

namespace curvewright::benchmarks {

UntangleCase load_untangle_case(const std::filesystem::path& samples, const std::string& name) {
    const CurvedMesh straight = read_mesh(sample_mesh_file(samples, name)).mesh;
    const Coordinates moved = apply_deformation(straight, read_deformation(samples / name / "deformation.json"));
    return {name, straight.with_coordinates(moved), straight.coordinates()};
}

Judgement judge(const UntangleCase& problem, const Coordinates& coordinates) {
    QualityOptions options;
    options.orientation_sign = assess_quality(problem.mesh).orientation_sign;
    const CurvedMesh mesh = problem.mesh.with_coordinates(coordinates);
    const QualitySummary quality = assess_quality(mesh, options).summary;
    const ShapeSummary shape = assess_shape(mesh, problem.ideal);
    return {quality.invalid + quality.undecided, quality.min, quality.mean, quality.max, shape.min, shape.mean};
}

}  // namespace curvewright::benchmarks
