#pragma once

#include <memory>
#include <vector>

#include "core/base/task.h"
#include "core/mesh/curved_mesh.h"
#include "core/warp/warp.h"

namespace curvewright {

/// Nodes that are dragged together, and how much of the motion each takes: 1 = all of it; less at the rim of a soft
/// (proportional) selection. Nodes whose motion is given and that are not named stay where they are.
struct DraggedSet {
    std::vector<Index> nodes;     ///< boundary or prescribed nodes of the warper
    std::vector<double> weights;  ///< one per node, or empty for all 1
};

/// x -> origin + linear (x - origin) + shift: translation, rotation, scaling, shear and what they combine to.
struct AffineMotion {
    Eigen::Matrix3d linear = Eigen::Matrix3d::Identity();
    Eigen::Vector3d shift = Eigen::Vector3d::Zero();

    static AffineMotion translation(const Eigen::Vector3d& vector);
    /// Right-handed about an axis (need not be a unit vector) through the origin of the field; angle in radians.
    static AffineMotion rotation(const Eigen::Vector3d& axis, double angle);
    static AffineMotion scaling(const Eigen::Vector3d& factors);
    /// x_axis += factor · x_along, 0 = x, 1 = y, 2 = z
    static AffineMotion shear(int axis, int along, double factor);
};

/// What motions a field is to serve.
enum class ResponseKind {
    translation,  ///< shift only: the least to solve for and to store
    affine,       ///< any affine motion about the origin
};

/// Boundary nodes that are not dragged but follow what is (see WarpOptions::following_nodes), each as far as it may.
struct BoundaryFollowing {
    /// Made with them as following_nodes, of the same state of the mesh and otherwise the same options as the warper.
    std::shared_ptr<const Warper> warper;
    std::vector<Index> nodes;
    /// One per node, applied to how it would follow: a projection onto the tangents that it keeps to, or the identity.
    std::vector<Eigen::Matrix3d> projections;
};

/// How every node follows the motion of a dragged set. The interior's displacement is a linear function of the
/// boundary's, so one solve at the beginning of a drag (1 right-hand side for translations, dimension + 1 for affine
/// motions; times the dimension for elastic) leaves a few multiplications per node and frame.
class ResponseField {
  public:
    /// origin: the point that rotations, scalings and shears leave in place. Throws InvalidInput for a node that the
    /// warper does not take as given (named) or for a wrong number of weights, SolverFailure, Cancelled.
    ResponseField(const Warper& warper, const DraggedSet& set, ResponseKind kind,
                  const Eigen::Vector3d& origin = Eigen::Vector3d::Zero(), const TaskContext& context = {});
    /// The same for a motion that begins at another state of the mesh than the one that the weights are of. start:
    /// nodes × 3, the positions that apply() will be given.
    /// following: empty if the rest of the boundary stays.
    ResponseField(const Warper& warper, const DraggedSet& set, ResponseKind kind, const Eigen::Vector3d& origin,
                  const Coordinates& start, const TaskContext& context = {}, const BoundaryFollowing& following = {});

    /// One frame: writes start + the response to the motion into the rows of the moving nodes of result; the other rows
    /// stay, so that the array of one frame serves the next. A result of another size becomes a copy of start first.
    /// start: positions when the drag began, nodes × 3, usually those of the warper's mesh. Multi-threaded. 2D meshes
    /// keep their z. Throws InvalidInput for a linear part that the field does not serve, or a wrong number of rows.
    void apply(const AffineMotion& motion, const Coordinates& start, Coordinates& result) const;

    /// Share of the dragged set's translation that a node takes part in (elastic: in direction x of a shift along x).
    double translation_share(Index node) const;
    /// Nodes that move at all, ascending.
    const std::vector<Index>& moving_nodes() const { return moving_; }

  private:
    MultiVector dragged_motions(const Warper& warper, const DraggedSet& set, const Coordinates& start,
                                bool is_vector) const;
    void add_following(const BoundaryFollowing& following, const DraggedSet& set, const Coordinates& start,
                       MultiVector& motions, const TaskContext& context) const;

    int dim_ = 2;
    ResponseKind kind_;
    Eigen::Vector3d origin_;
    bool is_vector_ = false;  ///< elastic, or sliding boundaries: a field per direction of the motion
    Index node_count_ = 0;
    std::vector<Index> moving_;
    /// moving nodes × fields. Scalar: s, then s·(x - origin)_k per direction k. Vector: for each of these and each
    /// direction a of the motion, dimension columns of displacement.
    MultiVector fields_;
};

}  // namespace curvewright
