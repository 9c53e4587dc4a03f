#include "core/warp/warp.h"

#include <limits>

#include <fmt/format.h>

#include "core/base/error.h"
#include "core/base/stopwatch.h"
#include "core/warp/neighbours.h"
#include "core/warp/solve.h"
#include "core/warp/weights.h"

namespace curvewright {

const char* to_string(Weighting weighting) {
    return weighting == Weighting::convex ? "convex" : "affine";
}

const char* to_string(SolverChoice solver) {
    switch (solver) {
        case SolverChoice::automatic:
            return "auto";
        case SolverChoice::direct:
            return "direct";
        case SolverChoice::iterative:
            return "iterative";
    }
    return "";
}

WarpResult warp(const CurvedMesh& mesh, const Coordinates& boundary_positions, const WarpOptions& options,
                const TaskContext& context) {
    const MeshTopology& topology = mesh.topology();
    if (topology.dimension() < 2) throw Unsupported("Warping needs a mesh of dimension 2 or 3.");
    if (boundary_positions.rows() != topology.node_count())
        throw InvalidInput(fmt::format("The boundary positions are {} rows; the mesh has {} nodes.",
                                       boundary_positions.rows(), topology.node_count()));
    if (!(options.distance_power >= 0.0 && options.distance_power <= 8.0))
        throw InvalidInput(fmt::format("The distance power is {}; it must be from 0 to 8.", options.distance_power));
    const int dim = topology.dimension();
    std::vector<bool> is_given(static_cast<std::size_t>(topology.node_count()), false);
    for (Index node : topology.boundary_nodes()) is_given[node] = true;
    for (Index node : options.prescribed_nodes)
        if (topology.is_interior_node(node)) is_given[node] = true;
    std::vector<Index> interior;  // the nodes that follow
    for (Index node : topology.interior_nodes())
        if (!is_given[node]) interior.push_back(node);
    WarpResult result{mesh.coordinates(), {}};
    for (Index node = 0; node < topology.node_count(); ++node)
        if (is_given[node]) result.coordinates.row(node) = boundary_positions.row(node);
    if (!result.coordinates.allFinite()) throw InvalidInput("A boundary node's new position is not finite.");
    if (dim == 2)
        for (Index node = 0; node < topology.node_count(); ++node)
            if (result.coordinates(node, 2) != mesh.coordinates()(node, 2))
                throw InvalidInput(fmt::format(
                    "Boundary node {} of the 2D mesh would leave its plane (z = {} instead of {}); "
                    "a deformation of a 2D mesh must keep z.",
                    topology.node_tag(node).value, result.coordinates(node, 2), mesh.coordinates()(node, 2)));
    WarpReport& report = result.report;
    report.interior_nodes = static_cast<Index>(interior.size());
    if (interior.empty()) {
        report.solver_note = "The mesh has no interior nodes; only its boundary moved.";
        return result;
    }

    Stopwatch watch;
    const NeighbourSets sets = find_neighbours(topology, interior, context);
    report.neighbours_seconds = watch.seconds();
    watch = {};
    const WeightTable table = compute_weights(mesh, sets, options.weighting, options.distance_power, context);
    report.weights_seconds = watch.seconds();
    for (std::size_t i = 0; i < interior.size(); ++i) {
        if (table.status[i] == PatchStatus::outside_hull) report.outside_hull.push_back(interior[i]);
        if (table.status[i] == PatchStatus::degenerate) report.degenerate.push_back(interior[i]);
    }

    // In displacements u = x_new - x_old: u_I - W_II u_I = W_IB u_B (thesis 2.5). The start is zero, and the relative
    // residual is relative to the motion.
    watch = {};
    std::vector<Index> unknown(static_cast<std::size_t>(topology.node_count()), -1);
    for (std::size_t i = 0; i < interior.size(); ++i) unknown[interior[i]] = static_cast<Index>(i);
    const auto count = static_cast<Eigen::Index>(interior.size());
    if (sets.nodes.size() + interior.size() > static_cast<std::size_t>(std::numeric_limits<int>::max()))
        throw Unsupported(fmt::format("The warp of this mesh has {} weights; at most {} are supported.",
                                      sets.nodes.size(), std::numeric_limits<int>::max()));
    Eigen::SparseMatrix<double, Eigen::RowMajor> matrix(count, count);
    Eigen::MatrixXd rhs = Eigen::MatrixXd::Zero(count, dim);
    matrix.reserve(static_cast<Eigen::Index>(sets.nodes.size()) + count);
    for (Eigen::Index i = 0; i < count; ++i) {
        // Interior nodes and sets are both ascending, so the columns come in order; the diagonal goes between them.
        matrix.startVec(i);
        bool has_diagonal = false;
        for (std::size_t k = sets.offsets[i]; k < sets.offsets[i + 1]; ++k) {
            const Index node = sets.nodes[k], column = unknown[node];
            if (column < 0) {
                rhs.row(i) +=
                    table.weights[k] * (result.coordinates.row(node) - mesh.coordinates().row(node)).head(dim);
                continue;
            }
            if (!has_diagonal && column > i) {
                matrix.insertBack(i, i) = 1.0;
                has_diagonal = true;
            }
            matrix.insertBack(i, column) = -table.weights[k];
        }
        if (!has_diagonal) matrix.insertBack(i, i) = 1.0;
    }
    matrix.finalize();

    SolveReport solve;
    const Eigen::MatrixXd displacement = solve_linear(matrix, rhs, options, solve, context);
    for (Eigen::Index i = 0; i < count; ++i) result.coordinates.row(interior[i]).head(dim) += displacement.row(i);
    if (!result.coordinates.allFinite()) throw SolverFailure("The warp gave positions that are not finite.");
    report.solver = solve.solver;
    report.solver_note = solve.note;
    report.iterations = solve.iterations;
    report.residual = solve.residual;
    report.solve_seconds = watch.seconds();
    return result;
}

}  // namespace curvewright
