#pragma once

#include <vector>

#include "core/boundary/boundary_shape.h"
#include "core/untangle/distortion.h"

namespace curvewright {

/// Objective of a patch as a function of what its nodes may do: sliding nodes have one or two variables u each, with
/// the position closest point on the boundary to x0 + size T u, everything else has the variables of PatchObjective.
class ConstrainedObjective {
  public:
    /// boundary: null if no node slides. feet: places of the patch's sliding nodes on the boundary, in the order of its
    /// nodes; x: positions.
    ConstrainedObjective(PatchObjective objective, const BoundaryShape* boundary, const Coordinates& x,
                         std::vector<Foot> feet);

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
    };
    Eigen::Vector3d target(const Slide& slide, const Eigen::VectorXd& variables) const;
    Foot foot_of(const Slide& slide, const Eigen::VectorXd& variables) const;
    void expand(const Eigen::VectorXd& variables, Eigen::VectorXd& cartesian) const;

    PatchObjective objective_;
    const BoundaryShape* boundary_;
    int dimension_ = 2;
    std::vector<Slide> slides_;
    /// Positions of the variables that are taken over: (cartesian, variable), one per coordinate.
    std::vector<std::pair<Eigen::Index, Eigen::Index>> others_;
    Eigen::Index variable_count_ = 0;
    Eigen::VectorXd start_, cartesian_, cartesian_gradient_;
};

}  // namespace curvewright
