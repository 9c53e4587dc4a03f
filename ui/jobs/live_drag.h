#pragma once

#include <functional>
#include <memory>
#include <optional>

#include <QObject>
#include <QString>

#include "core/edit/drag.h"
#include "ui/document/mesh_document.h"

namespace curvewright {

/// What is taken in hand.
struct DragRequest {
    DraggedSet set;
    ResponseKind kind = ResponseKind::translation;
    Eigen::Vector3d origin = Eigen::Vector3d::Zero();  ///< of rotations and scalings
    QString name;                                      ///< of the step in the history
};

/// A drag of the open mesh, from press to release: weights and response are computed on a thread of its own, frames are
/// made as the hand moves, quality keeps up with them (at once if that is quick, else a little behind), and the end is
/// one step of the history or everything as it was. All members are for the window's thread; none of them takes long.
class LiveDrag : public QObject {
    Q_OBJECT

  public:
    explicit LiveDrag(MeshDocument& document, QObject* parent = nullptr);
    ~LiveDrag() override;

    /// How the interior follows, from the next drag on.
    void set_weights(const WarpOptions& options);
    /// Interior nodes that stay, from the next drag on.
    void set_pinned(const std::vector<Index>& pinned);
    /// What the rest of the boundary does and how a drag ends, from the next drag on.
    void set_rules(const DragRules& rules);
    /// Computes the weights of the open mesh in the background, so that the first drag need not wait for them.
    void prepare();

    /// Not while a job works on the mesh: its result would come on top of what was dragged in the meantime.
    void set_allowed(bool is_allowed);
    bool can_begin() const { return is_allowed_ && !is_active(); }
    bool is_active() const { return phase_ != Phase::idle; }
    /// The response is there: what is seen is live.
    bool is_live() const { return phase_ == Phase::live; }
    /// The hand has let go, and the end is being computed.
    bool is_finishing() const { return phase_ == Phase::finishing; }

    /// Takes hold; nothing happens if that is not allowed. pre: document has a mesh, not active. In the course of a
    /// drag: changes what is in hand; the motion stays.
    void begin(const DragRequest& request);
    void change(const DragRequest& request);
    /// While true no frames are made: whoever shows them is still busy with the last one.
    void hold_frames(bool is_held);
    /// The hand is there now, relative to where it took hold.
    void move(const AffineMotion& motion);
    /// Lets go: the motion becomes a step of the history, unless no node is farther from where it was than rounding
    /// may take it. ended() follows.
    void finish();
    /// Everything back to where it was. ended() follows at once.
    void cancel();

  signals:
    void active_changed(bool is_active);
    void allowed_changed();
    /// What to show: positions, and the quality if there is a newer one (null = not yet). Both live during the call.
    void frame(const Coordinates& positions, const QualityReport* quality);
    /// The drag is over; is_kept: it becomes a step of the history now. Otherwise the document's state is to be shown.
    void ended(bool is_kept);
    void failed(const QString& message);
    /// After ended(): the hand has moved, but at the end nothing has.
    void nothing_moved();
    /// What is being computed, and the fraction of it that is done: before the drag is live, and at its end if that is
    /// more than the last frame. "" = nothing any more.
    void working(const QString& phase, double fraction);

  private:
    enum class Phase { idle, preparing, live, finishing };
    class Worker;

    void set_phase(Phase phase);
    void set_up(const DragRequest& request);
    void receive(std::shared_ptr<Drag> drag);
    void step();
    void certify_behind(const Coordinates& positions);
    void finish_at(const Coordinates& positions);
    void keep(std::shared_ptr<QualityReport> report);
    /// For a task of the worker: tells how far it is.
    TaskContext reporting(const TaskContext& context, int generation);
    /// Ends without a step, and says so if the hand has moved.
    void leave();
    void close(bool is_kept);

    MeshDocument& document_;
    WarpOptions options_;
    std::vector<Index> pinned_;
    DragRules rules_;
    std::unique_ptr<Worker> worker_;

    Phase phase_ = Phase::idle;
    int generation_ = 0;  ///< results of older ones are dropped
    bool is_allowed_ = true, has_moved_ = false, is_held_ = false, is_step_due_ = false, is_certifying_ = false,
         is_newer_ = false, finishes_ = false;
    MeshState start_;
    DragRequest request_;
    std::shared_ptr<Drag> drag_;
    std::shared_ptr<QualityReport> report_;
    AffineMotion motion_;
    DragRules used_rules_;          ///< of the drag that is active
    std::vector<Index> used_pins_;  ///< of the drag that is active
    Coordinates end_;               ///< where it ends, while finishing
    double certify_seconds_ = 0.0;  ///< what the last certification took
};

}  // namespace curvewright
