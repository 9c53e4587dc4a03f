#pragma once

#include <array>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "core/mesh/curved_mesh.h"

namespace curvewright {

/// A point or a vector, in the mesh's unit of length.
using Vector3 = std::array<double, 3>;

/// x += vector
struct Translate {
    Vector3 vector{};
};
/// Rotation about an axis through the centre.
struct Rotate {
    Vector3 center{};
    double angle_deg = 0.0;  ///< right-handed about the axis
    Vector3 axis{0.0, 0.0, 1.0};
};
/// x = center + factors · (x - center), each coordinate by its own factor.
struct Scale {
    Vector3 center{};
    Vector3 factors{1.0, 1.0, 1.0};
};
/// x_axis += factor * (x_along - origin)
struct Shear {
    int axis = 0, along = 1;  ///< 0, 1, 2 = x, y, z
    double factor = 0.0, origin = 0.0;
};
/// New coordinates as expressions in the old x, y, z; a missing one stays.
struct Expression {
    std::array<std::optional<std::string>, 3> components;
};
/// Radial projection in the xy plane.
struct SnapToCircle {
    Vector3 center{};
    double radius = 1.0;
};
/// Radial projection.
struct SnapToSphere {
    Vector3 center{};
    double radius = 1.0;
};
/// Radial projection onto the cylinder about the axis (a unit vector) through the centre.
struct SnapToCylinder {
    Vector3 center{};
    Vector3 axis{0.0, 0.0, 1.0};
    double radius = 1.0;
};
/// Radial projection about a coordinate axis, at fixed height, onto the profile: height -> radius, piecewise linear.
struct SnapToRevolution {
    int axis = 2;
    std::vector<std::array<double, 2>> profile;  ///< (height, radius), heights ascending
};
/// Closest point in the xy plane.
struct SnapToEllipse {
    Vector3 center{};
    double semi_axis_x = 1.0, semi_axis_y = 1.0;
};
/// Closest point on a symmetric four-digit NACA profile (NACA 0012 by default) with closed trailing edge, chord along
/// +x.
struct SnapToNaca {
    Vector3 leading_edge{};
    double chord = 1.0;
    double thickness = 0.12;  ///< fraction of the chord
};

/// What one operation does.
using OperationKind = std::variant<Translate, Rotate, Scale, Shear, Expression, SnapToCircle, SnapToSphere,
                                   SnapToCylinder, SnapToRevolution, SnapToEllipse, SnapToNaca>;

/// An operation on all nodes of a physical group; "boundary" and "all" are groups, too.
struct Operation {
    std::string group;
    OperationKind kind;
};

/// Applied in order.
struct OperationList {
    std::vector<Operation> operations;
};

/// Final positions of some nodes, by tag.
struct NodeTable {
    /// A node and where it goes.
    struct Row {
        NodeTag tag;
        Vector3 position{};
    };
    std::vector<Row> rows;
    /// Positions that come from a whole mesh: interior nodes are ignored and the boundary must be complete.
    bool is_mesh = false;
};

/// A boundary deformation: what a deformation file says. core/io reads one from a file.
struct Deformation {
    std::variant<OperationList, NodeTable> content;
    std::string source;  ///< file name for messages; may be empty
};

/// New coordinates of all nodes: those that the deformation names move, all others stay where they are.
/// Throws InvalidInput that names the operation (or the node tag) and the group when a group or a node does not exist,
/// an expression is wrong or gives no finite number, or a projection is undefined (node on the centre).
/// fraction: how much of it is done, 0 to 1: a rotation turns by that part of its angle, everything else goes that part
/// of its straight way, operation after operation.
Coordinates apply_deformation(const CurvedMesh& mesh, const Deformation& deformation, double fraction = 1.0);

/// Interior nodes that the deformation places on purpose, ascending: those of the groups of lower dimension than the
/// mesh (an interface inside the domain) that its operations name, and those of a node table. A warp must keep them
/// where the deformation puts them. Operations on "all" or on a group of elements move the interior only as a way to
/// say how the boundary moves. Groups that do not exist are passed over; apply_deformation names them.
std::vector<Index> prescribed_interior_nodes(const CurvedMesh& mesh, const Deformation& deformation);

}  // namespace curvewright
