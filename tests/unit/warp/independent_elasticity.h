#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>

#include "core/basis/lagrange.h"
#include "core/mesh/curved_mesh.h"

namespace curvewright::testing {

/// Gauss rule on [0, 1] by the eigenvalues of the Jacobi matrix (Golub, Welsch 1969): points, weights.
inline std::pair<Eigen::VectorXd, Eigen::VectorXd> gauss_rule(int n) {
    Eigen::MatrixXd jacobi = Eigen::MatrixXd::Zero(n, n);
    for (int i = 1; i < n; ++i) jacobi(i, i - 1) = jacobi(i - 1, i) = i / std::sqrt(4.0 * i * i - 1.0);
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(jacobi);
    return {(eigen.eigenvalues().array() + 1.0) / 2.0, eigen.eigenvectors().row(0).cwiseAbs2()};
}

/// Exponents of the monomials that span the functions of an element: as many as it has nodes.
inline std::vector<std::array<int, 3>> monomials(ElementType type) {
    std::vector<std::array<int, 3>> result;
    const int p = type.order, dim = dimension(type.shape);
    for (int k = 0; k <= (dim > 2 ? p : 0); ++k)
        for (int j = 0; j <= p; ++j)
            for (int i = 0; i <= p; ++i)
                if (is_simplex(type.shape) ? i + j + k <= p : type.shape != Shape::prism || i + j <= p)
                    result.push_back({i, j, k});
    return result;
}

/// Value (direction -1) or derivative of x^a at a point.
inline double monomial(const std::array<int, 3>& a, const Eigen::RowVector3d& x, int direction) {
    double result = 1.0;
    for (int d = 0; d < 3; ++d) {
        const int power = a[static_cast<std::size_t>(d)];
        if (d != direction)
            result *= std::pow(x[d], power);
        else
            result *= power == 0 ? 0.0 : power * std::pow(x[d], power - 1);
    }
    return result;
}

/// Derivatives of the shape functions at a point, nodes × 3, from monomials and the inverse of their values at the
/// nodes.
class MonomialBasis {
  public:
    explicit MonomialBasis(ElementType type) : powers_(monomials(type)) {
        const Eigen::MatrixX3d nodes = reference_nodes(type);
        Eigen::MatrixXd values(nodes.rows(), nodes.rows());
        for (Eigen::Index i = 0; i < nodes.rows(); ++i)
            for (std::size_t m = 0; m < powers_.size(); ++m)
                values(i, static_cast<Eigen::Index>(m)) = monomial(powers_[m], nodes.row(i), -1);
        coefficients_ = values.fullPivLu().inverse();
    }
    Eigen::MatrixX3d gradients(const Eigen::RowVector3d& x) const {
        Eigen::MatrixX3d of_monomials(static_cast<Eigen::Index>(powers_.size()), 3);
        for (std::size_t m = 0; m < powers_.size(); ++m)
            for (int d = 0; d < 3; ++d) of_monomials(static_cast<Eigen::Index>(m), d) = monomial(powers_[m], x, d);
        return coefficients_.transpose() * of_monomials;
    }

  private:
    std::vector<std::array<int, 3>> powers_;
    Eigen::MatrixXd coefficients_;  ///< monomials × nodes
};

/// Hooke's matrix for engineering strains (xx, yy, xy) in plane strain or (xx, yy, zz, xy, yz, zx); Young's modulus 1.
inline Eigen::MatrixXd hooke(int dim, double nu) {
    const int size = dim == 2 ? 3 : 6;
    Eigen::MatrixXd d = Eigen::MatrixXd::Zero(size, size);
    d.topLeftCorner(dim, dim).setConstant(nu);
    for (int i = 0; i < dim; ++i) d(i, i) = 1.0 - nu;
    for (int i = dim; i < size; ++i) d(i, i) = 0.5 - nu;
    return d / ((1.0 + nu) * (1.0 - 2.0 * nu));
}

/// Strains of unit displacements: (3 or 6) × (nodes · dim), from the gradients in space.
inline Eigen::MatrixXd strain_matrix(const Eigen::MatrixXd& g, int dim) {
    Eigen::MatrixXd b = Eigen::MatrixXd::Zero(dim == 2 ? 3 : 6, g.rows() * dim);
    for (Eigen::Index i = 0; i < g.rows(); ++i) {
        for (int d = 0; d < dim; ++d) b(d, i * dim + d) = g(i, d);
        for (int s = 0; s < (dim == 2 ? 1 : 3); ++s) {
            const int p = s, q = (s + 1) % 3;
            b(dim + s, i * dim + p) = g(i, q);
            b(dim + s, i * dim + q) = g(i, p);
        }
    }
    return b;
}

/// Stiffness of the straight-sided elements of a mesh: (nodes · dim) squared, by nodes of the mesh. Textbook B^T D B
/// at Gauss points collapsed from the cube; nothing of the library but node positions.
inline Eigen::MatrixXd independent_stiffness(const CurvedMesh& mesh, double nu, double stiffening = 0.0) {
    const MeshTopology& topology = mesh.topology();
    const int dim = topology.dimension();
    Eigen::MatrixXd total = Eigen::MatrixXd::Zero(topology.node_count() * dim, topology.node_count() * dim);
    std::vector<Eigen::MatrixXd> stiffness;
    std::vector<double> volumes;
    for (Index element = 0; element < topology.element_count(); ++element) {
        const ElementType type = topology.element_type(element);
        const MonomialBasis basis(type), linear({type.shape, 1});
        const Eigen::MatrixXd corners =
            mesh.element_coordinates(element).topRows(corner_count(type.shape)).leftCols(dim);
        const int n = type.order + 1;
        const auto [points, weights] = gauss_rule(n);
        Eigen::MatrixXd own = Eigen::MatrixXd::Zero(node_count(type) * dim, node_count(type) * dim);
        double volume = 0.0;
        for (int q = 0; q < (dim == 3 ? n * n * n : n * n); ++q) {
            const double u = points[q % n], v = points[q / n % n], w = dim == 3 ? points[q / (n * n)] : 0.0;
            double weight = weights[q % n] * weights[q / n % n] * (dim == 3 ? weights[q / (n * n)] : 1.0);
            Eigen::RowVector3d x(u, v, w);
            if (type.shape == Shape::triangle || type.shape == Shape::prism) {
                x << u, v * (1.0 - u), w;
                weight *= 1.0 - u;
            } else if (type.shape == Shape::tetrahedron) {
                x << u, v * (1.0 - u), w * (1.0 - u) * (1.0 - v);
                weight *= (1.0 - u) * (1.0 - u) * (1.0 - v);
            }
            const Eigen::MatrixXd jacobian = corners.transpose() * linear.gradients(x).leftCols(dim);
            const Eigen::MatrixXd b = strain_matrix(basis.gradients(x).leftCols(dim) * jacobian.inverse(), dim);
            weight *= std::abs(jacobian.determinant());
            own += weight * b.transpose() * hooke(dim, nu) * b;
            volume += weight;
        }
        stiffness.push_back(own);
        volumes.push_back(volume);
    }
    const double largest = *std::max_element(volumes.begin(), volumes.end());
    for (Index element = 0; element < topology.element_count(); ++element) {
        const auto nodes = topology.element_nodes(element);
        const auto e = static_cast<std::size_t>(element);
        const double modulus = std::pow(volumes[e] / largest, -stiffening);
        for (std::size_t i = 0; i < nodes.size(); ++i)
            for (std::size_t j = 0; j < nodes.size(); ++j)
                total.block(nodes[i] * dim, nodes[j] * dim, dim, dim) +=
                    modulus * stiffness[e].block(static_cast<Eigen::Index>(i) * dim, static_cast<Eigen::Index>(j) * dim,
                                                 dim, dim);
    }
    return total;
}

}  // namespace curvewright::testing
