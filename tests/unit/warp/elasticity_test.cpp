#include "core/warp/elasticity.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/linear/linear_solver.h"
#include "core/warp/warp.h"
#include "tests/support/mesh_factory.h"
#include "tests/unit/warp/independent_elasticity.h"

namespace curvewright {
namespace {

using testing::cube_mesh;
using testing::hex_mesh;
using testing::prism_mesh;
using testing::quad_mesh;
using testing::square_mesh;
using testing::with_shaken_corners;

Numbering number_interior(const CurvedMesh& mesh, bool condense = false) {
    std::vector<bool> is_given(static_cast<std::size_t>(mesh.topology().node_count()), false);
    for (const Index node : mesh.topology().boundary_nodes()) is_given[static_cast<std::size_t>(node)] = true;
    return number_nodes(mesh, is_given, condense);
}

/// Displacements of the mesh's nodes (nodes × 3), stacked by number.
Eigen::VectorXd by_number(const Numbering& numbering, const Coordinates& u, int dim) {
    Eigen::VectorXd result(static_cast<Eigen::Index>(numbering.nodes.size()) * dim);
    for (std::size_t i = 0; i < numbering.nodes.size(); ++i)
        result.segment(static_cast<Eigen::Index>(i) * dim, dim) = u.row(numbering.nodes[i]).head(dim).transpose();
    return result;
}

std::vector<CurvedMesh> general_meshes(int order, std::mt19937& random) {
    return {with_shaken_corners(square_mesh(2, 1), 0.08, order, random),
            with_shaken_corners(quad_mesh(2, 1), 0.08, order, random),
            with_shaken_corners(cube_mesh(order < 3 ? 2 : 1, 1), 0.06, order, random),
            with_shaken_corners(prism_mesh(order < 3 ? 2 : 1, 1), 0.06, order, random),
            with_shaken_corners(hex_mesh(order < 3 ? 2 : 1, 1), 0.06, order, random)};
}

void expect_equal_rows(const CurvedMesh& mesh, const Eigen::MatrixXd& reference, const ElasticMaterial& material,
                       double tolerance) {
    const int dim = mesh.topology().dimension();
    const Numbering numbering = number_interior(mesh);
    const Eigen::MatrixXd matrix = to_sparse(elastic_equations(mesh, numbering, material));
    double worst = 0.0;
    for (Index r = 0; r < numbering.free; ++r)
        for (std::size_t c = 0; c < numbering.nodes.size(); ++c)
            worst = std::max(worst, (matrix.block(r * dim, static_cast<Index>(c) * dim, dim, dim) -
                                     reference.block(numbering.nodes[static_cast<std::size_t>(r)] * dim,
                                                     numbering.nodes[c] * dim, dim, dim))
                                        .cwiseAbs()
                                        .maxCoeff());
    ASSERT_GT(numbering.free, 0);
    EXPECT_LT(worst, tolerance * reference.cwiseAbs().maxCoeff()) << name(mesh.topology().element_type(0));
}

TEST(Elasticity, LinearTrianglesAndTetrahedraHaveTheTextbookStiffness) {
    // Constant strain: volume B^T D B with the gradients from the inverse of the matrix of corners.
    std::mt19937 random(1);
    for (const CurvedMesh& mesh : {with_shaken_corners(square_mesh(3, 1), 0.05, 1, random),
                                   with_shaken_corners(cube_mesh(2, 1), 0.05, 1, random)}) {
        const MeshTopology& topology = mesh.topology();
        const int dim = topology.dimension();
        Eigen::MatrixXd total = Eigen::MatrixXd::Zero(topology.node_count() * dim, topology.node_count() * dim);
        for (Index element = 0; element < topology.element_count(); ++element) {
            Eigen::MatrixXd corners(dim + 1, dim + 1);
            corners << mesh.element_coordinates(element).leftCols(dim), Eigen::VectorXd::Ones(dim + 1);
            const Eigen::MatrixXd gradients = corners.inverse().topRows(dim).transpose();
            const double volume = std::abs(corners.determinant()) / (dim == 2 ? 2.0 : 6.0);
            const Eigen::MatrixXd b = testing::strain_matrix(gradients, dim);
            const Eigen::MatrixXd own = volume * b.transpose() * testing::hooke(dim, 0.3) * b;
            const auto nodes = topology.element_nodes(element);
            for (int i = 0; i <= dim; ++i)
                for (int j = 0; j <= dim; ++j)
                    total.block(nodes[static_cast<std::size_t>(i)] * dim, nodes[static_cast<std::size_t>(j)] * dim, dim,
                                dim) += own.block(i * dim, j * dim, dim, dim);
        }
        expect_equal_rows(mesh, total, {0.3, 0.0}, 1e-13);
    }
}

TEST(Elasticity, AgreesWithAnIndependentAssembly) {
    std::mt19937 random(2);
    for (int order = 1; order <= 3; ++order) {
        for (const ElasticMaterial& material : {ElasticMaterial{0.33, 0.0}, ElasticMaterial{-0.4, 1.0}})
            for (const CurvedMesh& mesh : general_meshes(order, random)) {
                if (mesh.topology().interior_nodes().empty()) continue;
                // Integrals over general prisms are of rational functions, and the two rules are collapsed differently.
                const bool is_prism = mesh.topology().element_type(0).shape == Shape::prism;
                expect_equal_rows(mesh,
                                  testing::independent_stiffness(mesh, material.poisson_ratio, material.stiffening),
                                  material, is_prism ? (order == 1 ? 2e-2 : 5e-3) : 1e-11);
            }
        for (const CurvedMesh& mesh :
             {quad_mesh(2, order), prism_mesh(2, std::min(order, 2)), hex_mesh(2, std::min(order, 2))})
            expect_equal_rows(mesh, testing::independent_stiffness(mesh, 0.33), {}, 1e-12);
    }
}

TEST(Elasticity, IsSymmetricAndBlindToRigidMotions) {
    std::mt19937 random(3);
    for (int order = 1; order <= 4; ++order)
        for (const CurvedMesh& mesh : general_meshes(order, random)) {
            const int dim = mesh.topology().dimension();
            const Numbering numbering = number_interior(mesh);
            if (numbering.free == 0) continue;
            const Eigen::MatrixXd matrix = to_sparse(elastic_equations(mesh, numbering, {0.4, 0.7}));
            const Eigen::MatrixXd own = matrix.leftCols(matrix.rows());
            const double size = own.cwiseAbs().maxCoeff();
            EXPECT_LT((own - own.transpose()).cwiseAbs().maxCoeff(), 1e-13 * size);
            EXPECT_GT(Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(own).eigenvalues().minCoeff(), 1e-6 * size);
            for (int d = 0; d < dim; ++d) {
                Coordinates shift = Coordinates::Zero(mesh.coordinates().rows(), 3);
                shift.col(d).setOnes();
                EXPECT_LT((matrix * by_number(numbering, shift, dim)).cwiseAbs().maxCoeff(), 1e-11 * size);
                if (dim == 2 && d < 2) continue;
                Eigen::Matrix3d spin = Eigen::Matrix3d::Zero();
                spin((d + 1) % 3, (d + 2) % 3) = 1.0;
                spin((d + 2) % 3, (d + 1) % 3) = -1.0;
                const Coordinates turn = mesh.coordinates() * spin;
                EXPECT_LT((matrix * by_number(numbering, turn, dim)).cwiseAbs().maxCoeff(), 1e-11 * size);
            }
        }
}

TEST(Elasticity, PatchTest) {
    // Affine displacements by the linear solve itself; Warper would take them out beforehand. Parallel and general
    // straight sides.
    std::mt19937 random(4);
    Eigen::Matrix3d map;
    map << 0.3, -0.2, 0.1, 0.5, 0.1, 0.2, -0.4, 0.3, 0.2;
    for (int order = 1; order <= 4; ++order) {
        std::vector<CurvedMesh> meshes = general_meshes(order, random);
        for (const CurvedMesh& mesh : {square_mesh(3, order), quad_mesh(3, order), hex_mesh(2, std::min(order, 3)),
                                       prism_mesh(2, std::min(order, 3)), cube_mesh(2, std::min(order, 3))})
            meshes.push_back(mesh);
        for (const CurvedMesh& mesh : meshes) {
            const int dim = mesh.topology().dimension();
            if (mesh.topology().interior_nodes().empty()) continue;
            const Coordinates affine = mesh.coordinates() * map;
            const Numbering whole = number_interior(mesh);
            MultiVector residual;
            multiply(elastic_equations(mesh, whole, {}), by_number(whole, affine, dim), residual);
            EXPECT_LT(residual.cwiseAbs().maxCoeff(), 1e-11) << name(mesh.topology().element_type(0));

            const Numbering numbering = number_interior(mesh, true);
            CondensedEquations condensed = condense(numbering, elastic_equations(mesh, numbering, {}));
            if (numbering.solved == 0) continue;
            const Eigen::VectorXd exact = by_number(numbering, affine, dim);
            MultiVector coupling;
            multiply(condensed.coupling, exact.tail(numbering.given() * dim), coupling);
            SolverOptions options;
            options.choice = SolverChoice::iterative;
            const LinearSolver solver(
                {std::move(condensed.matrix), true, vertex_space(mesh, numbering, dim), numbering.sweep}, options);
            SolveReport report;
            const MultiVector x = solver.solve(-coupling, report);
            EXPECT_LT((x - exact.head(numbering.solved * dim)).cwiseAbs().maxCoeff(), 1e-10)
                << name(mesh.topology().element_type(0));
        }
    }
}

/// Gradient of a harmonic function: divergence 0 and Laplacian 0, so it solves the equations of elasticity without
/// forces, whatever the material.
Coordinates harmonic_motion(const CurvedMesh& mesh) {
    Coordinates u = Coordinates::Zero(mesh.coordinates().rows(), 3);
    for (Eigen::Index i = 0; i < u.rows(); ++i) {
        const auto x = mesh.coordinates().row(i);
        if (mesh.topology().dimension() == 2) {
            u.row(i) << std::exp(x[0]) * std::cos(x[1]), -std::exp(x[0]) * std::sin(x[1]), 0.0;
        } else {
            const double e = std::exp(x[0]), a = 0.6, b = 0.8;
            u.row(i) << e * std::cos(a * x[1]) * std::cos(b * x[2]), -a * e * std::sin(a * x[1]) * std::cos(b * x[2]),
                -b * e * std::cos(a * x[1]) * std::sin(b * x[2]);
        }
    }
    return u;
}

TEST(Elasticity, ConvergesToASmoothSolutionAtOrderPPlusOne) {
    using Factory = CurvedMesh (*)(int, int);
    for (const Factory make : {Factory(square_mesh), Factory(quad_mesh), Factory(cube_mesh), Factory(hex_mesh)})
        for (int order = 1; order <= 3; ++order) {
            double errors[2];
            const bool is_plane = make(1, 1).topology().dimension() == 2;
            const int first = (is_plane ? 4 : 2) * (order == 1 ? 2 : 1);
            for (int level = 0; level < 2; ++level) {
                const CurvedMesh mesh = make(first << level, order);
                const Coordinates exact = mesh.coordinates() + 0.1 * harmonic_motion(mesh);
                WarpOptions options;
                options.weighting = Weighting::elastic;
                options.poisson_ratio = 0.4;
                const Coordinates difference = warp(mesh, exact, options).coordinates - exact;
                errors[level] =
                    difference.norm() / std::sqrt(static_cast<double>(mesh.topology().interior_nodes().size()));
            }
            const double rate = std::log2(errors[0] / errors[1]);
            EXPECT_GT(rate, order + 0.8) << name(make(1, order).topology().element_type(0));
            EXPECT_LT(errors[1], 2e-3);
        }
}

TEST(Elasticity, RefusesMaterialsThatAreNone) {
    const CurvedMesh mesh = square_mesh(2, 1);
    const Numbering numbering = number_interior(mesh);
    for (const double ratio : {-1.0, 0.5, 0.7, -2.0, std::nan("")})
        EXPECT_THROW(elastic_equations(mesh, numbering, {ratio, 0.0}), InvalidInput) << ratio;
    for (const double stiffening : {5.0, -5.0, std::nan("")})
        EXPECT_THROW(elastic_equations(mesh, numbering, {0.3, stiffening}), InvalidInput) << stiffening;
    EXPECT_NO_THROW(elastic_equations(mesh, numbering, {0.49999, -4.0}));
}

TEST(Elasticity, RefusesPyramids) {
    const CurvedMesh pyramids = testing::pyramid_mesh(2);
    EXPECT_THROW(elastic_equations(pyramids, number_interior(pyramids), {}), Unsupported);
}

TEST(Elasticity, NamesElementsWithoutVolume) {
    // One element each, flattened onto a line or plane askew, so that its volume is zero but for rounding.
    for (const Shape shape :
         {Shape::triangle, Shape::quadrilateral, Shape::tetrahedron, Shape::prism, Shape::hexahedron})
        for (const int order : {1, 2})
            for (const double size : {1e-5, 1.0, 1e5}) {
                const Eigen::Vector3d normal =
                    dimension(shape) == 2 ? Eigen::Vector3d(0.6, 0.8, 0.0) : Eigen::Vector3d(0.36, 0.48, 0.8);
                const Eigen::Matrix3d flattening = Eigen::Matrix3d::Identity() - normal * normal.transpose();
                const CurvedMesh flat = testing::single_element(
                    {shape, order}, (size * reference_nodes({shape, order}) * flattening).array() + 0.3 * size);
                try {
                    elastic_equations(flat, number_interior(flat), {});
                    ADD_FAILURE() << "accepted: " << name(shape) << " " << size;
                } catch (const InvalidInput& error) {
                    EXPECT_NE(std::string(error.what()).find("Element 1 "), std::string::npos) << error.what();
                }
                // A thin one is none without volume.
                const CurvedMesh thin =
                    testing::single_element({shape, order}, size * reference_nodes({shape, order}) *
                                                                (flattening + 1e-5 * Eigen::Matrix3d::Identity()));
                EXPECT_NO_THROW(elastic_equations(thin, number_interior(thin), {})) << name(shape);
            }
}

TEST(Elasticity, InvertedElementsCountWithTheAbsoluteValueOfTheirVolume) {
    // The mirror image numbered alike: the stiffness of the mirrored body.
    const CurvedMesh mesh = square_mesh(3, 2);
    Coordinates x = mesh.coordinates();
    x.col(0) *= -1.0;
    const Numbering numbering = number_interior(mesh);
    const Eigen::MatrixXd original = to_sparse(elastic_equations(mesh, numbering, {}));
    const Eigen::MatrixXd mirrored = to_sparse(elastic_equations(mesh.with_coordinates(x), numbering, {}));
    for (Eigen::Index r = 0; r < original.rows(); ++r)
        for (Eigen::Index c = 0; c < original.cols(); ++c)
            EXPECT_NEAR(mirrored(r, c), ((r + c) % 2 == 0 ? 1.0 : -1.0) * original(r, c), 1e-13);
}

TEST(Elasticity, SameBitsForEveryThreadCountAndCancels) {
    const CurvedMesh mesh = cube_mesh(4, 2);
    const Numbering numbering = number_interior(mesh);
    std::vector<std::vector<double>> values;
    for (const int threads : {1, 2, 4}) {
        set_thread_count(threads);
        values.push_back(elastic_equations(mesh, numbering, {0.33, 1.0}).values);
    }
    set_thread_count(0);
    EXPECT_EQ(values[0], values[1]);
    EXPECT_EQ(values[0], values[2]);
    std::stop_source source;
    const ProgressCallback stop = [&](std::string_view phase, double) {
        if (phase == "Assembling the elastic body") source.request_stop();
    };
    EXPECT_THROW(elastic_equations(mesh, numbering, {}, {source.get_token(), stop}), Cancelled);
}

}  // namespace
}  // namespace curvewright
