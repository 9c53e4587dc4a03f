#include "core/session/replay.h"

#include <algorithm>

#include <fmt/format.h>

#include "core/base/error.h"
#include "core/base/overloaded.h"
#include "core/io/deformation_file.h"
#include "core/io/matched_mesh.h"
#include "core/mesh/conformity.h"
#include "core/quality/quality.h"
#include "core/untangle/unmended_text.h"

namespace curvewright {
namespace {

Index find_node(const MeshTopology& topology, NodeTag tag) {
    const auto node = topology.find_node(tag);
    if (!node) throw InvalidInput(fmt::format("The mesh has no node {}, which the session names.", tag.value));
    return *node;
}

std::vector<Index> find_nodes(const MeshTopology& topology, const std::vector<NodeTag>& tags) {
    std::vector<Index> nodes;
    for (const NodeTag tag : tags) nodes.push_back(find_node(topology, tag));
    return nodes;
}

Coordinates untangled(const CurvedMesh& mesh, const UntangleOptions& options, const TaskContext& context,
                      std::vector<std::string>* notes) {
    return std::visit(Overloaded{[&](const GuaranteedOptions& its) {
                                     GuaranteedResult result = untangle_guaranteed(mesh, its, nullptr, context);
                                     if (notes)
                                         for (const UnmendedElement& element : result.unmended)
                                             notes->push_back(describe(element, mesh.topology()));
                                     return std::move(result.coordinates);
                                 },
                                 [&](const SignedAngleOptions& its) {
                                     return untangle_signed_angles(mesh, its, nullptr, context).coordinates;
                                 },
                                 [&](const UnsignedAngleOptions& its) {
                                     return untangle_unsigned_angles(mesh, its, nullptr, context).coordinates;
                                 }},
                      options);
}

void add_notes(const WarpReport& report, std::vector<std::string>* notes) {
    if (!notes || report.outside_hull.empty()) return;
    notes->push_back(fmt::format("{} {} outside the hull of the neighbours: affine weights were taken.",
                                 report.outside_hull.size(),
                                 report.outside_hull.size() == 1 ? "node is" : "nodes are"));
}

Coordinates warped(const CurvedMesh& mesh, const WarpAction& action, const Deformation& deformation,
                   const TaskContext& context, std::vector<std::string>* notes) {
    WarpOptions options = action.options;
    options.prescribed_nodes = prescribed_interior_nodes(mesh, deformation);
    if (!action.increments) {
        WarpResult result = warp(mesh, apply_deformation(mesh, deformation), options, context);
        add_notes(result.report, notes);
        return std::move(result.coordinates);
    }
    const BoundaryPath path = [&](double fraction) { return apply_deformation(mesh, deformation, fraction); };
    IncrementalResult result = warp_in_increments(mesh, path, options, *action.increments, context);
    add_notes(result.report, notes);
    if (notes && !result.increments.is_complete()) notes->push_back(describe(result.increments, mesh.topology()));
    return std::move(result.coordinates);
}

Coordinates dragged(const CurvedMesh& mesh, const CurvedMesh& opened, const DragAction& action,
                    const TaskContext& context) {
    const MeshTopology& topology = mesh.topology();
    const CurvedMesh& base = opened.shared_topology() == mesh.shared_topology() ? opened : mesh;
    const DragSetup setup{{find_nodes(topology, action.nodes), action.weights},
                          action.kind,
                          Eigen::Vector3d(action.origin[0], action.origin[1], action.origin[2]),
                          find_nodes(topology, action.pinned),
                          action.options,
                          action.rules};
    const WarperSource warper_of = [&](const CurvedMesh& of, const WarpOptions& options) {
        return std::make_shared<const Warper>(of, options, context);
    };
    Drag drag(setup, base, mesh, nullptr, warper_of, context);
    return drag.settled(drag.move(action.motion), warper_of, context);
}

Coordinates placed(const CurvedMesh& mesh, const PlaceAction& action) {
    Coordinates x = mesh.coordinates();
    for (const PlaceAction::Row& row : action.rows)
        x.row(find_node(mesh.topology(), row.node)) << row.position[0], row.position[1], row.position[2];
    return x;
}

}  // namespace

PlaceAction place_action(const MeshTopology& topology, const Coordinates& before, const Coordinates& after) {
    PlaceAction action;
    for (Index node = 0; node < topology.node_count(); ++node)
        if (before.row(node) != after.row(node))
            action.rows.push_back({topology.node_tag(node), {after(node, 0), after(node, 1), after(node, 2)}});
    return action;
}

CurvedMesh perform(const Action& action, const CurvedMesh& mesh, const CurvedMesh& opened,
                   const std::function<Deformation(const std::string&)>& deformation_of, const TaskContext& context,
                   std::vector<std::string>* notes) {
    return std::visit(
        Overloaded{[&](const DeformAction& its) {
                       require_conforming(mesh, context);
                       return mesh.with_coordinates(apply_deformation(mesh, deformation_of(its.deformation)));
                   },
                   [&](const WarpAction& its) {
                       return mesh.with_coordinates(warped(mesh, its, deformation_of(its.deformation), context, notes));
                   },
                   [&](const UntangleAction& its) {
                       return mesh.with_coordinates(untangled(mesh, its.options, context, notes));
                   },
                   [&](const ImproveAction& its) {
                       return mesh.with_coordinates(improve(mesh, its.options, nullptr, context).coordinates);
                   },
                   [&](const FlipAction&) { return flip_orientation(mesh); },
                   [&](const ReorientAction&) { return reorient(mesh).mesh; },
                   [&](const DragAction& its) { return mesh.with_coordinates(dragged(mesh, opened, its, context)); },
                   [&](const PlaceAction& its) { return mesh.with_coordinates(placed(mesh, its)); },
                   [&](const auto&) -> CurvedMesh {
                       throw InvalidInput(
                           "Opening a mesh and walking through the history are nothing that a mesh can do.");
                   }},
        action);
}

std::filesystem::path Replay::resolve(const std::string& file) const {
    const std::filesystem::path path(file);
    return path.is_absolute() ? path : folder_ / path;
}

void Replay::perform(const Action& action, const TaskContext& context) {
    if (const auto* open = std::get_if<OpenAction>(&action)) {
        ReadResult read = read_matched_mesh(resolve(open->mesh), {}, context);
        history_.assign(1, std::move(read.mesh));
        fields_ = std::move(read.fields);
        notes_ = std::move(read.notes);
        position_ = 0;
        mesh_file_ = open->mesh;
        return;
    }
    if (!has_mesh())
        throw InvalidInput("The session does something before it opens a mesh; \"open\" was expected first.");
    if (const auto* jump = std::get_if<HistoryAction>(&action)) {
        if (jump->step < 0 || static_cast<std::size_t>(jump->step) >= history_.size())
            throw InvalidInput(
                fmt::format("The session goes to step {} of a history of {} steps.", jump->step, history_.size() - 1));
        position_ = static_cast<std::size_t>(jump->step);
        return;
    }
    std::vector<std::string> notes;
    CurvedMesh result = curvewright::perform(
        action, mesh(), opened(), [&](const std::string& file) { return read_deformation(resolve(file), context); },
        context, &notes);
    notes_.insert(notes_.end(), notes.begin(), notes.end());
    history_.erase(history_.begin() + static_cast<std::ptrdiff_t>(position_) + 1, history_.end());
    history_.push_back(std::move(result));
    ++position_;
}

}  // namespace curvewright
