#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "core/edit/boundary_followers.h"
#include "core/quality/quality.h"
#include "core/warp/response.h"

namespace curvewright {

/// What happens around the nodes that are dragged.
struct DragRules {
    /// What the rest of the boundary does: stays, slides along itself as it was when the drag began, or follows freely.
    BoundaryRules boundary;
    /// At the end the interior is solved for once more, with weights of the mesh where the drag began. Otherwise it
    /// stays where the weights that it was dragged with put it.
    bool solves_anew = false;
};

/// A drag before it begins.
struct DragSetup {
    DraggedSet set;
    ResponseKind kind = ResponseKind::translation;
    Eigen::Vector3d origin = Eigen::Vector3d::Zero();  ///< that rotations and scalings leave in place
    std::vector<Index> pinned;                         ///< nodes that stay, interior ones too
    WarpOptions options;                               ///< how the interior follows
    DragRules rules;
};

/// Who has the weights of a mesh, or computes them.
using WarperSource = std::function<std::shared_ptr<const Warper>(const CurvedMesh& mesh, const WarpOptions& options)>;

/// A boundary in somebody's hand: a set of nodes follows the motion of the hand, the interior follows the boundary, and
/// the quality of the elements follows both. Setting it up solves for the response once; every frame after that costs a
/// few multiplications per node and the certificates of the elements that move.
class Drag {
  public:
    /// base: the state of the mesh whose weights tell how the interior follows. start: where the motion begins, and its
    /// quality (null: quality is not followed). Throws InvalidInput if they are different meshes, SolverFailure,
    /// Cancelled, and like ResponseField and BoundaryRules.
    Drag(const DragSetup& setup, const CurvedMesh& base, const CurvedMesh& start,
         std::shared_ptr<const QualityReport> start_quality, const WarperSource& warper_of,
         const TaskContext& context = {});
    /// The rest of the boundary stays. warper: of any state of the mesh.
    Drag(std::shared_ptr<const Warper> warper, const DraggedSet& set, ResponseKind kind, const Eigen::Vector3d& origin,
         const CurvedMesh& start, std::shared_ptr<const QualityReport> start_quality, const TaskContext& context = {});

    const CurvedMesh& start() const { return start_; }
    const ResponseField& response() const { return response_; }
    /// Elements that move, ascending.
    const std::vector<Index>& moving_elements() const { return moving_elements_; }

    /// Positions for a motion of the hand from the start. The array lives until the next call. Sliding nodes are on
    /// their boundary; the interior near them follows their way along the tangents.
    const Coordinates& move(const AffineMotion& motion);
    const Coordinates& positions() const { return positions_; }

    /// Whether the end of a motion is more than its last frame.
    bool needs_settling() const { return solves_anew_ || followers_.has_sliding(); }
    /// The end of the motion that move() was called with last: the boundary as it is there, the interior solved for
    /// with all of it. Equal to positions() unless needs_settling(). Does not touch the drag, so that a second thread
    /// may do it. Throws SolverFailure, Cancelled.
    Coordinates settled(const Coordinates& positions, const WarperSource& warper_of,
                        const TaskContext& context = {}) const;

    /// Brings a report up to date for positions of this drag: certifies the elements that move. report: of the start,
    /// or of other positions of this drag. Does not touch the drag, so that a second thread may do it. Throws
    /// Cancelled; the report is to be thrown away then.
    void certify(const Coordinates& positions, QualityReport& report, const TaskContext& context = {}) const;
    /// The report to begin with; null as given.
    const std::shared_ptr<const QualityReport>& start_quality() const { return start_quality_; }

  private:
    Drag(const DragSetup& setup, std::shared_ptr<const Warper> warper, BoundaryFollowers followers,
         const CurvedMesh& start, std::shared_ptr<const QualityReport> start_quality, const WarperSource& warper_of,
         const TaskContext& context);

    CurvedMesh start_;
    std::shared_ptr<const QualityReport> start_quality_;
    std::shared_ptr<const Warper> warper_;  ///< all of the boundary given
    BoundaryFollowers followers_;
    bool solves_anew_ = false;
    ResponseField response_;
    std::vector<Index> moving_elements_;
    Coordinates positions_;
};

/// The options of the weights of a drag: interior nodes that are dragged or pinned are prescribed.
WarpOptions drag_options(WarpOptions options, const MeshTopology& topology, const std::vector<Index>& dragged,
                         const std::vector<Index>& pinned);

}  // namespace curvewright
