#include "core/warp/equations.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <set>

#include <gtest/gtest.h>
#include <Eigen/LU>
#include <Eigen/SparseLU>

#include "core/base/error.h"
#include "core/basis/reference_element.h"
#include "core/mesh/node_elements.h"
#include "core/warp/elasticity.h"
#include "tests/support/mesh_factory.h"

namespace curvewright {
namespace {

using testing::cube_mesh;
using testing::hex_mesh;
using testing::prism_mesh;
using testing::quad_mesh;
using testing::shaken;
using testing::square_mesh;

std::vector<bool> boundary_of(const CurvedMesh& mesh) {
    std::vector<bool> result(static_cast<std::size_t>(mesh.topology().node_count()), false);
    for (const Index node : mesh.topology().boundary_nodes()) result[static_cast<std::size_t>(node)] = true;
    return result;
}

/// Nodes that lie inside an element.
std::set<Index> inner_nodes(const CurvedMesh& mesh) {
    std::set<Index> result;
    const MeshTopology& topology = mesh.topology();
    for (Index element = 0; element < topology.element_count(); ++element)
        for (const int local : reference_element(topology.element_type(element)).interior_nodes)
            result.insert(topology.element_nodes(element)[static_cast<std::size_t>(local)]);
    return result;
}

void expect_sound(const CurvedMesh& mesh, const Numbering& numbering, const std::vector<bool>& is_given,
                  bool condense) {
    const MeshTopology& topology = mesh.topology();
    ASSERT_EQ(numbering.number_of.size(), static_cast<std::size_t>(topology.node_count()));
    EXPECT_EQ(numbering.nodes.size(), topology.boundary_nodes().size() + topology.interior_nodes().size());
    EXPECT_EQ(std::set<Index>(numbering.nodes.begin(), numbering.nodes.end()).size(), numbering.nodes.size());
    const std::set<Index> inner = inner_nodes(mesh);
    for (std::size_t number = 0; number < numbering.nodes.size(); ++number) {
        const Index node = numbering.nodes[number];
        EXPECT_EQ(numbering.number_of[static_cast<std::size_t>(node)], static_cast<Index>(number));
        EXPECT_EQ(is_given[static_cast<std::size_t>(node)], static_cast<Index>(number) >= numbering.free);
        const bool is_condensed =
            static_cast<Index>(number) >= numbering.solved && static_cast<Index>(number) < numbering.free;
        EXPECT_EQ(is_condensed, condense && inner.contains(node) && !is_given[static_cast<std::size_t>(node)]);
    }
    // Every group is of one element, and complete.
    ASSERT_FALSE(numbering.group_offsets.empty());
    EXPECT_EQ(numbering.group_offsets.front(), numbering.solved);
    EXPECT_EQ(numbering.group_offsets.back(), numbering.free);
    const NodeElements elements = elements_of_nodes(topology);
    std::set<Index> of_groups;
    for (std::size_t g = 0; g + 1 < numbering.group_offsets.size(); ++g) {
        ASSERT_LT(numbering.group_offsets[g], numbering.group_offsets[g + 1]);
        std::set<Index> owners;
        for (Index number = numbering.group_offsets[g]; number < numbering.group_offsets[g + 1]; ++number)
            for (const Index element : elements.of(numbering.nodes[static_cast<std::size_t>(number)]))
                owners.insert(element);
        EXPECT_EQ(owners.size(), 1u);
        EXPECT_TRUE(of_groups.insert(*owners.begin()).second);
    }
    // Pieces cover the solved nodes; those of a stage share no element.
    const SweepOrder& sweep = numbering.sweep;
    ASSERT_GE(sweep.pieces.size(), 2u);
    EXPECT_EQ(sweep.pieces.front(), 0);
    EXPECT_EQ(sweep.pieces.back(), numbering.solved);
    EXPECT_TRUE(std::is_sorted(sweep.pieces.begin(), sweep.pieces.end()));
    EXPECT_EQ(sweep.stages.front(), 0);
    EXPECT_EQ(static_cast<std::size_t>(sweep.stages.back()), sweep.pieces.size() - 1);
    for (std::size_t stage = 0; stage + 1 < sweep.stages.size(); ++stage) {
        std::vector<Index> piece_of_element(static_cast<std::size_t>(topology.element_count()), -1);
        for (Index piece = sweep.stages[stage]; piece < sweep.stages[stage + 1]; ++piece)
            for (Index number = sweep.pieces[static_cast<std::size_t>(piece)];
                 number < sweep.pieces[static_cast<std::size_t>(piece) + 1]; ++number)
                for (const Index element : elements.of(numbering.nodes[static_cast<std::size_t>(number)])) {
                    Index& owner = piece_of_element[static_cast<std::size_t>(element)];
                    EXPECT_TRUE(owner < 0 || owner == piece);
                    owner = piece;
                }
    }
}

TEST(Numbering, HoldsEveryNodeOnceAndStagesWithoutCoupling) {
    std::mt19937 random(1);
    for (const CurvedMesh& mesh : {square_mesh(20, 3), square_mesh(30, 1), cube_mesh(5, 2), quad_mesh(12, 4),
                                   hex_mesh(4, 3), prism_mesh(4, 3), testing::pyramid_mesh(4), square_mesh(1, 1)})
        for (const bool condense : {false, true}) {
            std::vector<bool> is_given = boundary_of(mesh);
            expect_sound(mesh, number_nodes(mesh, is_given, condense), is_given, condense);
            for (const Index node : mesh.topology().interior_nodes())
                if (random() % 7 == 0) is_given[static_cast<std::size_t>(node)] = true;
            const Numbering numbering = number_nodes(mesh, is_given, condense);
            expect_sound(mesh, numbering, is_given, condense);
            EXPECT_EQ(numbering.free_nodes().size() + static_cast<std::size_t>(numbering.given()),
                      numbering.nodes.size());
        }
    EXPECT_GT(number_nodes(square_mesh(20, 3), boundary_of(square_mesh(20, 3)), true).sweep.stages.size(), 2u);
}

TEST(Numbering, LeavesOutNodesOfNoElement) {
    const CurvedMesh mesh = square_mesh(3, 2);
    MeshData data = mesh.topology().data();
    data.node_tags.push_back({9999});
    Coordinates x(mesh.coordinates().rows() + 1, 3);
    x << mesh.coordinates(), 7.0, 7.0, 0.0;
    const CurvedMesh with_stray(std::make_shared<const MeshTopology>(std::move(data)), x);
    const Numbering numbering = number_nodes(with_stray, boundary_of(with_stray), true);
    EXPECT_EQ(numbering.number_of.back(), -1);
    EXPECT_EQ(numbering.nodes.size(), static_cast<std::size_t>(mesh.topology().node_count()));
}

BlockMatrix equations_of(const CurvedMesh& mesh, const Numbering& numbering, bool is_elastic) {
    if (is_elastic) return elastic_equations(mesh, numbering, ElasticMaterial{});
    const NeighbourSets sets = find_neighbours(mesh.topology(), numbering.free_nodes());
    return weight_equations(numbering, sets, compute_weights(mesh, sets, convex_weighting(2.0)));
}

/// matrix x = b for a matrix that need not be symmetric.
MultiVector solve_sparse(const Eigen::SparseMatrix<double>& matrix, const MultiVector& b) {
    Eigen::SparseLU<Eigen::SparseMatrix<double>> lu(matrix);
    EXPECT_EQ(lu.info(), Eigen::Success);
    return Eigen::MatrixXd(lu.solve(Eigen::MatrixXd(b)));
}

/// Free displacements for given ones, block rows in the order of the numbers.
MultiVector solve_whole(const BlockMatrix& equations, const MultiVector& given) {
    const Eigen::SparseMatrix<double> all = to_sparse(equations);
    const Eigen::Index free = all.rows();
    return solve_sparse(all.leftCols(free), -(all.rightCols(all.cols() - free) * given));
}
MultiVector solve_condensed(const CondensedEquations& condensed, const Numbering& numbering, const MultiVector& given) {
    const Eigen::Index b = condensed.matrix.block, solved = numbering.solved * b;
    MultiVector all(static_cast<Eigen::Index>(numbering.nodes.size()) * b, given.cols());
    all.bottomRows(given.rows()) = given;
    if (solved > 0) {
        MultiVector coupling;
        multiply(condensed.coupling, given, coupling);
        all.topRows(solved) = solve_sparse(to_sparse(condensed.matrix), -coupling);
    }
    for (std::size_t g = 0; g < condensed.groups.size(); ++g) {
        const auto& group = condensed.groups[g];
        MultiVector others(static_cast<Eigen::Index>(group.columns.size()) * b, given.cols());
        for (std::size_t c = 0; c < group.columns.size(); ++c)
            others.middleRows(static_cast<Eigen::Index>(c) * b, b) = all.middleRows(group.columns[c] * b, b);
        all.middleRows(numbering.group_offsets[g] * b, group.factors.rows()) = -group.factors * others;
    }
    return all.topRows(numbering.free * b);
}

TEST(Condensation, GivesTheSolutionOfTheWholeSystem) {
    std::mt19937 random(2);
    std::normal_distribution<double> normal;
    for (int order = 3; order <= 6; ++order) {
        std::vector<CurvedMesh> meshes{square_mesh(2, order), quad_mesh(2, order), cube_mesh(order < 5 ? 2 : 1, order),
                                       hex_mesh(order < 4 ? 2 : 1, order), prism_mesh(order < 4 ? 2 : 1, order)};
        for (const CurvedMesh& straight : meshes)
            for (const bool is_elastic : {false, true})
                for (const bool prescribes : {false, true}) {
                    const CurvedMesh mesh = shaken(straight, 0.02 / order, random);
                    std::vector<bool> is_given = boundary_of(mesh);
                    if (prescribes)
                        for (const Index node : mesh.topology().interior_nodes())
                            if (random() % 5 == 0) is_given[static_cast<std::size_t>(node)] = true;
                    const Numbering whole = number_nodes(mesh, is_given, false);
                    const Numbering numbering = number_nodes(mesh, is_given, true);
                    if (inner_nodes(mesh).empty()) continue;  // P3 tetrahedra
                    ASSERT_LT(numbering.solved, whole.solved);
                    const int block = is_elastic ? mesh.topology().dimension() : 1;
                    MultiVector given(numbering.given() * block, 2);
                    for (double& value : given.reshaped()) value = normal(random);
                    // Given nodes have the same order in both: that of the mesh.
                    ASSERT_TRUE(std::equal(whole.nodes.begin() + whole.free, whole.nodes.end(),
                                           numbering.nodes.begin() + numbering.free));
                    const MultiVector reference = solve_whole(equations_of(mesh, whole, is_elastic), given);
                    const MultiVector result = solve_condensed(
                        condense(numbering, equations_of(mesh, numbering, is_elastic)), numbering, given);
                    double worst = 0.0;
                    for (Index number = 0; number < numbering.free; ++number) {
                        const Index other =
                            whole
                                .number_of[static_cast<std::size_t>(numbering.nodes[static_cast<std::size_t>(number)])];
                        worst = std::max(worst, (result.middleRows(number * block, block) -
                                                 reference.middleRows(other * block, block))
                                                    .cwiseAbs()
                                                    .maxCoeff());
                    }
                    EXPECT_LT(worst, 1e-10 * std::max(1.0, reference.cwiseAbs().maxCoeff()))
                        << name(mesh.topology().element_type(0)) << (is_elastic ? " elastic" : "")
                        << (prescribes ? " prescribed" : "");
                }
    }
}

TEST(Condensation, SingularElementIsRefused) {
    // The condensed node of a cubic triangle, with an equation that does not contain it.
    const CurvedMesh mesh = square_mesh(2, 3);
    const Numbering numbering = number_nodes(mesh, boundary_of(mesh), true);
    BlockMatrix equations = equations_of(mesh, numbering, false);
    for (std::size_t k = equations.offsets[static_cast<std::size_t>(numbering.solved)];
         k < equations.offsets[static_cast<std::size_t>(numbering.solved) + 1]; ++k)
        if (equations.column_of[k] == numbering.solved) equations.values[k] = 0.0;
    EXPECT_THROW(condense(numbering, equations), SolverFailure);
}

TEST(VertexSpace, ReproducesLinearFunctions) {
    std::mt19937 random(3);
    for (int order = 1; order <= 5; ++order)
        for (const CurvedMesh& mesh :
             {square_mesh(4, order), testing::with_shaken_corners(quad_mesh(4, 1), 0.03, order, random),
              cube_mesh(3, std::min(order, 3)), hex_mesh(4, std::min(order, 3)), prism_mesh(4, std::min(order, 3))}) {
            const MeshTopology& topology = mesh.topology();
            const Numbering numbering = number_nodes(mesh, boundary_of(mesh), true);
            const int dim = topology.dimension();
            const CoarseSpace space = vertex_space(mesh, numbering, dim);
            // Vertices are numbered among the solved nodes, in their order.
            std::set<Index> vertices;
            for (Index element = 0; element < topology.element_count(); ++element)
                for (std::size_t c = 0;
                     c < static_cast<std::size_t>(corner_count(topology.element_type(element).shape)); ++c)
                    vertices.insert(topology.element_nodes(element)[c]);
            std::vector<Index> coarse;
            for (Index number = 0; number < numbering.solved; ++number)
                if (vertices.contains(numbering.nodes[static_cast<std::size_t>(number)]))
                    coarse.push_back(numbering.nodes[static_cast<std::size_t>(number)]);
            ASSERT_EQ(space.prolongation.cols(), static_cast<Eigen::Index>(coarse.size()));
            Eigen::MatrixXd at_vertices(space.prolongation.cols(), 4);
            for (std::size_t v = 0; v < coarse.size(); ++v)
                at_vertices.row(static_cast<Eigen::Index>(v)) << mesh.coordinates().row(coarse[v]), 1.0;
            const Eigen::MatrixXd values = space.prolongation * at_vertices;
            const NodeElements elements = elements_of_nodes(topology);
            int complete = 0;
            for (Index number = 0; number < numbering.solved; ++number) {
                const Index node = numbering.nodes[static_cast<std::size_t>(number)];
                EXPECT_LE(values(number, 3), 1.0 + 1e-12);
                // Near the boundary the hat functions of its vertices are missing.
                if (values(number, 3) < 1.0 - 1e-12) continue;
                ++complete;
                EXPECT_LT((values.row(number).head(3) - mesh.coordinates().row(node)).norm(), 1e-12);
            }
            EXPECT_GE(complete, static_cast<int>(coarse.size()));
            // Rigid motions: orthonormal-looking columns that no strain sees, (u(x) - u(y)) · (x - y) = 0.
            EXPECT_EQ(space.near_null.cols(), dim == 2 ? 3 : 6);
            for (Eigen::Index mode = 0; mode < space.near_null.cols(); ++mode)
                for (Eigen::Index v = 1; v < space.prolongation.cols(); ++v) {
                    const Eigen::VectorXd u =
                        space.near_null.col(mode).segment(v * dim, dim) - space.near_null.col(mode).head(dim);
                    const Eigen::VectorXd x = (mesh.coordinates().row(coarse[static_cast<std::size_t>(v)]) -
                                               mesh.coordinates().row(coarse[0]))
                                                  .head(dim);
                    EXPECT_LT(std::abs(u.dot(x)), 1e-13);
                }
            EXPECT_EQ(Eigen::FullPivLU<Eigen::MatrixXd>(space.near_null).rank(), space.near_null.cols());
            EXPECT_TRUE(vertex_space(mesh, numbering, 1).near_null.isOnes(0.0));
        }
}

}  // namespace
}  // namespace curvewright
