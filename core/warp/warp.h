#pragma once

#include <string>
#include <vector>

#include "core/base/task.h"
#include "core/mesh/curved_mesh.h"

namespace curvewright {

enum class Weighting {
    convex,  ///< positive weights, maximum of sum c log w (thesis 2.14-2.18, where c = 1)
    affine,  ///< minimum of sum w^2 / c (thesis 2.6-2.9, where c = 1: least 2-norm)
};
const char* to_string(Weighting weighting);

enum class SolverChoice { automatic, direct, iterative };
const char* to_string(SolverChoice solver);

struct WarpOptions {
    Weighting weighting = Weighting::convex;
    /// Influence of a neighbour at distance r: c = r^-distance_power. 0 gives the thesis's weights, in which all nodes
    /// of the patch count alike. Beyond the thesis: with 2 the near neighbours count more, so that small elements are
    /// stiffer than large ones and follow a moving boundary with less distortion, at the same cost.
    double distance_power = 2.0;
    /// Interior nodes whose positions are given like those of the boundary, such as an interface inside the domain that
    /// a deformation moves (see prescribed_interior_nodes in core/deform). Any order; boundary nodes among them are
    /// ignored.
    std::vector<Index> prescribed_nodes;
    SolverChoice solver = SolverChoice::automatic;
    /// Residual of the linear system, relative to its right-hand side, at which the iterative solver stops.
    double residual_tolerance = 1e-12;
    int max_iterations = 5000;
};

struct WarpReport {
    Index interior_nodes = 0;  ///< that followed: without the prescribed ones
    /// Nodes for which convex weights do not exist (not strictly inside the hull of their neighbours); affine weights
    /// were taken for them.
    std::vector<Index> outside_hull;
    /// Nodes whose neighbours do not span the space (all on a line or plane); least-squares weights were taken.
    std::vector<Index> degenerate;
    SolverChoice solver = SolverChoice::iterative;  ///< the one that gave the result
    std::string solver_note;                        ///< why, one sentence
    int iterations = 0;                             ///< largest over the right-hand sides; 0 = direct
    double residual = 0.0;                          ///< largest relative residual over the right-hand sides
    double neighbours_seconds = 0.0, weights_seconds = 0.0, solve_seconds = 0.0;
};

struct WarpResult {
    Coordinates coordinates;
    WarpReport report;
};

/// Moves the interior nodes after the boundary: every interior node keeps the weights by which it is a combination of
/// its neighbours in `mesh` (thesis, chapter 2, Alg. 1). boundary_positions: nodes × 3; only the rows of boundary nodes
/// are read. Any element shapes (neighbours are the nodes that share an element). 2D meshes keep the z of their nodes.
/// Throws SolverFailure, Cancelled.
WarpResult warp(const CurvedMesh& mesh, const Coordinates& boundary_positions, const WarpOptions& options = {},
                const TaskContext& context = {});

}  // namespace curvewright
