#pragma once

#include <vector>

#include "core/boundary/boundary_shape.h"
#include "core/untangle/distortion.h"

namespace curvewright {

/// How far nodes may go.
struct MoveLimit {
    const Coordinates* read = nullptr;  ///< where the nodes were, nodes × 3
    double distance = 0.0;              ///< from there, mesh units; above 0
};

/// Objective of a patch as a function of what its nodes may do: sliding nodes have one or two variables u each, with
/// the position closest point on the boundary to x0 + size T u, everything else has the variables of PatchObjective.
///
/// With a limit the variables are bent so that no node leaves the ball of that radius around where it was read: free
/// nodes are at x0 + size v / sqrt(1 + |size v|^2 / radius^2). Sliding nodes have u bent likewise, with half of what is
/// left of the radius: the closest point is at most twice as far away as what it is closest to. Both hold up to
/// rounding, and the latter where the closest point was found.
class ConstrainedObjective {
  public:
    /// boundary: null if no node slides. feet: places of the patch's sliding nodes on the boundary, in the order of its
    /// nodes; x: positions, within the limit; limit: null if there is none.
    ConstrainedObjective(PatchObjective objective, const BoundaryShape* boundary, const Coordinates& x,
                         std::vector<Foot> feet, const MoveLimit* limit = nullptr);

    bool has_sliding_nodes() const { return !slides_.empty(); }
    const FreePatch& patch() const { return objective_.patch(); }
    /// Variables of the positions given to the constructor.
    const Eigen::VectorXd& start() const { return start_; }
    /// Lets the sliding nodes' variables begin anew where they are: u = 0, T the tangents there. Does nothing for
    /// patches without them.
    void recentre(Eigen::VectorXd& variables);

    /// See PatchObjective.
    double evaluate(const Eigen::VectorXd& variables, const DistortionOptions& options, Eigen::VectorXd& gradient);
    double least_determinant() const { return objective_.least_determinant(); }
    void add_sample(std::size_t element, const std::array<double, 3>& point) { objective_.add_sample(element, point); }

    /// Writes the free nodes' positions.
    void store(const Eigen::VectorXd& variables, Coordinates& x) const;
    /// Places of the sliding nodes, in the order of the patch's nodes.
    std::vector<Foot> feet(const Eigen::VectorXd& variables) const;

  private:
    using Tangents = Eigen::Matrix<double, 3, Eigen::Dynamic>;
    struct Slide {
        Index node = 0;
        Eigen::Index cartesian = 0, variable = 0;  ///< first ones
        Eigen::Vector3d origin = Eigen::Vector3d::Zero();
        Foot foot;
        Tangents tangents;
        double bend = 0.0;  ///< see Bend
    };
    /// v -> v / sqrt(1 + bend^2 |v|^2): within 1 / bend of zero; 0 = v as it is.
    struct Bend {
        double bend = 0.0, shrink = 1.0;
        Bend(const Eigen::VectorXd& v, double its_bend);
        /// Derivative of the result, times the gradient by it.
        Eigen::VectorXd pull_back(const Eigen::VectorXd& v, const Eigen::VectorXd& gradient) const;
        Eigen::MatrixXd derivative(const Eigen::VectorXd& v) const;
    };
    /// A free node with a limit.
    struct Leash {
        Index node = 0;
        Eigen::Index cartesian = 0, variable = 0;  ///< first ones
        Eigen::Vector3d read = Eigen::Vector3d::Zero();
    };
    double bend_of_slide(const Slide& slide) const;
    Eigen::Vector3d leashed(const Leash& leash, const Eigen::VectorXd& variables) const;
    Eigen::Vector3d target(const Slide& slide, const Eigen::VectorXd& variables) const;
    Foot foot_of(const Slide& slide, const Eigen::VectorXd& variables) const;

    PatchObjective objective_;
    const BoundaryShape* boundary_;
    int dimension_ = 2;
    const MoveLimit* limit_;
    double free_bend_ = 0.0;  ///< of free nodes, in the unit of the variables
    std::vector<Slide> slides_;
    std::vector<Leash> leashes_;
    /// Positions of the variables that are taken over: (cartesian, variable), one per coordinate.
    std::vector<std::pair<Eigen::Index, Eigen::Index>> others_;
    Eigen::Index variable_count_ = 0;
    Eigen::VectorXd start_, cartesian_, cartesian_gradient_;
};

}  // namespace curvewright
