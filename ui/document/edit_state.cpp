#include "ui/document/edit_state.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/base/error.h"
#include "core/deform/shapes.h"
#include "ui/document/preferences.h"

namespace curvewright {

Eigen::RowVector3d snapped(const SnapSettings& snap, const Eigen::RowVector3d& point) {
    try {
        switch (snap.target) {
            case SnapTarget::nothing:
                break;
            case SnapTarget::grid:
                if (snap.grid_spacing > 0.0)
                    return (point.array() / snap.grid_spacing).round().matrix() * snap.grid_spacing;
                break;
            case SnapTarget::circle:
                return project(SnapToCircle{snap.center, snap.radius}, point);
            case SnapTarget::sphere:
                return project(SnapToSphere{snap.center, snap.radius}, point);
            case SnapTarget::naca:
                return project(SnapToNaca{snap.center, snap.radius, snap.thickness}, point);
        }
    } catch (const InvalidInput&) {
        // Nowhere to project to from here; the mouse will move on.
    }
    return point;
}

EditSettings load_edit_settings() {
    const QSettings stored;
    EditSettings settings;
    const auto read_bool = [&](const QString& key, bool fallback) {
        const QString text = stored.value(key).toString();
        return text == QLatin1String("true") || (fallback && text != QLatin1String("false"));
    };
    settings.unit = read_enum(stored, QStringLiteral("edit/unit"), GrabUnit::boundary, settings.unit);
    settings.is_soft = read_bool(QStringLiteral("edit/is_soft"), settings.is_soft);
    settings.soft.falloff = read_enum(stored, QStringLiteral("edit/falloff"), Falloff::sharp, settings.soft.falloff);
    settings.soft.follows_boundary = read_bool(QStringLiteral("edit/follows_boundary"), settings.soft.follows_boundary);
    settings.select.what =
        read_enum(stored, QStringLiteral("edit/select_what"), SelectWhat::elements, settings.select.what);
    settings.select.is_lasso = read_bool(QStringLiteral("edit/select_lasso"), settings.select.is_lasso);
    settings.select.sees_through = read_bool(QStringLiteral("edit/select_through"), settings.select.sees_through);
    return settings;
}

void store_edit_settings(const EditSettings& settings) {
    QSettings stored;
    stored.setValue(QStringLiteral("edit/unit"), static_cast<int>(settings.unit));
    stored.setValue(QStringLiteral("edit/is_soft"), settings.is_soft);
    stored.setValue(QStringLiteral("edit/falloff"), static_cast<int>(settings.soft.falloff));
    stored.setValue(QStringLiteral("edit/follows_boundary"), settings.soft.follows_boundary);
    stored.setValue(QStringLiteral("edit/select_what"), static_cast<int>(settings.select.what));
    stored.setValue(QStringLiteral("edit/select_lasso"), settings.select.is_lasso);
    stored.setValue(QStringLiteral("edit/select_through"), settings.select.sees_through);
}

EditState::EditState(MeshDocument& document, QObject* parent)
    : QObject(parent), document_(document), settings_(load_edit_settings()) {
    connect(&document, &MeshDocument::opened, this, &EditState::start_anew);
    // Renumbering keeps the nodes and elements where they are in the lists, but not the facets.
    connect(&document, &MeshDocument::state_changed, this, [this] {
        if (parts_mesh_ && document_.has_mesh() &&
            parts_mesh_->shared_topology() != document_.state().mesh->shared_topology())
            boundary_.reset();
    });
}

void EditState::start_anew() {
    nodes_.clear();
    elements_.clear();
    pins_.clear();
    spokes_ = {};
    boundary_.reset();
    node_elements_.reset();
    parts_mesh_.reset();
    if (document_.has_mesh()) {
        const auto box = bounding_box(*document_.state().mesh);
        const double diagonal = (box.row(1) - box.row(0)).norm();
        // Two digits are enough, and easier to read.
        const double rough = diagonal > 0.0 ? 0.01 * Preferences::load().soft_radius_percent * diagonal : 1.0;
        const double unit = std::pow(10.0, std::floor(std::log10(rough)) - 1.0);
        settings_.soft.radius = std::round(rough / unit) * unit;
        settings_.snap = {};
        settings_.snap.grid_spacing = std::pow(10.0, std::round(std::log10(0.05 * std::max(diagonal, 1e-300))));
        const Eigen::RowVector3d middle = 0.5 * (box.row(0) + box.row(1));
        settings_.snap.center = {middle[0], middle[1], middle[2]};
        settings_.snap.radius = 0.5 * (box.row(1) - box.row(0)).maxCoeff();
    }
    emit selection_changed();
    emit pins_changed();
    emit settings_changed();
}

void EditState::select(IndexSet nodes, IndexSet elements) {
    if (nodes == nodes_ && elements == elements_) return;
    nodes_ = std::move(nodes);
    elements_ = std::move(elements);
    emit selection_changed();
}

void EditState::set_pins(IndexSet pins) {
    if (pins == pins_) return;
    pins_ = std::move(pins);
    emit pins_changed();
}

void EditState::set_spokes(Spokes spokes) {
    if (!spokes.node && !spokes_.node) return;
    spokes_ = std::move(spokes);
    emit spokes_changed();
}

void EditState::set_settings(const EditSettings& settings) {
    const bool is_to_be_kept = settings.unit != settings_.unit || settings.is_soft != settings_.is_soft ||
                               settings.soft.falloff != settings_.soft.falloff ||
                               settings.soft.follows_boundary != settings_.soft.follows_boundary ||
                               settings.select.what != settings_.select.what ||
                               settings.select.is_lasso != settings_.select.is_lasso ||
                               settings.select.sees_through != settings_.select.sees_through;
    settings_ = settings;
    if (is_to_be_kept) store_edit_settings(settings_);
    emit settings_changed();
}

const NodeElements& EditState::node_elements() {
    if (!node_elements_) node_elements_ = elements_of_nodes(document_.state().mesh->topology());
    return *node_elements_;
}

void EditState::grow() {
    if (!document_.has_mesh()) return;
    const MeshTopology& topology = document_.state().mesh->topology();
    select(nodes_.empty() ? nodes_ : grown_nodes(topology, node_elements(), nodes_),
           elements_.empty() ? elements_ : grown_elements(topology, node_elements(), elements_));
}

void EditState::shrink() {
    if (!document_.has_mesh()) return;
    const MeshTopology& topology = document_.state().mesh->topology();
    select(nodes_.empty() ? nodes_ : shrunk_nodes(topology, nodes_),
           elements_.empty() ? elements_ : shrunk_elements(topology, node_elements(), elements_));
}

void EditState::invert() {
    if (!document_.has_mesh()) return;
    const MeshTopology& topology = document_.state().mesh->topology();
    // Nothing selected: the opposite is all elements.
    if (nodes_.empty())
        select_elements(inverted_elements(topology, elements_));
    else
        select_nodes(inverted_nodes(topology, nodes_));
}

const BoundaryParts& EditState::boundary() {
    if (!boundary_) {
        parts_mesh_ = document_.state().mesh;
        boundary_.emplace(*parts_mesh_);
    }
    return *boundary_;
}

IndexSet EditState::taken_by(Index node) {
    if (std::binary_search(pins_.begin(), pins_.end(), node)) return {};
    if (std::binary_search(nodes_.begin(), nodes_.end(), node)) return without(nodes_, pins_);
    switch (settings_.unit) {
        case GrabUnit::side:
            return without(boundary().smooth_nodes_around(node), pins_);
        case GrabUnit::boundary:
            return without(boundary().component_nodes_around(node), pins_);
        case GrabUnit::node:
            break;
    }
    return {node};
}

DraggedSet EditState::dragged(const IndexSet& nodes) {
    SoftSelection soft = settings_.soft;
    // A whole boundary in hand moves as it is.
    if (!settings_.is_soft || settings_.unit == GrabUnit::boundary) soft.radius = 0.0;
    const CurvedMesh& mesh = *document_.state().mesh;
    return soft_selection(boundary(), mesh.topology(), mesh.coordinates(), nodes, pins_, soft);
}

}  // namespace curvewright
