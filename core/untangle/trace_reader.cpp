#include "core/untangle/trace_reader.h"

#include <algorithm>
#include <cmath>
#include <istream>
#include <optional>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "core/base/error.h"
#include "core/base/json_depth.h"

namespace curvewright {
namespace {

using Json = nlohmann::json;
namespace event = untangle_event;
using event::Position;

/// Reads the lines of one trace. Messages are given the file and the line by read_trace.
class TraceReader {
  public:
    TraceReader(const CurvedMesh& mesh, UntangleObserver& observer)
        : mesh_(mesh), topology_(mesh.topology()), observer_(observer) {}

    void read(const std::string& line) {
        if (is_json_too_deep(line)) fail(fmt::format("lists stand in each other more than {} deep", deepest_json));
        const Json json = Json::parse(line, nullptr, false);
        if (json.is_discarded() || !json.is_object()) fail("this is no JSON object");
        json_ = &json;
        const std::string name = text("event");
        if (!has_started_) {
            if (name != "started") fail("a trace begins with the event \"started\"");
            return start();
        }
        if (name == "started") fail("the trace starts a second time");
        if (name == "pass_began") return tell(event::PassBegan{integer("pass")});
        if (name == "patch_began") return patch_began();
        if (name == "simplex_step") return simplex_step();
        if (name == "bfgs_step") return bfgs_step();
        if (name == "energy_step") return energy_step();
        if (name == "patch_certified") return patch_certified();
        if (name == "patch_ended") return patch_ended();
        if (name == "face_nodes_moved") return face_nodes_moved();
        if (name == "nodes_placed") return nodes_placed();
        if (name == "pass_ended")
            return tell(event::PassEnded{integer("pass"), number("relative_change"), number("min_scaled_jacobian"),
                                         integer("invalid"), integer("undecided"), nullptr});
        if (name == "finished") return finished();
        fail(fmt::format("\"{}\" is no event of a trace", name));
    }
    bool has_started() const { return has_started_; }

  private:
    [[noreturn]] void fail(const std::string& message) const { throw InvalidInput(message); }

    const Json& value(const char* key) const {
        const auto found = json_->find(key);
        if (found == json_->end()) fail(fmt::format("\"{}\" is missing", key));
        return *found;
    }
    std::string text(const char* key) const {
        const Json& json = value(key);
        if (!json.is_string()) fail(fmt::format("\"{}\" must be a string", key));
        return json.get<std::string>();
    }
    int to_integer(const Json& json, const char* key) const {
        if (!json.is_number_integer() || json.get<double>() < -2147483648.0 || json.get<double>() > 2147483647.0)
            fail(fmt::format("\"{}\" must hold whole numbers", key));
        return json.get<int>();
    }
    int integer(const char* key) const { return to_integer(value(key), key); }
    /// JSON has no numbers that are not finite; the writer puts null in their place.
    double to_number(const Json& json, const char* key) const {
        if (json.is_null()) return std::numeric_limits<double>::quiet_NaN();
        if (!json.is_number()) fail(fmt::format("\"{}\" must hold numbers", key));
        return json.get<double>();
    }
    double number(const char* key) const { return to_number(value(key), key); }
    const Json& array(const char* key, std::size_t size) const {
        const Json& json = value(key);
        if (!json.is_array() || json.size() != size)
            fail(fmt::format("\"{}\" must be an array of {} values", key, size));
        return json;
    }
    template <std::size_t Size>
    std::array<double, Size> numbers(const char* key) const {
        const Json& json = array(key, Size);
        std::array<double, Size> result;
        for (std::size_t i = 0; i < Size; ++i) result[i] = to_number(json[i], key);
        return result;
    }
    /// count: of positions that are expected.
    std::vector<Position> positions(std::size_t count) const {
        const Json& json = array("positions", count);
        std::vector<Position> result(count);
        for (std::size_t i = 0; i < count; ++i) {
            if (!json[i].is_array() || json[i].size() != 3) fail("a position must have three coordinates");
            for (std::size_t d = 0; d < 3; ++d) {
                result[i][d] = to_number(json[i][d], "positions");
                if (!std::isfinite(result[i][d])) fail("a position is not finite");
            }
        }
        return result;
    }
    Index find_node(const Json& tag) const {
        if (!tag.is_number_integer()) fail("tags of nodes must be whole numbers");
        const auto node = topology_.find_node({tag.get<std::int64_t>()});
        if (!node) fail(fmt::format("the mesh has no node {}", tag.get<std::int64_t>()));
        return *node;
    }
    Index find_element(const Json& tag) const {
        if (!tag.is_number_integer()) fail("tags of elements must be whole numbers");
        const auto element = topology_.find_element({tag.get<std::int64_t>()});
        if (!element) fail(fmt::format("the mesh has no element {}", tag.get<std::int64_t>()));
        return *element;
    }
    template <class Find>
    std::vector<Index> indices(const char* key, const Find& find) const {
        const Json& json = value(key);
        if (!json.is_array()) fail(fmt::format("\"{}\" must be an array of tags", key));
        std::vector<Index> result;
        for (const Json& tag : json) result.push_back(find(tag));
        return result;
    }
    std::vector<Index> nodes() const {
        return indices("nodes", [this](const Json& tag) { return find_node(tag); });
    }
    const event::PatchBegan& patch() const {
        if (!patch_) fail("this belongs to a patch, but none has begun");
        return *patch_;
    }
    template <class Event>
    void tell(Event&& event) {
        observer_.on_event(UntangleEvent(std::forward<Event>(event)));
    }

    void start() {
        if (integer("elements") != topology_.element_count() || integer("nodes") != topology_.node_count())
            fail(fmt::format("this is the trace of a mesh of {} elements and {} nodes, not of this one ({} and {})",
                             integer("elements"), integer("nodes"), topology_.element_count(), topology_.node_count()));
        const auto count = static_cast<std::size_t>(topology_.node_count());
        const Json& tags = array("tags", count);
        const std::vector<Position> at = positions(count);
        Coordinates x = mesh_.coordinates();
        for (std::size_t i = 0; i < count; ++i)
            x.row(find_node(tags[i])) = Eigen::RowVector3d(at[i][0], at[i][1], at[i][2]);
        const CurvedMesh start = mesh_.with_coordinates(std::move(x));
        tell(event::Started{&start});
        has_started_ = true;
    }
    void patch_began() {
        if (patch_) fail("a patch begins before the one before it has ended");
        event::PatchBegan e;
        e.nodes = nodes();
        e.elements = indices("elements", [this](const Json& tag) { return find_element(tag); });
        e.positions = positions(e.nodes.size());
        patch_ = e;
        tell(std::move(e));
    }
    void simplex_step() {
        event::SimplexStep e;
        // Traces of earlier versions did not name the node.
        e.node = json_->contains("node") ? find_node(value("node")) : patch().nodes.empty() ? 0 : patch().nodes[0];
        if (std::find(patch().nodes.begin(), patch().nodes.end(), e.node) == patch().nodes.end())
            fail("the node is not one of the patch");
        e.iteration = integer("iteration");
        const Json& simplex = array("simplex", 3);
        for (std::size_t i = 0; i < 3; ++i) {
            if (!simplex[i].is_array() || simplex[i].size() != 2) fail("a vertex of a simplex has two coordinates");
            for (std::size_t d = 0; d < 2; ++d) {
                e.simplex[i][d] = to_number(simplex[i][d], "simplex");
                if (!std::isfinite(e.simplex[i][d])) fail("a vertex of the simplex is not finite");
            }
        }
        e.objective = numbers<3>("objective");
        e.displacement_term = number("displacement_term");
        e.angle_term = number("angle_term");
        e.angles = numbers<4>("angles");
        tell(e);
    }
    void bfgs_step() {
        event::BfgsStep e;
        e.iteration = integer("iteration");
        const Json& edge = value("positions");
        if (!edge.is_array() || edge.size() > patch().nodes.size())
            fail("there are more positions than the patch has nodes");
        e.positions = positions(edge.size());
        e.objective = number("objective");
        e.gradient_norm = number("gradient_norm");
        e.step = number("step");
        e.angles = numbers<4>("angles");
        tell(std::move(e));
    }
    void energy_step() {
        event::EnergyStep e;
        e.round = integer("round");
        e.iteration = integer("iteration");
        e.objective = number("objective");
        e.eps = number("eps");
        e.sharpness = number("sharpness");
        e.least_determinant = number("least_determinant");
        e.positions = positions(patch().nodes.size());
        tell(std::move(e));
    }
    void patch_certified() {
        patch();
        event::PatchCertified e;
        e.round = integer("round");
        e.not_valid = integer("not_valid");
        e.min_scaled_jacobian = number("min_scaled_jacobian");
        e.worst_element = find_element(value("worst_element"));
        e.worst_point = numbers<3>("worst_point");
        tell(e);
    }
    void patch_ended() {
        event::PatchEnded e;
        e.nodes = nodes();
        if (e.nodes != patch().nodes) fail("a patch ends with other nodes than it began with");
        e.positions = positions(e.nodes.size());
        e.iterations = integer("iterations");
        if (json_->contains("beta")) e.beta = number("beta");
        e.objective_before = number("objective_before");
        e.objective_after = number("objective_after");
        e.min_scaled_jacobian_before = number("min_scaled_jacobian_before");
        e.min_scaled_jacobian_after = number("min_scaled_jacobian_after");
        patch_.reset();
        tell(std::move(e));
    }
    void face_nodes_moved() {
        if (patch_) fail("face nodes move before the patch has ended");
        event::FaceNodesMoved e;
        e.nodes = nodes();
        e.positions = positions(e.nodes.size());
        tell(std::move(e));
    }
    void nodes_placed() {
        event::NodesPlaced e;
        const std::string placement = text("placement");
        if (placement == to_string(event::Placement::straightened))
            e.placement = event::Placement::straightened;
        else if (placement != to_string(event::Placement::put_back))
            fail(fmt::format("\"{}\" is no placement of nodes", placement));
        if ((e.placement == event::Placement::straightened) != patch_.has_value())
            fail(patch_ ? "nodes are put back before the patch has ended" : "an edge is straightened outside a patch");
        e.nodes = nodes();
        e.positions = positions(e.nodes.size());
        tell(std::move(e));
    }
    void finished() {
        const std::string reason = text("reason");
        for (const StopReason known : {StopReason::converged, StopReason::untangled, StopReason::pass_limit,
                                       StopReason::no_progress, StopReason::cancelled})
            if (reason == to_string(known)) return tell(event::Finished{known, integer("passes")});
        fail(fmt::format("\"{}\" is no reason to stop", reason));
    }

    const CurvedMesh& mesh_;
    const MeshTopology& topology_;
    UntangleObserver& observer_;
    const Json* json_ = nullptr;
    bool has_started_ = false;
    std::optional<event::PatchBegan> patch_;
};

}  // namespace

void read_trace(std::istream& stream, const std::string& name, const CurvedMesh& mesh, UntangleObserver& observer,
                const TaskContext& context) {
    TraceReader reader(mesh, observer);
    long number = 0;
    for (std::string line; std::getline(stream, line);) {
        context.check();
        ++number;
        const bool is_cut = stream.eof() && reader.has_started();  // no line end: the writer was stopped within it
        try {
            reader.read(line);
        } catch (const InvalidInput& error) {
            if (is_cut) break;
            throw InvalidInput(name, number, std::string(error.what()) + ".");
        }
    }
    if (stream.bad()) throw InvalidInput(name, 0, "the file cannot be read.");
    if (!reader.has_started()) throw InvalidInput(name, 0, "the trace is empty; its first event must be \"started\".");
}

}  // namespace curvewright
