#pragma once

#include <memory>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "core/mesh/curved_mesh.h"
#include "core/timeline/recording.h"
#include "core/untangle/untangle_options.h"

namespace curvewright {

/// A function on a parallelogram around a point: values(row, column) at
/// center + (2 column / (columns - 1) - 1) across + (2 row / (rows - 1) - 1) up.
struct Landscape {
    Eigen::RowVector3d center, across, up;
    Eigen::MatrixXd values;  ///< infinite where the function has no value
    Eigen::RowVector3d at(double row, double column) const {
        return center + (2.0 * column / static_cast<double>(values.cols() - 1) - 1.0) * across +
               (2.0 * row / static_cast<double>(values.rows() - 1) - 1.0) * up;
    }
};

/// Lines of equal height as polylines of points (row, column). They end at the border only, or are closed (the last
/// point is then the first one).
std::vector<std::vector<Eigen::Vector2d>> contour_lines(const Eigen::MatrixXd& values, double level);
/// Heights that cut the finite values into parts of as many grid points each, ascending. None lies in a plateau, where
/// a contour line would follow the rounding.
std::vector<double> even_levels(const Eigen::MatrixXd& values, int count);

/// The parameters that can be tried out on a patch.
struct TrialParameters {
    double beta = 0.5;         ///< signed angles: weight of the angle term, in (0, 1]
    double first_step = 0.01;  ///< unsigned angles: see UnsignedAngleOptions::first_steps
    double eps = 1e-3;         ///< guaranteed: of the foldover energy, above 0
};

/// What a node in focus would do with other parameters: the method's objective as a function of its position, and where
/// the method's own minimiser leads from where the patch began. Of patches of several nodes the other nodes are where
/// they are in the step looked at; unsigned angles move all nodes of the edge from there.
class PatchTrial {
  public:
    /// mesh: the positions in the step. start: of the focus node at the patch's start (signed angles: what the
    /// displacement is measured from). ideal: nodes × 3, whose straight-sided elements are the ideal (guaranteed).
    /// Throws InvalidInput if an angle method's focus is on no edge between its two elements.
    PatchTrial(const CurvedMesh& mesh, const OrientationSigns& signs, UntangleMethod method, const UntangleOptions& options,
               std::vector<Index> elements, Index focus, const Eigen::RowVector3d& start, const Coordinates& ideal);
    ~PatchTrial();

    double value(const Eigen::RowVector3d& position, const TrialParameters& parameters);
    /// resolution × resolution values.
    Landscape landscape(const Eigen::RowVector3d& center, const Eigen::RowVector3d& across,
                        const Eigen::RowVector3d& up, int resolution, const TrialParameters& parameters,
                        const TaskContext& context = {});

    /// What the method would do with the node in focus.
    struct Outcome {
        Eigen::RowVector3d position;           ///< of the node in focus at the minimum
        std::vector<Eigen::RowVector3d> path;  ///< to it
        double objective = 0.0;
        double min_scaled_jacobian = 0.0;  ///< certified, over the elements of the patch at the focus node
        Index not_valid = 0;
    };
    Outcome outcome(const TrialParameters& parameters);

  private:
    class Objective;
    class SignedAngles;
    class UnsignedAngles;
    class Energy;

    CurvedMesh mesh_;
    OrientationSigns signs_;
    Index focus_;
    std::vector<Index> elements_;  ///< at the focus node
    std::unique_ptr<Objective> objective_;
};

}  // namespace curvewright
