#include "core/warp/elasticity.h"

#include <algorithm>
#include <cmath>
#include <map>

#include <fmt/format.h>
#include <Eigen/LU>

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/basis/lagrange.h"
#include "core/basis/quadrature.h"
#include "core/mesh/node_elements.h"

namespace curvewright {
namespace {

/// What the stiffness of an element needs that depends on its type only.
struct ReferenceTables {
    int nodes = 0, dim = 0;
    bool is_affine = false;  ///< the map of a straight-sided element is affine: simplices
    /// Simplices: integrals of products of derivatives, [i][j][k][l] = integral of d_k phi_i d_l phi_j.
    std::vector<double> products;
    /// Others: derivatives at the quadrature points, nodes × (points · dim), points slowest; the same for the linear
    /// functions of the corners, and the weights.
    Eigen::MatrixXd gradients, corner_gradients;
    Eigen::VectorXd weights;
};

/// Derivatives of a basis as one matrix, functions × (points · dim).
Eigen::MatrixXd gather_gradients(const BasisTable& basis, int dim) {
    const Eigen::Index points = basis.values.rows();
    Eigen::MatrixXd result(basis.values.cols(), points * dim);
    for (int d = 0; d < dim; ++d)
        for (Eigen::Index q = 0; q < points; ++q)
            result.col(q * dim + d) = basis.gradients[static_cast<std::size_t>(d)].row(q).transpose();
    return result;
}

ReferenceTables make_tables(ElementType type) {
    ReferenceTables tables;
    tables.nodes = node_count(type);
    tables.dim = dimension(type.shape);
    tables.is_affine = is_simplex(type.shape);
    const QuadratureRule rule = quadrature(type.shape, tables.is_affine ? 2 * (type.order - 1) : 2 * type.order);
    const BasisTable basis = lagrange_basis(type, rule.points);
    if (!tables.is_affine) {
        tables.gradients = gather_gradients(basis, tables.dim);
        tables.corner_gradients = gather_gradients(lagrange_basis({type.shape, 1}, rule.points), tables.dim);
        tables.weights = rule.weights;
        return tables;
    }
    const auto n = static_cast<std::size_t>(tables.nodes), d = static_cast<std::size_t>(tables.dim);
    tables.products.resize(n * n * d * d);
    for (std::size_t k = 0; k < d; ++k)
        for (std::size_t l = 0; l < d; ++l) {
            const Eigen::MatrixXd integral =
                basis.gradients[k].transpose() * rule.weights.asDiagonal() * basis.gradients[l];
            for (std::size_t i = 0; i < n; ++i)
                for (std::size_t j = 0; j < n; ++j)
                    tables.products[((i * n + j) * d + k) * d + l] =
                        integral(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j));
        }
    return tables;
}

/// d xi_k / d x_a times the root of the integration weight (which includes Young's modulus), at every quadrature point;
/// one for simplices. Row-major dim × dim each.
struct ElementGeometry {
    std::vector<double> maps;
    double volume = 0.0;
};

template <int Dim>
ElementGeometry element_geometry(const CurvedMesh& mesh, Index element, const ReferenceTables& tables) {
    using Matrix = Eigen::Matrix<double, Dim, Dim, Eigen::RowMajor>;
    const auto nodes = mesh.topology().element_nodes(element);
    ElementGeometry geometry;
    const auto add = [&](const Matrix& jacobian, double weight) {  // jacobian(a, k) = d x_a / d xi_k
        const double determinant = std::abs(jacobian.determinant());
        geometry.volume += weight * determinant;
        const Matrix map = jacobian.inverse() * std::sqrt(weight * determinant);
        geometry.maps.insert(geometry.maps.end(), map.data(), map.data() + Dim * Dim);
    };
    if (tables.is_affine) {
        Matrix jacobian;
        for (int k = 0; k < Dim; ++k)
            jacobian.col(k) =
                (mesh.coordinates().row(nodes[static_cast<std::size_t>(k) + 1]) - mesh.coordinates().row(nodes[0]))
                    .template head<Dim>()
                    .transpose();
        add(jacobian, 1.0);
        return geometry;
    }
    for (Eigen::Index q = 0; q < tables.weights.size(); ++q) {
        Matrix jacobian = Matrix::Zero();
        for (Eigen::Index c = 0; c < tables.corner_gradients.rows(); ++c)
            jacobian += mesh.coordinates().row(nodes[static_cast<std::size_t>(c)]).template head<Dim>().transpose() *
                        tables.corner_gradients.row(c).segment<Dim>(q * Dim);
        add(jacobian, tables.weights[q]);
    }
    return geometry;
}

/// integral of d_a phi_i d_b phi_j times Young's modulus for one i and all j: nodes × (Dim · Dim), row-major.
template <int Dim>
using GradientProducts = Eigen::Matrix<double, Eigen::Dynamic, Dim * Dim, Eigen::RowMajor>;

template <int Dim>
void gradient_products(const ReferenceTables& tables, const ElementGeometry& geometry, int i,
                       GradientProducts<Dim>& result) {
    using Matrix = Eigen::Matrix<double, Dim, Dim, Eigen::RowMajor>;
    result.resize(tables.nodes, Dim * Dim);
    if (tables.is_affine) {
        const Eigen::Map<const Matrix> map(geometry.maps.data());
        for (int j = 0; j < tables.nodes; ++j) {
            const Eigen::Map<const Matrix> products(tables.products.data() +
                                                    (static_cast<std::ptrdiff_t>(i) * tables.nodes + j) * (Dim * Dim));
            Eigen::Map<Matrix>(result.row(j).data()).noalias() = map.transpose() * products * map;
        }
        return;
    }
    // The factors that belong to i, per point and direction; then one matrix product for all j.
    const Eigen::Index points = tables.weights.size();
    Eigen::MatrixXd factors(points * Dim, Dim * Dim);
    for (Eigen::Index q = 0; q < points; ++q) {
        const Eigen::Map<const Matrix> map(geometry.maps.data() + q * Dim * Dim);
        const Eigen::Matrix<double, 1, Dim> own = tables.gradients.row(i).segment<Dim>(q * Dim) * map;
        for (int a = 0; a < Dim; ++a)
            for (int b = 0; b < Dim; ++b)
                for (int l = 0; l < Dim; ++l) factors(q * Dim + l, a * Dim + b) = own[a] * map(l, b);
    }
    result.noalias() = tables.gradients * factors;
}

template <int Dim>
BlockMatrix assemble(const CurvedMesh& mesh, const Numbering& numbering, const ElasticMaterial& material,
                     const TaskContext& context) {
    const MeshTopology& topology = mesh.topology();
    std::map<ElementType, ReferenceTables> tables;
    for (const ElementBlock& block : topology.blocks())
        if (dimension(block.type.shape) == Dim && !tables.contains(block.type)) {
            context.check();
            tables[block.type] = make_tables(block.type);
        }
    const auto count = static_cast<std::size_t>(topology.element_count());
    std::vector<ElementGeometry> geometry(count);
    std::vector<const ReferenceTables*> table_of(count);
    parallel_for(count, 1024, context, {}, [&](std::size_t begin, std::size_t end) {
        for (std::size_t e = begin; e < end; ++e) {
            const auto element = static_cast<Index>(e);
            table_of[e] = &tables.at(topology.element_type(element));
            geometry[e] = element_geometry<Dim>(mesh, element, *table_of[e]);
            // Rounding gives flat elements a volume, in proportion to their distance from the origin.
            double extent = 0.0, reach = 0.0;
            const auto nodes = topology.element_nodes(element);
            for (int c = 0; c < corner_count(topology.element_type(element).shape); ++c) {
                const auto corner = mesh.coordinates().row(nodes[static_cast<std::size_t>(c)]).template head<Dim>();
                const auto first = mesh.coordinates().row(nodes[0]).template head<Dim>();
                extent = std::max(extent, (corner - first).cwiseAbs().maxCoeff());
                reach = std::max(reach, corner.cwiseAbs().maxCoeff());
            }
            const double rounding = 1e-14 * std::max(extent, reach) * std::pow(extent, Dim - 1);
            if (!(geometry[e].volume > rounding) || !std::isfinite(geometry[e].volume))
                throw InvalidInput(
                    fmt::format("Element {} has corners without volume; an elastic warp needs "
                                "straight-sided elements of nonzero volume.",
                                topology.element_tag(element).value));
        }
    });
    if (material.stiffening != 0.0) {
        double largest = 0.0;
        for (const ElementGeometry& g : geometry) largest = std::max(largest, g.volume);
        for (ElementGeometry& g : geometry) {
            const double root = std::sqrt(std::pow(g.volume / largest, -material.stiffening));
            for (double& entry : g.maps) entry *= root;
        }
    }

    context.report("Finding neighbours", 0.0);
    const NodeElements node_elements = elements_of_nodes(topology);
    BlockMatrix equations;
    equations.block = Dim;
    equations.rows = numbering.free;
    equations.columns = static_cast<Index>(numbering.nodes.size());
    {
        const NeighbourSets sets = find_neighbours(topology, numbering.free_nodes(), NeighbourKind::all, context);
        const auto rows = static_cast<std::size_t>(numbering.free);
        equations.offsets.resize(rows + 1);
        for (std::size_t row = 0; row <= rows; ++row) equations.offsets[row] = sets.offsets[row] + row;
        equations.column_of.resize(equations.offsets.back());
        parallel_for(rows, 4096, context, {}, [&](std::size_t begin, std::size_t end) {
            for (std::size_t row = begin; row < end; ++row) {
                Index* columns = equations.column_of.data() + equations.offsets[row];
                std::size_t size = 0;
                columns[size++] = static_cast<Index>(row);
                for (const Index node : sets.of(row)) columns[size++] = numbering.number_of[node];
                std::sort(columns, columns + size);
            }
        });
    }
    equations.values.assign(equations.block_count() * (Dim * Dim), 0.0);

    const double nu = material.poisson_ratio;
    const double lambda = nu / ((1.0 + nu) * (1.0 - 2.0 * nu)), mu = 0.5 / (1.0 + nu);
    const auto rows = static_cast<std::size_t>(numbering.free);
    // Row by row, so that no two threads add to the same entry. Few pieces: each has an array over all nodes.
    const std::size_t grain = std::max<std::size_t>(256, rows / 48 + 1);
    parallel_for(rows, grain, context, "Assembling the elastic body", [&](std::size_t begin, std::size_t end) {
        std::vector<double*> place(numbering.nodes.size(), nullptr);
        GradientProducts<Dim> products;
        for (std::size_t row = begin; row < end; ++row) {
            if (row % 256 == 0) context.check();
            for (std::size_t k = equations.offsets[row]; k < equations.offsets[row + 1]; ++k)
                place[equations.column_of[k]] = equations.block_at(k);
            const Index node = numbering.nodes[row];
            for (const Index element : node_elements.of(node)) {
                const auto nodes = topology.element_nodes(element);
                const auto local = static_cast<int>(std::find(nodes.begin(), nodes.end(), node) - nodes.begin());
                gradient_products<Dim>(*table_of[element], geometry[element], local, products);
                for (std::size_t j = 0; j < nodes.size(); ++j) {
                    double* target = place[numbering.number_of[nodes[j]]];
                    const double* p = products.row(static_cast<Eigen::Index>(j)).data();
                    double trace = 0.0;
                    for (int a = 0; a < Dim; ++a) trace += p[a * Dim + a];
                    for (int a = 0; a < Dim; ++a) {
                        for (int b = 0; b < Dim; ++b)
                            target[a * Dim + b] += lambda * p[a * Dim + b] + mu * p[b * Dim + a];
                        target[a * Dim + a] += mu * trace;
                    }
                }
            }
        }
    });
    return equations;
}

}  // namespace

BlockMatrix elastic_equations(const CurvedMesh& mesh, const Numbering& numbering, const ElasticMaterial& material,
                              const TaskContext& context) {
    if (!(material.poisson_ratio > -1.0 && material.poisson_ratio < 0.5))
        throw InvalidInput(
            fmt::format("Poisson's ratio is {}; it must be between -1 and 0.5.", material.poisson_ratio));
    if (!std::isfinite(material.stiffening) || std::abs(material.stiffening) > 4.0)
        throw InvalidInput(fmt::format("The stiffening is {}; it must be from -4 to 4.", material.stiffening));
    for (const ElementBlock& block : mesh.topology().blocks())
        if (block.type.shape == Shape::pyramid)
            throw Unsupported("An elastic warp of pyramids is not supported; use convex or affine weights.");
    return mesh.topology().dimension() == 2 ? assemble<2>(mesh, numbering, material, context)
                                            : assemble<3>(mesh, numbering, material, context);
}

}  // namespace curvewright
