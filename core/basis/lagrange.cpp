#include "core/basis/lagrange.h"

#include <vector>

#include "core/base/error.h"
#include "core/basis/reference_element.h"

namespace curvewright {
namespace {

/// Silvester's factor P_m(t) = prod_{k<m} (p t - k) / (k + 1) and its derivative.
struct Factor {
    double value = 1.0;
    double derivative = 0.0;
};

std::vector<Factor> silvester_factors(int order, double t) {
    std::vector<Factor> factors(order + 1);
    for (int m = 1; m <= order; ++m) {
        const double scale = 1.0 / m;
        const double linear = (order * t - (m - 1)) * scale;
        factors[m].value = factors[m - 1].value * linear;
        factors[m].derivative = factors[m - 1].derivative * linear + factors[m - 1].value * order * scale;
    }
    return factors;
}

/// Values and gradients of all functions of a simplex lattice (dimension 1 to 3) at one point.
void simplex_functions(int order, int dim, const std::vector<LatticePoint>& lattice, const double* x, double* value,
                       std::array<double, 3>* gradient) {
    std::array<std::vector<Factor>, 4> factors;
    double rest = 1.0;
    for (int d = 0; d < dim; ++d) {
        rest -= x[d];
        factors[d + 1] = silvester_factors(order, x[d]);
    }
    factors[0] = silvester_factors(order, rest);
    for (std::size_t node = 0; node < lattice.size(); ++node) {
        std::array<Factor, 4> f;
        int left = order;
        for (int d = 0; d < dim; ++d) {
            left -= lattice[node][d];
            f[d + 1] = factors[d + 1][lattice[node][d]];
        }
        f[0] = factors[0][left];
        std::array<double, 4> partial{};  // derivative along each barycentric coordinate
        double product = 1.0;
        for (int i = 0; i <= dim; ++i) product *= f[i].value;
        for (int i = 0; i <= dim; ++i) {
            partial[i] = f[i].derivative;
            for (int j = 0; j <= dim; ++j)
                if (j != i) partial[i] *= f[j].value;
        }
        value[node] = product;
        for (int d = 0; d < dim; ++d) gradient[node][d] = partial[d + 1] - partial[0];
    }
}

}  // namespace

BasisTable lagrange_basis(ElementType type, const Eigen::Ref<const Eigen::MatrixX3d>& points) {
    if (type.shape == Shape::pyramid)
        throw Unsupported("The shape functions of pyramids are rational and not supported.");
    const ReferenceElement& element = reference_element(type);
    const int nodes = element.node_count();
    BasisTable table;
    table.values.setOnes(points.rows(), nodes);
    for (int d = 0; d < element.dimension; ++d) table.gradients[d].setOnes(points.rows(), nodes);

    int first_axis = 0;
    for (const int dim : simplex_factors(type.shape)) {
        std::vector<LatticePoint> lattice(nodes);
        for (int node = 0; node < nodes; ++node)
            for (int d = 0; d < dim; ++d) lattice[node][d] = element.lattice[node][first_axis + d];
        std::vector<double> value(nodes);
        std::vector<std::array<double, 3>> gradient(nodes);
        for (Eigen::Index row = 0; row < points.rows(); ++row) {
            std::array<double, 3> x{};
            for (int d = 0; d < dim; ++d) x[d] = points(row, first_axis + d);
            simplex_functions(type.order, dim, lattice, x.data(), value.data(), gradient.data());
            for (int node = 0; node < nodes; ++node) {
                table.values(row, node) *= value[node];
                for (int d = 0; d < element.dimension; ++d) {
                    const bool is_own = d >= first_axis && d < first_axis + dim;
                    table.gradients[d](row, node) *= is_own ? gradient[node][d - first_axis] : value[node];
                }
            }
        }
        first_axis += dim;
    }
    return table;
}

namespace {

Eigen::MatrixX3d scaled(const std::vector<LatticePoint>& lattice, int degree) {
    Eigen::MatrixX3d points(static_cast<Eigen::Index>(lattice.size()), 3);
    for (Eigen::Index i = 0; i < points.rows(); ++i)
        for (int d = 0; d < 3; ++d)
            points(i, d) = static_cast<double>(lattice[static_cast<std::size_t>(i)][d]) / degree;
    return points;
}

}  // namespace

Eigen::MatrixX3d lattice_points(Shape shape, int degree) {
    return scaled(gmsh_node_order({shape, degree}), degree);
}

Eigen::MatrixX3d reference_nodes(ElementType type) {
    return scaled(reference_element(type).lattice, type.order);
}

}  // namespace curvewright
