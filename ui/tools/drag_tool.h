#pragma once

#include "ui/tools/tool.h"

namespace curvewright {

/// Takes hold of the boundary: press on it, move, let go. The wheel changes the radius of the soft selection, X, Y, Z
/// and N keep to a direction, Esc puts everything back. Beside the boundary the mouse moves the camera.
class DragTool : public Tool {
    Q_OBJECT

  public:
    DragTool(const ToolContext& context, QObject* parent);

    void enter() override { refresh(); }
    void leave() override;
    void hover(const std::optional<PointerEvent>& event) override;
    bool press(const PointerEvent& event) override;
    void move(const PointerEvent& event) override;
    void release(const PointerEvent& event) override;
    bool wheel(const PointerEvent& event, double steps) override;
    bool key(int key, Qt::KeyboardModifiers modifiers) override;
    bool cancel() override;
    void refresh() override;
    QString hint() const override;

    /// The displacement in hand, mesh units; zero if nothing is.
    Eigen::Vector3d displacement() const;

  private:
    DragRequest make_request() const;
    void take(Index node);
    void follow();
    void show(const Coordinates& positions);
    Eigen::RowVector3d constrained(const Eigen::RowVector3d& displacement) const;

    std::optional<Index> hovered_;  ///< node under the mouse
    IndexSet hovered_set_;          ///< what a press would take
    bool is_held_ = false;
    Index held_ = 0;  ///< node in hand
    IndexSet held_set_;
    DraggedSet dragged_;
    Eigen::RowVector3d from_ = Eigen::RowVector3d::Zero();    ///< where the node was
    Eigen::RowVector3d normal_ = Eigen::RowVector3d::Zero();  ///< of the boundary there
    QPointF grip_;                                            ///< from the mouse to the node at the press
    PointerEvent last_;
    std::optional<DragDirection> direction_;  ///< chosen by a key for this drag
    Eigen::RowVector3d displacement_ = Eigen::RowVector3d::Zero();
};

}  // namespace curvewright
