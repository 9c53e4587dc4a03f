#pragma once

#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "core/deform/deformation.h"
#include "core/edit/drag.h"
#include "core/untangle/improve.h"
#include "core/untangle/untangle_options.h"
#include "core/warp/incremental.h"

namespace curvewright {

// What is done to a mesh, as data that can be written, read and done again. Files are named as they were opened.

/// A mesh file is opened; the history begins.
struct OpenAction {
    std::string mesh;
};
/// The boundary moves as a deformation file says; the interior stays.
struct DeformAction {
    std::string deformation;
};
/// The boundary moves as a deformation file says; the interior follows.
struct WarpAction {
    std::string deformation;
    WarpOptions options;
    std::optional<IncrementOptions> increments;
};
/// The mesh is untangled.
struct UntangleAction {
    UntangleOptions options;
};
/// The quality of a valid mesh is raised.
struct ImproveAction {
    ImproveOptions options;
};
/// All elements are numbered the other way round.
struct FlipAction {};
/// Elements that run against their neighbours, and parts that are numbered the other way round, are renumbered, see
/// reorient().
struct ReorientAction {};
/// Nodes follow a hand, the interior follows them, by the weights of the mesh as it was opened (after FlipAction: as it
/// is).
struct DragAction {
    std::vector<NodeTag> nodes;
    std::vector<double> weights;  ///< one per node, or empty for all 1
    std::vector<NodeTag> pinned;  ///< interior nodes that stay
    ResponseKind kind = ResponseKind::translation;
    Vector3 origin{};  ///< that the motion is about
    AffineMotion motion;
    WarpOptions options;
    DragRules rules;
};
/// Nodes are put somewhere: what cannot be computed again, such as an untangling that was stopped.
struct PlaceAction {
    /// A node and where it goes.
    struct Row {
        NodeTag node;
        Vector3 position{};
    };
    std::vector<Row> rows;
};
/// Undo, redo or a jump: so many steps of the history are done now.
struct HistoryAction {
    int step = 0;
};

/// One thing that was done.
using Action = std::variant<OpenAction, DeformAction, WarpAction, UntangleAction, ImproveAction, FlipAction,
                            ReorientAction, DragAction, PlaceAction, HistoryAction>;

/// The nodes that differ, as an action.
PlaceAction place_action(const MeshTopology& topology, const Coordinates& before, const Coordinates& after);

}  // namespace curvewright
