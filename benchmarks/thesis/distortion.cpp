#include "benchmarks/thesis/distortion.h"

#include "benchmarks/thesis/comparison.h"
#include "core/basis/reference_element.h"
#include "core/quality/quality.h"

namespace curvewright::benchmarks {
namespace {

bool is_curved(const CurvedMesh& mesh, Index element) {
    const ElementType type = mesh.topology().element_type(element);
    const Eigen::MatrixX3d x = mesh.element_coordinates(element);
    const double size = (x.colwise().maxCoeff() - x.colwise().minCoeff()).maxCoeff();
    const auto& lattice = reference_element(type).lattice;
    for (std::size_t node = 0; node < lattice.size(); ++node) {
        const double xi = static_cast<double>(lattice[node][0]) / type.order;
        const double eta = static_cast<double>(lattice[node][1]) / type.order;
        const Eigen::RowVector3d straight = (1.0 - xi - eta) * x.row(0) + xi * x.row(1) + eta * x.row(2);
        if ((x.row(static_cast<Eigen::Index>(node)) - straight).norm() > 1e-9 * size) return true;
    }
    return false;
}

}  // namespace

MeshDistortion distortion_of(const UntangleCase& problem, const Coordinates& coordinates) {
    QualityOptions options;
    options.orientation_sign = orientation_signs(problem.mesh);
    const CurvedMesh mesh = problem.mesh.with_coordinates(coordinates);
    const QualityReport report = assess_quality(mesh, options);
    MeshDistortion distortion{report.summary.min,
                              report.summary.max,
                              report.summary.mean,
                              1.0,
                              0,
                              report.summary.invalid + report.summary.undecided};
    double sum = 0.0;
    for (Index element = 0; element < mesh.topology().element_count(); ++element) {
        if (!is_curved(mesh, element)) continue;
        ++distortion.curved;
        sum += report.elements[static_cast<std::size_t>(element)].scaled_jacobian;
    }
    if (distortion.curved) distortion.avg2 = sum / distortion.curved;
    return distortion;
}

std::vector<Cell> cells(const MeshDistortion& distortion) {
    return {fixed(distortion.least), fixed(distortion.largest), fixed(distortion.avg1), fixed(distortion.avg2),
            distortion.not_valid};
}

}  // namespace curvewright::benchmarks
