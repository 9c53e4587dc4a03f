#include "core/timeline/explanation.h"

#include <algorithm>
#include <cmath>

#include "core/basis/lagrange.h"
#include "core/timeline/search.h"
#include "core/untangle/edge_angles.h"

namespace curvewright {
namespace {

namespace event = untangle_event;
using event::Position;

/// The angles of an edge in the present positions.
std::vector<AngleMark> find_angles(const MeshTopology& topology, const Coordinates& x, const InteriorEdge& edge,
                                   const OrientationSigns& signs, double& edge_length) {
    const EdgeTangents tangents(topology, x, edge.triangles, edge.local_edges, {}, signs);
    edge_length = tangents.edge_length;
    const auto nodes = topology.element_nodes(edge.triangles[0]);
    const std::array<Index, 2> ends{nodes[edge.local_edges[0]], nodes[(edge.local_edges[0] + 1) % 3]};
    std::vector<AngleMark> marks;
    for (int i = 0; i < 4; ++i) {
        AngleMark mark;
        mark.triangle = edge.triangles[i / 2];
        mark.corner = position_of(x, ends[i % 2]);
        mark.edge_tangent = tangents.fixed[i % 2].normalized();
        mark.other_tangent = tangents.others[i];
        const double cross = tangents.senses[i] * (mark.edge_tangent[0] * mark.other_tangent[1] -
                                                   mark.edge_tangent[1] * mark.other_tangent[0]);
        mark.signed_angle = std::atan2(cross, mark.edge_tangent.dot(mark.other_tangent));
        marks.push_back(mark);
    }
    return marks;
}

ConvergencePoint point_of(StepNumber step, const StepEvent& read) {
    ConvergencePoint point{step, false, 0.0, 0.0, 0.0};
    if (const auto* simplex = std::get_if<event::SimplexStep>(&read)) {
        point.begins_anew = simplex->iteration == 0;
        point.objective = simplex->objective[0];
        point.first = simplex->displacement_term;
        point.second = simplex->angle_term;
    } else if (const auto* bfgs = std::get_if<event::BfgsStep>(&read)) {
        point.begins_anew = bfgs->iteration == 0;
        point.objective = bfgs->objective;
        point.first = bfgs->gradient_norm;
    } else if (const auto* energy = std::get_if<event::EnergyStep>(&read)) {
        point.begins_anew = energy->iteration == 1;
        point.objective = energy->objective;
        point.first = energy->least_determinant;
        point.second = energy->eps;
    }
    return point;
}

}  // namespace

void StepExplainer::read_patch(const TimelineCursor& cursor, std::size_t number, const TaskContext& context) {
    const Recording& recording = cursor.recording();
    if (recording_ == &recording && patch_ == number) return;
    patch_.reset();
    events_.clear();
    convergence_.clear();
    const RecordedPatch& patch = recording.patches()[number];
    for (StepNumber step = patch.first; step <= patch.last; ++step) {
        context.check();
        StepEvent read = recording.decode(step, &*cursor.patch());
        const StepKind kind = recording.kind(step);
        if (kind == StepKind::simplex_step || kind == StepKind::bfgs_step || kind == StepKind::energy_step)
            convergence_.push_back(point_of(step, read));
        if (auto* energy = std::get_if<event::EnergyStep>(&read)) energy->positions = {};
        if (auto* end = std::get_if<event::PatchEnded>(&read)) end->positions = {};
        events_.push_back(std::move(read));
    }
    recording_ = &recording;
    patch_ = number;
}

StepExplanation StepExplainer::explain(const TimelineCursor& cursor, const TaskContext& context) {
    StepExplanation result;
    result.step = cursor.step();
    const Recording& recording = cursor.recording();
    const auto number = recording.patch_of(cursor.step());
    if (!number || !cursor.patch()) return result;
    read_patch(cursor, *number, context);

    const StepNumber first = recording.patches()[*number].first;
    result.nodes = cursor.patch()->nodes;
    result.elements = cursor.patch()->elements;
    result.convergence = convergence_;
    result.method = UntangleMethod::guaranteed;
    for (const StepEvent& read : events_) {
        if (std::holds_alternative<event::SimplexStep>(read)) result.method = UntangleMethod::signed_angles;
        if (std::holds_alternative<event::BfgsStep>(read)) result.method = UntangleMethod::unsigned_angles;
    }
    for (StepNumber step = first; step <= cursor.step(); ++step) {
        const StepEvent& read = events_[step - first];
        if (const auto* simplex = std::get_if<event::SimplexStep>(&read)) result.simplex = *simplex;
        if (const auto* bfgs = std::get_if<event::BfgsStep>(&read)) result.bfgs = *bfgs;
        if (const auto* energy = std::get_if<event::EnergyStep>(&read)) result.energy = *energy;
        if (const auto* certificate = std::get_if<event::PatchCertified>(&read)) result.certificate = *certificate;
        if (const auto* end = std::get_if<event::PatchEnded>(&read)) result.end = *end;
    }

    const MeshTopology& topology = recording.mesh().topology();
    const Coordinates& x = cursor.coordinates();
    const auto& qualities = cursor.quality().elements;
    result.worst_element = *std::min_element(result.elements.begin(), result.elements.end(), [&](Index a, Index b) {
        return qualities[a].scaled_jacobian < qualities[b].scaled_jacobian;
    });
    const ElementQuality& worst = qualities[result.worst_element];
    result.worst_scaled_jacobian = worst.scaled_jacobian;
    Eigen::MatrixX3d reference(1, 3);
    reference << worst.worst_point[0], worst.worst_point[1], worst.worst_point[2];
    const BasisTable basis = lagrange_basis(topology.element_type(result.worst_element), reference);
    Eigen::RowVector3d at = Eigen::RowVector3d::Zero();
    const auto worst_nodes = topology.element_nodes(result.worst_element);
    for (std::size_t i = 0; i < worst_nodes.size(); ++i)
        at += basis.values(0, static_cast<Eigen::Index>(i)) * x.row(worst_nodes[i]);
    result.worst_point = {at[0], at[1], at[2]};

    if (*result.method == UntangleMethod::guaranteed) {
        double farthest = -1.0;
        for (std::size_t i = 0; i < result.nodes.size(); ++i) {
            const Index node = result.nodes[i];
            if (std::find(worst_nodes.begin(), worst_nodes.end(), node) == worst_nodes.end()) continue;
            const auto& start = cursor.patch()->positions[i];
            const double distance = (x.row(node) - Eigen::RowVector3d(start[0], start[1], start[2])).norm();
            if (distance <= farthest) continue;
            farthest = distance;
            result.focus = node;
        }
        if (!result.focus && !result.nodes.empty()) result.focus = result.nodes[0];
    } else if (!result.nodes.empty()) {
        result.focus = result.simplex ? result.simplex->node : result.nodes[0];
        if (result.elements.size() == 2)
            if (const auto edge = find_interior_edge(topology, {result.elements[0], result.elements[1]}, *result.focus))
                result.angles = find_angles(topology, x, *edge, cursor.quality().orientation_sign, result.edge_length);
    }
    if (!result.focus) return result;
    result.path = node_path(recording, *result.focus, cursor.step());
    result.focus_start = result.path.front();
    for (StepNumber step = first; step <= cursor.step(); ++step)
        if (const auto* placed = std::get_if<event::NodesPlaced>(&events_[step - first]))
            for (std::size_t i = 0; i < placed->nodes.size(); ++i)
                if (placed->nodes[i] == *result.focus) result.focus_start = placed->positions[i];
    return result;
}

}  // namespace curvewright
