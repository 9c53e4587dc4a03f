#pragma once

#include <memory>

#include "core/quality/quality.h"
#include "core/warp/response.h"

namespace curvewright {

/// A boundary in somebody's hand: a set of nodes follows the motion of the hand, the interior follows the boundary, and
/// the quality of the elements follows both. Setting it up solves for the response once; every frame after that costs a
/// few multiplications per node and the certificates of the elements that move.
class Drag {
  public:
    /// warper: of any state of the mesh, whose weights tell how the interior follows. start: where the motion begins,
    /// and its quality (null: quality is not followed). origin: the point that rotations and scalings leave in place.
    /// Throws InvalidInput if start is another mesh, SolverFailure, Cancelled, and like ResponseField.
    Drag(std::shared_ptr<const Warper> warper, const DraggedSet& set, ResponseKind kind, const Eigen::Vector3d& origin,
         const CurvedMesh& start, std::shared_ptr<const QualityReport> start_quality, const TaskContext& context = {});

    const CurvedMesh& start() const { return start_; }
    const ResponseField& response() const { return response_; }
    /// Elements that move, ascending.
    const std::vector<Index>& moving_elements() const { return moving_elements_; }

    /// Positions for a motion of the hand from the start. The array lives until the next call.
    const Coordinates& move(const AffineMotion& motion);
    const Coordinates& positions() const { return positions_; }

    /// Brings a report up to date for positions of this drag: certifies the elements that move. report: of the start,
    /// or of other positions of this drag. Does not touch the drag, so that a second thread may do it. Throws
    /// Cancelled; the report is to be thrown away then.
    void certify(const Coordinates& positions, QualityReport& report, const TaskContext& context = {}) const;
    /// The report to begin with; null as given.
    const std::shared_ptr<const QualityReport>& start_quality() const { return start_quality_; }

  private:
    CurvedMesh start_;
    std::shared_ptr<const QualityReport> start_quality_;
    ResponseField response_;
    std::vector<Index> moving_elements_;
    Coordinates positions_;
};

}  // namespace curvewright
