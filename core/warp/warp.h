#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/base/task.h"
#include "core/linear/multi_vector.h"
#include "core/linear/solver_options.h"
#include "core/mesh/curved_mesh.h"
#include "core/warp/neighbours.h"
#include "core/warp/weights.h"

namespace curvewright {

/// How the interior follows the boundary.
enum class Weighting {
    convex,   ///< positive weights, maximum of sum c log w (thesis 2.14-2.18, where c = 1)
    affine,   ///< minimum of sum w^2 / c (thesis 2.6-2.9, where c = 1: least 2-norm)
    elastic,  ///< no weights: the mesh is a linearly elastic body, its boundary is moved (see assemble_elasticity)
    custom,   ///< the caller's own, WarpOptions::custom_weights
};
/// "convex", "affine", "elastic", "custom".
const char* to_string(Weighting weighting);

/// What to do with a node for which the weights do not exist: convex ones, because it lies on or outside the hull of
/// its neighbours, or any, because these lie on a line or in a plane.
enum class OutsideHull {
    affine,  ///< takes affine, or least-squares weights for it; WarpReport names it
    refuse,  ///< throws SolverFailure that names it
};

/// Options of a warp.
struct WarpOptions {
    Weighting weighting = Weighting::convex;
    /// Influence of a neighbour at distance r that shares n elements with the node: c = r^-distance_power
    /// n^sharing_power. 0 and 0 give the thesis's weights, in which all nodes of the patch count alike. Beyond the
    /// thesis: near neighbours and those that the node meets in several elements count more, so that small elements are
    /// stiffer than large ones and follow a moving boundary with less distortion, at the same cost.
    double distance_power = 7.0;
    double sharing_power = 4.0;
    /// For Weighting::custom.
    WeightFunction custom_weights;
    NeighbourKind neighbours = NeighbourKind::all;
    OutsideHull outside_hull = OutsideHull::affine;
    /// Elastic: Poisson's ratio, in (-1, 0.5).
    double poisson_ratio = 0.33;
    /// Elastic: Young's modulus of an element is its volume to the power -stiffening. 0 = all alike; with 1 small
    /// elements are stiffer and keep their shape.
    double stiffening = 0.0;
    /// Interior nodes whose positions are given like those of the boundary, such as an interface inside the domain that
    /// a deformation moves (see prescribed_interior_nodes in core/deform). Any order; boundary nodes among them are
    /// ignored.
    std::vector<Index> prescribed_nodes;
    /// Boundary nodes whose positions are not given: they follow as if the mesh went on as its mirror image behind the
    /// boundary, so that only what their neighbours do along the boundary counts (elastic: no forces act on them). Any
    /// order; interior nodes among them are ignored. At least one boundary or prescribed node must be left.
    std::vector<Index> following_nodes;
    SolverChoice solver = SolverChoice::automatic;
    Ordering ordering = Ordering::nested_dissection;
    /// Residual of the linear system, relative to its right-hand side, at which the iterative solver stops.
    double residual_tolerance = 1e-12;
    int max_iterations = 500;
    /// Eliminate the nodes inside an element, which only their own element knows, before the system is solved.
    bool condense = true;
};

/// How a warp went.
struct WarpReport {
    Index interior_nodes = 0;   ///< that followed: without the prescribed ones, with the following ones of the boundary
    Index condensed_nodes = 0;  ///< of them eliminated beforehand
    /// Nodes for which convex weights do not exist (not strictly inside the hull of their neighbours); affine weights
    /// were taken for them.
    std::vector<Index> outside_hull;
    /// Nodes whose neighbours do not span the space (all on a line or plane); least-squares weights were taken.
    std::vector<Index> degenerate;
    SolverChoice solver = SolverChoice::iterative;  ///< the one that gave the result
    std::string solver_note;                        ///< which and why, one sentence
    int iterations = 0;                             ///< largest over the right-hand sides; 0 = direct
    double residual = 0.0;                          ///< largest relative residual over the right-hand sides
    /// weights includes the assembly of the equations, solve the making of the preconditioner or the factorisation.
    double neighbours_seconds = 0.0, weights_seconds = 0.0, solve_seconds = 0.0;
};

/// What a warp returns.
struct WarpResult {
    Coordinates coordinates;
    WarpReport report;
};

/// A mesh made ready to be warped: weights computed, equations set up and factored (or their preconditioner made) once,
/// for any number of boundary positions. The interior's displacement is a linear function of the boundary's. The affine
/// motion that fits the boundary's best is applied to the interior as it is, and the equations are solved for the rest
/// only, so affine motions come out exact whatever the solver's tolerance (with following nodes: translations). Any
/// element shapes, orders 1 to 10; pyramids not with elastic. Immutable; safe to use from several threads at once.
class Warper {
  public:
    /// Throws Unsupported (dimension, neighbours, facets that do not match: require_conforming), InvalidInput
    /// (options), SolverFailure, Cancelled.
    explicit Warper(const CurvedMesh& mesh, const WarpOptions& options = {}, const TaskContext& context = {});
    ~Warper();
    Warper(Warper&&) noexcept;

    const CurvedMesh& mesh() const;
    const WarpOptions& options() const;
    /// Boundary nodes (without following ones) and prescribed interior nodes, ascending: those whose motion is given.
    const std::vector<Index>& given_nodes() const;
    /// What happened in the constructor; nothing is solved yet.
    const WarpReport& setup_report() const;

    /// The mesh after its boundary has moved. boundary_positions: nodes × 3; only the rows of given nodes are read.
    /// 2D meshes must keep the z of their nodes. Throws InvalidInput, SolverFailure, Cancelled.
    WarpResult move(const Coordinates& boundary_positions, const TaskContext& context = {}) const;

    /// The interior's part of a motion, for callers that combine several. displacements: nodes × k, k a multiple of
    /// fields_per_motion(); rows of given nodes are read. Returns nodes × k: their rows unchanged, those of the other
    /// nodes the response, zero for nodes of no element. Throws SolverFailure, Cancelled.
    MultiVector extend(const MultiVector& displacements, SolveReport& report, const TaskContext& context = {}) const;
    /// Columns that depend on each other: 1 where each coordinate moves by itself, the dimension for elastic.
    int fields_per_motion() const;

  private:
    struct Data;
    std::unique_ptr<const Data> data_;
};

/// Moves the interior nodes after the boundary: every interior node keeps the weights by which it is a combination of
/// its neighbours in `mesh` (thesis, chapter 2, Alg. 1). The same as Warper(mesh, options).move(boundary_positions).
WarpResult warp(const CurvedMesh& mesh, const Coordinates& boundary_positions, const WarpOptions& options = {},
                const TaskContext& context = {});

}  // namespace curvewright
