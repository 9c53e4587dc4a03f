#pragma once

#include <array>

#include "ui/tools/tool.h"

namespace curvewright {

/// Handles on the selection: arrows move it along an axis, rings rotate it, boxes scale it, the one in the middle
/// scales all ways. The interior follows. Without a selection a click on the boundary selects what would be dragged.
class TransformTool : public Tool {
    Q_OBJECT

  public:
    TransformTool(const ToolContext& context, QObject* parent);

    void enter() override { refresh(); }
    void leave() override;
    void hover(const std::optional<PointerEvent>& event) override;
    bool press(const PointerEvent& event) override;
    void move(const PointerEvent& event) override;
    void release(const PointerEvent& event) override;
    bool wheel(const PointerEvent& event, double steps) override;
    bool cancel() override;
    void refresh() override;
    QString hint() const override;

  private:
    enum class HandleKind { arrow, ring, box, center };
    struct Handle {
        HandleKind kind;
        int axis = 0;
        bool operator==(const Handle&) const = default;
    };

    std::vector<Handle> handles() const;
    /// Points of a handle around a pivot, mesh coordinates: the two ends of an arrow or a box's stem, a ring, or one.
    std::vector<Eigen::RowVector3d> shape_of(const Handle& handle, const Eigen::RowVector3d& pivot) const;
    std::optional<Handle> handle_at(QPointF position) const;
    /// Where on the ring (radians) or along the axis (mesh units) the mouse is.
    double angle_at(QPointF position) const;
    double place_on_axis(QPointF position, int axis) const;
    AffineMotion motion_of(const PointerEvent& event);
    Eigen::RowVector3d middle_of_selection(const Coordinates& positions) const;
    /// Where the handles are: in the middle of the selection, or as near to it as all of them are in view.
    Eigen::RowVector3d place_of_handles(const Coordinates& positions) const;
    DragRequest make_request() const;
    void show(const Coordinates& positions);

    std::optional<Handle> hovered_;
    std::optional<Index> hovered_node_;  ///< without a selection
    bool is_held_ = false;
    Handle held_{HandleKind::arrow, 0};
    Eigen::RowVector3d pivot_ = Eigen::RowVector3d::Zero();       ///< where the drag began
    Eigen::RowVector3d handles_at_ = Eigen::RowVector3d::Zero();  ///< where they were when the drag began
    double length_ = 1.0;                                         ///< of an arrow then, mesh units
    double start_ = 0.0, value_ = 0.0, last_angle_ = 0.0;         ///< angle or place; value: what is told and named
    QPointF press_;
    IndexSet nodes_;
    DraggedSet dragged_;
};

}  // namespace curvewright
