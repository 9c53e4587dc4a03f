#pragma once

#include <functional>
#include <optional>
#include <vector>

#include <QCursor>
#include <QPointF>
#include <QRectF>
#include <QString>

#include "core/mesh/curved_mesh.h"
#include "ui/palette/marks.h"

namespace curvewright {

/// What a tool needs of the view. Display positions are the view's own pixels, origin top left; points are mesh
/// coordinates.
class Canvas {
  public:
    virtual ~Canvas() = default;

    virtual bool is_flat() const = 0;
    /// The part of the view that nothing covers, in its own pixels.
    virtual QRectF free_area() const = 0;
    virtual QPointF to_display(const Eigen::RowVector3d& point) const = 0;
    /// The point under a display position at the depth of another point (2D: in the mesh's plane).
    virtual Eigen::RowVector3d to_mesh(QPointF position, const Eigen::RowVector3d& at_depth_of) const = 0;
    virtual double units_per_pixel(const Eigen::RowVector3d& at) const = 0;
    /// Columns: right, up, towards the eye.
    virtual Eigen::Matrix3d view_axes() const = 0;

    virtual std::optional<Index> node_at(QPointF position, double radius,
                                         const std::function<bool(Index node)>& accepts) const = 0;
    virtual std::optional<Index> element_at(QPointF position) const = 0;
    /// What shows in a polygon; hidden nodes and elements too if see_through.
    virtual std::vector<Index> nodes_inside(const std::vector<QPointF>& polygon, bool see_through) const = 0;
    virtual std::vector<Index> elements_inside(const std::vector<QPointF>& polygon, bool see_through) const = 0;

    /// Drawn over the mesh until the next call. rubber: an outline in display positions; empty = none.
    virtual void show_marks(Marks marks, const std::vector<QPointF>& rubber) = 0;
    virtual void show_cursor(const QCursor& cursor) = 0;
};

}  // namespace curvewright
