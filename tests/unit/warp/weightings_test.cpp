// Weights of the patches of whole meshes, and weightings that callers bring along.
#include <algorithm>
#include <cmath>
#include <random>

#include <gtest/gtest.h>
#include <Eigen/Cholesky>
#include <Eigen/LU>

#include "core/base/error.h"
#include "core/warp/warp.h"
#include "tests/support/mesh_factory.h"
#include "tests/unit/warp/convex_reference.h"

namespace curvewright {
namespace {

using testing::shaken;

/// Offsets of a patch, from the mesh.
Eigen::MatrixXd offsets_of(const CurvedMesh& mesh, const NeighbourSets& sets, std::size_t i) {
    const auto nodes = sets.of(i);
    Eigen::MatrixXd offsets(static_cast<Eigen::Index>(nodes.size()), mesh.topology().dimension());
    for (Eigen::Index j = 0; j < offsets.rows(); ++j)
        offsets.row(j) =
            (mesh.coordinates().row(nodes[static_cast<std::size_t>(j)]) - mesh.coordinates().row(sets.centers[i]))
                .head(offsets.cols());
    return offsets;
}

std::vector<CurvedMesh> curved_meshes(std::mt19937& random) {
    std::vector<CurvedMesh> meshes;
    for (int order = 2; order <= 4; ++order) {
        meshes.push_back(shaken(testing::square_mesh(4, order), 0.02 / order, random));
        meshes.push_back(shaken(testing::cube_mesh(2, order), 0.04 / order, random));
    }
    return meshes;
}

TEST(MeshWeights, AgreeWithAlgorithm3OfTheThesis) {
    std::mt19937 random(1);
    for (const CurvedMesh& mesh : curved_meshes(random))
        for (const double power : {0.0, 2.0}) {
            const NeighbourSets sets = find_neighbours(mesh.topology(), mesh.topology().interior_nodes());
            const WeightTable table = compute_weights(mesh, sets, convex_weighting(power));
            int compared = 0;
            for (std::size_t i = 0; i < sets.centers.size(); i += 1 + sets.centers.size() / 12) {
                if (sets.of(i).size() > 160) continue;
                ASSERT_EQ(table.status[i], PatchStatus::regular);
                const Eigen::MatrixXd offsets = offsets_of(mesh, sets, i);
                const Eigen::Map<const Eigen::VectorXd> weights(table.weights.data() + sets.offsets[i], offsets.rows());
                const Eigen::VectorXd reference = testing::convex_weights_by_kkt(offsets, influences(offsets, power));
                EXPECT_LT((weights - reference).cwiseAbs().maxCoeff(), 1e-8) << power;
                ++compared;
            }
            EXPECT_GE(compared, 5);
        }
}

TEST(MeshWeights, SumToOneAndReproduceTheirNodes) {
    std::mt19937 random(2);
    for (const CurvedMesh& mesh : curved_meshes(random))
        for (const double power : {0.0, 2.0})
            for (const WeightFunction& weighting : {convex_weighting(power), affine_weighting(power)}) {
                const NeighbourSets sets = find_neighbours(mesh.topology(), mesh.topology().interior_nodes());
                const WeightTable table = compute_weights(mesh, sets, weighting);
                double worst = 0.0;
                for (std::size_t i = 0; i < sets.centers.size(); ++i) {
                    const Eigen::MatrixXd offsets = offsets_of(mesh, sets, i);
                    const Eigen::Map<const Eigen::VectorXd> weights(table.weights.data() + sets.offsets[i],
                                                                    offsets.rows());
                    worst = std::max({worst, std::abs(weights.sum() - 1.0),
                                      (offsets.transpose() * weights).norm() / offsets.cwiseAbs().maxCoeff()});
                }
                EXPECT_LT(worst, 1e-12);
            }
}

/// The warp written out: interior positions that are the weighted means of their neighbours, by a dense solve.
Coordinates dense_warp(const CurvedMesh& mesh, const Coordinates& target, const WeightFunction& weighting) {
    const MeshTopology& topology = mesh.topology();
    const NeighbourSets sets = find_neighbours(topology, topology.interior_nodes());
    const WeightTable table = compute_weights(mesh, sets, weighting);
    const auto nodes = static_cast<Eigen::Index>(topology.node_count());
    Eigen::MatrixXd matrix = Eigen::MatrixXd::Identity(nodes, nodes);
    Coordinates motion = target - mesh.coordinates();
    for (std::size_t i = 0; i < sets.centers.size(); ++i) {
        motion.row(sets.centers[i]).setZero();
        for (std::size_t k = sets.offsets[i]; k < sets.offsets[i + 1]; ++k)
            matrix(sets.centers[i], sets.nodes[k]) -= table.weights[k];
    }
    return mesh.coordinates() + Coordinates(matrix.partialPivLu().solve(motion));
}

/// An example of a weighting of one's own: inversely proportional to the distance. It does not reproduce the node, so
/// that affine motions of the boundary give affine motions of the interior only because the warp adds them itself.
PatchStatus inverse_distance(const Patch& patch, Eigen::Ref<Eigen::VectorXd> weights) {
    weights = patch.offsets.rowwise().norm().cwiseInverse();
    weights /= weights.sum();
    return PatchStatus::regular;
}

PatchStatus uniform(const Patch&, Eigen::Ref<Eigen::VectorXd> weights) {
    weights.setConstant(1.0 / static_cast<double>(weights.size()));
    return PatchStatus::regular;
}

Coordinates bent(const CurvedMesh& mesh) {
    Coordinates x = mesh.coordinates();
    x.col(1) += 0.2 * (3.0 * x.col(0)).array().sin().matrix();
    x.col(0) += 0.1 * x.col(1).cwiseAbs2();
    return x;
}

TEST(CustomWeighting, AnyFunctionOfThePatchCanBeUsed) {
    std::mt19937 random(3);
    for (const CurvedMesh& mesh :
         {shaken(testing::square_mesh(5, 3), 0.005, random), testing::cube_mesh(2, 2), testing::hex_mesh(2, 2)})
        for (const WeightFunction& weighting : {WeightFunction(inverse_distance), WeightFunction(uniform)}) {
            // The affine part of the motion is left out: weights that do not reproduce the node are not asked for it.
            Coordinates target = bent(mesh);
            WarpOptions options;
            options.weighting = Weighting::custom;
            options.custom_weights = weighting;
            const Coordinates moved = warp(mesh, target, options).coordinates;
            for (const Index node : mesh.topology().boundary_nodes()) EXPECT_EQ(moved.row(node), target.row(node));
            // Affine part of the boundary's motion by least squares, then the written-out warp for the rest.
            const auto& boundary = mesh.topology().boundary_nodes();
            const int dim = mesh.topology().dimension();
            Eigen::MatrixXd basis(mesh.coordinates().rows(), dim + 1);
            basis << mesh.coordinates().leftCols(dim), Eigen::VectorXd::Ones(basis.rows());
            Eigen::MatrixXd a(static_cast<Eigen::Index>(boundary.size()), dim + 1), b(a.rows(), 3);
            for (Eigen::Index i = 0; i < a.rows(); ++i) {
                a.row(i) = basis.row(boundary[static_cast<std::size_t>(i)]);
                b.row(i) = (target - mesh.coordinates()).row(boundary[static_cast<std::size_t>(i)]);
            }
            const Coordinates affine = basis * (a.transpose() * a).ldlt().solve(a.transpose() * b);
            const Coordinates expected = dense_warp(mesh, target - affine, weighting) + affine;
            EXPECT_LT((moved - expected).cwiseAbs().maxCoeff(), 1e-10);
        }
}

TEST(CustomWeighting, TheLibrarysOwnAsCustomGivesTheSame) {
    const CurvedMesh mesh = testing::square_mesh(6, 3);
    for (const Weighting own : {Weighting::convex, Weighting::affine}) {
        WarpOptions options;
        options.weighting = own;
        const Coordinates expected = warp(mesh, bent(mesh), options).coordinates;
        EXPECT_GT((expected - mesh.coordinates()).norm(), 0.1);
        options.custom_weights = own == Weighting::convex
                                     ? convex_weighting(options.distance_power, options.sharing_power)
                                     : affine_weighting(options.distance_power, options.sharing_power);
        options.weighting = Weighting::custom;
        EXPECT_LT((warp(mesh, bent(mesh), options).coordinates - expected).cwiseAbs().maxCoeff(), 1e-10);
    }
}

TEST(CustomWeighting, FaultsAreToldAndNothingIsSwallowed) {
    const CurvedMesh mesh = testing::square_mesh(4, 2);
    WarpOptions options;
    options.weighting = Weighting::custom;
    EXPECT_THROW(warp(mesh, bent(mesh), options), InvalidInput);
    options.custom_weights = [](const Patch&, Eigen::Ref<Eigen::VectorXd> weights) {
        weights.setConstant(std::nan(""));
        return PatchStatus::regular;
    };
    EXPECT_THROW(warp(mesh, bent(mesh), options), SolverFailure);
    options.custom_weights = [](const Patch&, Eigen::Ref<Eigen::VectorXd>) -> PatchStatus {
        throw std::runtime_error("no weights today");
    };
    EXPECT_THROW(warp(mesh, bent(mesh), options), std::runtime_error);
    // A status is reported with the node.
    const Index special = mesh.topology().interior_nodes()[3];
    options.custom_weights = [special](const Patch& patch, Eigen::Ref<Eigen::VectorXd> weights) {
        uniform(patch, weights);
        return patch.center == special ? PatchStatus::outside_hull : PatchStatus::regular;
    };
    EXPECT_EQ(warp(mesh, bent(mesh), options).report.outside_hull, std::vector<Index>{special});
}

TEST(OutsideHull, FallsBackOrRefusesAndNamesTheNode) {
    CurvedMesh mesh = testing::square_mesh(2, 1);
    const Index middle = mesh.topology().interior_nodes().front();
    Coordinates x = mesh.coordinates();
    x.row(middle) << 1.5, 0.5, 0.0;
    mesh = mesh.with_coordinates(x);
    WarpOptions options;
    const WarpResult result = warp(mesh, bent(mesh), options);
    EXPECT_EQ(result.report.outside_hull, std::vector<Index>{middle});
    WarpOptions affine;
    affine.weighting = Weighting::affine;
    EXPECT_LT((result.coordinates - warp(mesh, bent(mesh), affine).coordinates).cwiseAbs().maxCoeff(), 1e-13);
    options.outside_hull = OutsideHull::refuse;
    try {
        warp(mesh, bent(mesh), options);
        ADD_FAILURE() << "accepted";
    } catch (const SolverFailure& error) {
        const std::string tag = std::to_string(mesh.topology().node_tag(middle).value);
        EXPECT_NE(std::string(error.what()).find("node " + tag), std::string::npos) << error.what();
    }
}

TEST(NeighbourKinds, EveryKindWarps) {
    for (const CurvedMesh& mesh : {testing::square_mesh(6, 3), testing::cube_mesh(2, 4), testing::quad_mesh(4, 3)}) {
        Coordinates last = mesh.coordinates();
        for (const NeighbourKind kind :
             {NeighbourKind::all, NeighbourKind::high_order, NeighbourKind::edge_connected}) {
            WarpOptions options;
            options.neighbours = kind;
            options.solver = SolverChoice::direct;
            const WarpResult result = warp(mesh, bent(mesh), options);
            EXPECT_GT((result.coordinates - last).norm(), 1e-6);  // another result for each
            last = result.coordinates;
            EXPECT_EQ(result.report.condensed_nodes > 0, kind != NeighbourKind::edge_connected);
            options.condense = false;
            options.solver = SolverChoice::iterative;
            EXPECT_LT((warp(mesh, bent(mesh), options).coordinates - last).cwiseAbs().maxCoeff(), 1e-9)
                << to_string(kind);
        }
    }
}

}  // namespace
}  // namespace curvewright
