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

    Json nodes(const std::vector<Index>& indices) const {
        Json tags = Json::array();
        for (const Index index : indices) tags.push_back(topology.node_tag(index).value);
        return tags;
    }
    Json elements(const std::vector<Index>& indices) const {
        Json tags = Json::array();
        for (const Index index : indices) tags.push_back(topology.element_tag(index).value);
        return tags;
    }

    Json operator()(const event::Started& e) const {
        Json tags = Json::array(), positions = Json::array();
        const Coordinates& x = e.mesh->coordinates();
        for (Index node = 0; node < topology.node_count(); ++node) {
            tags.push_back(topology.node_tag(node).value);
            positions.push_back({x(node, 0), x(node, 1), x(node, 2)});
        }
        return {{"event", "started"},
                {"elements", topology.element_count()},
                {"nodes", topology.node_count()},
                {"tags", std::move(tags)},
                {"positions", std::move(positions)}};
    }
    Json operator()(const event::PassBegan& e) const { return {{"event", "pass_began"}, {"pass", e.pass}}; }
    Json operator()(const event::PatchBegan& e) const {
        return {{"event", "patch_began"},
                {"nodes", nodes(e.nodes)},
                {"elements", elements(e.elements)},
                {"positions", e.positions}};
    }
    Json operator()(const event::SimplexStep& e) const {
        return {{"event", "simplex_step"},    {"node", topology.node_tag(e.node).value},
                {"iteration", e.iteration},   {"simplex", e.simplex},
                {"objective", e.objective},   {"displacement_term", e.displacement_term},
                {"angle_term", e.angle_term}, {"angles", e.angles}};
    }
    Json operator()(const event::BfgsStep& e) const {
        return {{"event", "bfgs_step"},     {"iteration", e.iteration},         {"positions", e.positions},
                {"objective", e.objective}, {"gradient_norm", e.gradient_norm}, {"step", e.step},
                {"angles", e.angles}};
    }
    Json operator()(const event::EnergyStep& e) const {
        return {{"event", "energy_step"},
                {"round", e.round},
                {"iteration", e.iteration},
                {"objective", e.objective},
                {"eps", e.eps},
                {"sharpness", e.sharpness},
                {"least_determinant", e.least_determinant},
                {"positions", e.positions}};
    }
    Json operator()(const event::PatchCertified& e) const {
        return {{"event", "patch_certified"},
                {"round", e.round},
                {"not_valid", e.not_valid},
                {"min_scaled_jacobian", e.min_scaled_jacobian},
                {"worst_element", topology.element_tag(e.worst_element).value},
                {"worst_point", e.worst_point}};
    }
    Json operator()(const event::PatchEnded& e) const {
        Json json = {{"event", "patch_ended"},
                     {"nodes", nodes(e.nodes)},
                     {"positions", e.positions},
                     {"iterations", e.iterations},
                     {"objective_before", e.objective_before},
                     {"objective_after", e.objective_after},
                     {"min_scaled_jacobian_before", e.min_scaled_jacobian_before},
                     {"min_scaled_jacobian_after", e.min_scaled_jacobian_after}};
        if (e.beta > 0.0) json["beta"] = e.beta;
        return json;
    }
    Json operator()(const event::FaceNodesMoved& e) const {
        return {{"event", "face_nodes_moved"}, {"nodes", nodes(e.nodes)}, {"positions", e.positions}};
    }
    Json operator()(const event::NodesPlaced& e) const {
        return {{"event", "nodes_placed"},
                {"placement", to_string(e.placement)},
                {"nodes", nodes(e.nodes)},
                {"positions", e.positions}};
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
