#pragma once

#include <array>
#include <optional>
#include <vector>

#include "core/timeline/cursor.h"
#include "core/untangle/untangle_options.h"

namespace curvewright {

/// One of the four angles at the ends of a curved edge that the angle methods work on.
struct AngleMark {
    Index triangle = 0;
    untangle_event::Position corner{};
    Eigen::Vector2d edge_tangent = Eigen::Vector2d::Zero();   ///< unit length, leaves the corner
    Eigen::Vector2d other_tangent = Eigen::Vector2d::Zero();  ///< of the triangle's other edge there
    double signed_angle = 0.0;                                ///< radians; negative: tangled there
};

/// A step of a patch's iteration, for a plot. What the numbers are depends on the method.
struct ConvergencePoint {
    StepNumber step = 0;
    bool begins_anew = false;  ///< another node, attempt or round begins here
    double objective = 0.0;
    /// Signed angles: displacement and angle term. Unsigned: norm of the gradient, 0. Guaranteed: least determinant,
    /// eps.
    double first = 0.0, second = 0.0;
};

/// What there is to say about a step, and to draw.
struct StepExplanation {
    StepNumber step = 0;
    std::optional<UntangleMethod> method;  ///< that the patch's steps are of; none between patches
    std::vector<Index> nodes, elements;    ///< of the patch
    /// The node that is moved (signed angles), the edge's first node (unsigned angles), or the node that moved farthest
    /// in the patch's worst element (guaranteed).
    std::optional<Index> focus;
    /// Where the node in focus was when its iteration began.
    untangle_event::Position focus_start{};
    double edge_length = 0.0;  ///< of the edge in focus (angle methods)
    std::vector<AngleMark> angles;
    std::optional<untangle_event::SimplexStep> simplex;  ///< the last one up to the step
    std::optional<untangle_event::BfgsStep> bfgs;
    std::optional<untangle_event::EnergyStep> energy;  ///< without positions
    std::optional<untangle_event::PatchCertified> certificate;
    std::optional<untangle_event::PatchEnded> end;  ///< without positions
    std::vector<untangle_event::Position> path;     ///< of the node in focus, from the patch's start
    Index worst_element = 0;                        ///< of the patch, at this step
    double worst_scaled_jacobian = 0.0;
    untangle_event::Position worst_point{};     ///< where its J is least
    std::vector<ConvergencePoint> convergence;  ///< the whole patch
};

/// Explains the steps of a recording; what belongs to a whole patch is read once.
class StepExplainer {
  public:
    /// cursor: at the step. Throws InvalidInput if the temporary file cannot be read, Cancelled.
    StepExplanation explain(const TimelineCursor& cursor, const TaskContext& context = {});

  private:
    void read_patch(const TimelineCursor& cursor, std::size_t patch, const TaskContext& context);

    const Recording* recording_ = nullptr;
    std::optional<std::size_t> patch_;
    std::vector<StepEvent> events_;  ///< of the patch; energy steps without positions
    std::vector<ConvergencePoint> convergence_;
};

}  // namespace curvewright
