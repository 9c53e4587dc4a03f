#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "core/base/task.h"
#include "core/mesh/curved_mesh.h"
#include "core/warp/neighbours.h"

namespace curvewright {

/// How the weights of one patch came about.
enum class PatchStatus {
    regular,
    outside_hull,  ///< convex weights asked for, but the node is not strictly inside the hull of its neighbours
    degenerate,    ///< the neighbours do not span the space
};

/// One interior node and its neighbours, as a weighting sees them.
struct Patch {
    Index center;                       ///< the node, in the mesh
    std::span<const Index> neighbours;  ///< in the mesh
    /// neighbours × dimension (2 or 3): their positions minus the node's, in the mesh's unit.
    Eigen::Ref<const Eigen::MatrixXd> offsets;
    /// Per neighbour: how many elements contain it and the node.
    std::span<const std::uint16_t> shared_elements = {};
};

/// A weighting: writes one weight per neighbour of the patch. The warp moves the node by the weighted sum of its
/// neighbours' motions, so the weights are to sum to 1, and sum w_j offset_j is to be 0 if affine motions are to come
/// out exactly. Called from several threads at once.
using WeightFunction = std::function<PatchStatus(const Patch& patch, Eigen::Ref<Eigen::VectorXd> weights)>;

/// base^exponent, quickly for small whole exponents; base > 0.
double real_power(double base, double exponent);

/// How much the neighbours of a patch count against each other; see influences.
struct InfluenceOptions {
    double distance_power = 0.0;
    double sharing_power = 0.0;
};

/// Influence of each neighbour: c_j = |y_j|^-distance_power · n_j^sharing_power, where n_j is the number of elements
/// that the neighbour shares with the node. offsets: neighbours × dimension. Both powers 0 give ones: the thesis's
/// weights. The distance's part is kept within a factor of 1000 of the influence at the mean distance. Mean 1.
Eigen::VectorXd influences(const Eigen::Ref<const Eigen::MatrixXd>& offsets, double distance_power);
/// The same, with the elements that are shared.
Eigen::VectorXd influences(const Patch& patch, const InfluenceOptions& options);

/// Affine weights that minimise sum w_j^2 / c_j; for c = 1 those of least 2-norm (thesis 2.6-2.9): w = C A^T (A C
/// A^T)^-1 b. offsets: neighbours × dimension (2 or 3), neighbour positions minus the node's, in any one unit.
/// influence: c, positive. weights: as many as neighbours; sum 1 and reproduce the node unless the patch is degenerate
/// (then the least-squares answer). The small Gram matrix is factored by Cholesky; a degenerate patch goes to a
/// complete orthogonal decomposition.
PatchStatus affine_weights(const Eigen::Ref<const Eigen::MatrixXd>& offsets,
                           const Eigen::Ref<const Eigen::VectorXd>& influence, Eigen::Ref<Eigen::VectorXd> weights);

/// Convex weights that maximise sum c_j log w_j (thesis 2.14-2.18 for c = 1): positive, sum 1, reproduce the node.
/// Instead of Newton's method on the KKT system (Alg. 3) this solves its dual: w_j = c_j / (n + g·y_j) with y_j the
/// offsets and n = sum c, where g maximises sum c_j log(n + g·y_j), a smooth concave problem in `dimension` unknowns.
/// Newton's method with backtracking converges from g = 0 exactly if the node lies strictly inside the hull; otherwise
/// the status is outside_hull and the weights are not written.
PatchStatus convex_weights(const Eigen::Ref<const Eigen::MatrixXd>& offsets,
                           const Eigen::Ref<const Eigen::VectorXd>& influence, Eigen::Ref<Eigen::VectorXd> weights);

/// The weightings of this library as functions of a patch. Where convex weights do not exist they give affine ones, and
/// the status says so.
WeightFunction convex_weighting(double distance_power, double sharing_power = 0.0);
/// Affine weights; see affine_weights().
WeightFunction affine_weighting(double distance_power, double sharing_power = 0.0);

/// Weights of all free nodes, one per entry of sets.nodes.
struct WeightTable {
    std::vector<double> weights;
    std::vector<PatchStatus> status;  ///< per free node
};
/// mirrors: per node of the mesh a unit normal, or zero, or empty for all zero. The patch of a node with a normal is
/// completed by its mirror image behind the plane through the node; the weight of a neighbour is then what it and its
/// image get together, so that the weights reproduce the node's place along the plane only. Multi-threaded. Throws what
/// the weighting throws, Cancelled.
WeightTable compute_weights(const CurvedMesh& mesh, const NeighbourSets& sets, const WeightFunction& weighting,
                            const TaskContext& context = {}, const Coordinates& mirrors = {});

}  // namespace curvewright
