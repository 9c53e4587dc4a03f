#pragma once

#include <array>
#include <string>
#include <vector>

namespace curvewright {

/// What a mark in the view says; the view gives it its colour, size and layer.
enum class MarkRole {
    hovered,   ///< would be taken by a click or a drag
    selected,  ///< is in the selection
    soft,      ///< is taken along by its share
    pinned,    ///< stays
    axis_x,
    axis_y,
    axis_z,
    handle,         ///< a handle of no particular axis
    active_handle,  ///< the handle under the mouse or in hand
    spoke,          ///< from a node to a neighbour: its share is the weight
    rubber,         ///< the outline of a box or lasso, in pixels
    ghost,          ///< where something was
    angle,          ///< the arc of an angle
    tangled_angle,  ///< the arc of a negative one
    tangent,        ///< a tangent at the end of a curved edge
    simplex,        ///< of the Nelder-Mead method
    path,           ///< a node's way
    contour,        ///< a line of equal height: its share is the height, 0 .. 1
    outcome,        ///< where another parameter would lead
    worst,          ///< where the Jacobian is least
};

struct MarkPoint {
    std::array<double, 3> at{};  ///< mesh coordinates
    MarkRole role = MarkRole::selected;
    double share = 1.0;  ///< soft: 0 .. 1, tells the colour
};

struct MarkLine {
    /// Mesh coordinates; rubber: device pixels, origin bottom left, third 0.
    std::vector<std::array<double, 3>> points;
    MarkRole role = MarkRole::handle;
    double share = 1.0;  ///< spoke: -1 .. 1
};

/// A short text of constant size, in the middle of its place.
struct MarkText {
    std::array<double, 3> at{};  ///< mesh coordinates
    std::string text;
    MarkRole role = MarkRole::angle;
};

/// What tools draw over the mesh.
struct Marks {
    std::vector<MarkPoint> points;
    std::vector<MarkLine> lines;
    std::vector<MarkText> texts;
    bool is_empty() const { return points.empty() && lines.empty() && texts.empty(); }
};

}  // namespace curvewright
