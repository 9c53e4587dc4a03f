#include "core/untangle/trace.h"

#include <ostream>

#include <nlohmann/json.hpp>

namespace curvewright {
namespace {

using Json = nlohmann::ordered_json;
namespace event = untangle_event;

/// Turns one event into JSON; the topology gives the tags.
struct Describe {
    const MeshTopology& topology;

    Json node(Index index) const { return topology.node_tag(index).value; }

    Json operator()(const event::Started&) const {
        return {{"event", "started"}, {"elements", topology.element_count()}, {"nodes", topology.node_count()}};
    }
    Json operator()(const event::PassBegan& e) const { return {{"event", "pass_began"}, {"pass", e.pass}}; }
    Json operator()(const event::PatchBegan& e) const {
        Json elements = Json::array();
        for (Index element : e.elements) elements.push_back(topology.element_tag(element).value);
        return {{"event", "patch_began"}, {"node", node(e.node)}, {"elements", elements}, {"position", e.position}};
    }
    Json operator()(const event::SimplexStep& e) const {
        return {{"event", "simplex_step"},
                {"iteration", e.iteration},
                {"simplex", e.simplex},
                {"objective", e.objective},
                {"displacement_term", e.displacement_term},
                {"angle_term", e.angle_term},
                {"angles", e.angles}};
    }
    Json operator()(const event::PatchEnded& e) const {
        return {{"event", "patch_ended"},
                {"node", node(e.node)},
                {"iterations", e.iterations},
                {"objective_before", e.objective_before},
                {"objective_after", e.objective_after},
                {"position", e.position},
                {"min_scaled_jacobian_before", e.min_scaled_jacobian_before},
                {"min_scaled_jacobian_after", e.min_scaled_jacobian_after}};
    }
    Json operator()(const event::FaceNodesMoved& e) const {
        Json nodes = Json::array();
        for (Index index : e.nodes) nodes.push_back(node(index));
        return {{"event", "face_nodes_moved"}, {"nodes", nodes}, {"positions", e.positions}};
    }
    Json operator()(const event::PassEnded& e) const {
        return {{"event", "pass_ended"},
                {"pass", e.pass},
                {"relative_change", e.relative_change},
                {"min_scaled_jacobian", e.min_scaled_jacobian},
                {"invalid", e.invalid},
                {"undecided", e.undecided}};
    }
    Json operator()(const event::Finished& e) const {
        return {{"event", "finished"}, {"reason", to_string(e.reason)}, {"passes", e.passes}};
    }
};

}  // namespace

TraceWriter::TraceWriter(std::ostream& stream) : stream_(stream) {}
TraceWriter::~TraceWriter() = default;

void TraceWriter::on_event(const UntangleEvent& event) {
    if (const auto* started = std::get_if<event::Started>(&event)) topology_ = started->mesh->shared_topology();
    stream_ << std::visit(Describe{*topology_}, event).dump(-1, ' ', false, Json::error_handler_t::replace) << '\n';
}

}  // namespace curvewright
