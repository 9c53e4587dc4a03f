#pragma once

#include <QObject>
#include <QPoint>
#include <QTimer>

#include "ui/tools/tool.h"

class QWidget;

namespace curvewright {

/// Moves the selected nodes by keys: Alt + an arrow one step (a spacing of the grid if that is what nodes snap to, else
/// 8 pixels), with Shift ten times as far; the mesh follows. Steps while Alt is held are one step of the history; Esc
/// puts back.
class Nudge : public QObject {
    Q_OBJECT

  public:
    /// view: whose keys are watched; it shows what context.canvas shows.
    Nudge(const ToolContext& context, QWidget* view, QObject* parent);

    /// Right and up in the view: -1, 0 or 1.
    void step(QPoint direction, bool is_large);
    /// Lets go.
    void end();

    bool is_in_hand() const { return is_mine_; }

  signals:
    /// Why nothing moves, or where what moves is now (in the view).
    void refused(const QString& reason);
    void moved_to(QPointF position);

  protected:
    bool eventFilter(QObject* watched, QEvent* event) override;

  private:
    Eigen::Vector3d shift_of(QPoint direction, bool is_large, const Eigen::RowVector3d& middle) const;
    Eigen::RowVector3d middle_of(const IndexSet& nodes) const;

    ToolContext context_;
    QTimer pause_;  ///< lets go if the release of Alt goes unseen
    bool is_mine_ = false, is_ending_ = false;
    Eigen::RowVector3d from_ = Eigen::RowVector3d::Zero();  ///< middle of the nodes at first
    Eigen::Vector3d shift_ = Eigen::Vector3d::Zero();
    /// Steps that came while the last ones were being certified.
    std::vector<std::pair<QPoint, bool>> waiting_;
};

}  // namespace curvewright
