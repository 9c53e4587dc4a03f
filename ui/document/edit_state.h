#pragma once

#include <memory>
#include <optional>

#include <QObject>

#include "core/boundary/boundary_parts.h"
#include "core/edit/drag.h"
#include "core/edit/selection.h"
#include "core/edit/soft_selection.h"
#include "ui/document/mesh_document.h"

namespace curvewright {

/// What a press on the boundary takes hold of when it is not part of the selection.
enum class GrabUnit {
    node,      ///< one node
    side,      ///< the smooth part of the boundary around it, up to the next corners or feature edges
    boundary,  ///< the whole connected boundary
};

/// Where a dragged node may go.
enum class DragDirection { view_plane, along_x, along_y, along_z, along_normal };

/// What the node in hand snaps to.
enum class SnapTarget { nothing, grid, circle, sphere, naca };

struct SnapSettings {
    SnapTarget target = SnapTarget::nothing;
    double grid_spacing = 0.1;       ///< mesh units
    std::array<double, 3> center{};  ///< of circle and sphere; leading edge of the profile
    double radius = 1.0;             ///< of circle and sphere; chord of the profile
    double thickness = 0.12;         ///< of the profile, fraction of the chord
};

/// What a click, box or lasso selects.
enum class SelectWhat {
    boundary_nodes,  ///< and by a click beside them the element there
    nodes,           ///< interior ones too
    elements,
};

struct SelectSettings {
    SelectWhat what = SelectWhat::boundary_nodes;
    bool is_lasso = false;      ///< else a box
    bool sees_through = false;  ///< solids: what the surface hides too
};

/// How a node hangs on its neighbours.
struct Spokes {
    std::optional<Index> node;
    std::vector<Index> neighbours;
    std::vector<double> weights;  ///< sum 1
};

struct EditSettings {
    GrabUnit unit = GrabUnit::node;
    bool is_soft = true;
    SoftSelection soft;  ///< radius 0: chosen from the mesh's size when it is opened
    DragDirection direction = DragDirection::view_plane;
    SnapSettings snap;
    SelectSettings select;
    DragRules rules;  ///< what the rest of the boundary does, and how a drag ends
};

/// What of the settings outlives the program: what a press takes, the soft selection but for its radius, what the
/// select tool selects. Radius, direction and snapping belong to a mesh.
EditSettings load_edit_settings();
void store_edit_settings(const EditSettings& settings);

/// The position that a point snaps to. pre: target is not `nothing`. A point for which the projection is undefined (the
/// centre of the circle) stays.
Eigen::RowVector3d snapped(const SnapSettings& snap, const Eigen::RowVector3d& point);

/// What is selected and pinned in the open mesh, and how the next drag goes. Selection and pins are those of one
/// topology and are emptied when another mesh is opened; they are not part of the history.
class EditState : public QObject {
    Q_OBJECT

  public:
    explicit EditState(MeshDocument& document, QObject* parent = nullptr);

    MeshDocument& document() { return document_; }

    const IndexSet& nodes() const { return nodes_; }        ///< selected
    const IndexSet& elements() const { return elements_; }  ///< selected
    const IndexSet& pins() const { return pins_; }
    const Spokes& spokes() const { return spokes_; }  ///< of the node that is looked at
    const EditSettings& settings() const { return settings_; }

    void select(IndexSet nodes, IndexSet elements);
    void select_nodes(IndexSet nodes) { select(std::move(nodes), {}); }
    void select_elements(IndexSet elements) { select({}, std::move(elements)); }
    void set_pins(IndexSet pins);
    void set_spokes(Spokes spokes);
    void set_settings(const EditSettings& settings);

    void grow();
    void shrink();
    void invert();

    /// Components and smooth parts of the boundary of the present state. pre: document().has_mesh().
    const BoundaryParts& boundary();
    /// What a press on a boundary node takes: the selection if the node is in it, else the unit around it; never pinned
    /// nodes.
    IndexSet taken_by(Index node);
    /// `nodes` and what moves with them under the present settings.
    DraggedSet dragged(const IndexSet& nodes);

  signals:
    void selection_changed();
    void pins_changed();
    void spokes_changed();
    void settings_changed();

  private:
    void start_anew();
    const NodeElements& node_elements();

    MeshDocument& document_;
    IndexSet nodes_, elements_, pins_;
    Spokes spokes_;
    EditSettings settings_;
    std::shared_ptr<const CurvedMesh> parts_mesh_;  ///< that boundary_ was made of
    std::optional<BoundaryParts> boundary_;
    std::optional<NodeElements> node_elements_;
};

}  // namespace curvewright
