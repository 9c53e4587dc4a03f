#include "core/session/session_file.h"

#include <algorithm>
#include <cmath>
#include <fstream>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "core/base/error.h"
#include "core/base/json_depth.h"
#include "core/base/overloaded.h"
#include "core/io/atomic_file.h"

namespace curvewright {
namespace {

using Json = nlohmann::ordered_json;

// ---------------------------------------------------------------------------------------------------------- writing

Json weights_json(const WarpOptions& options) {
    return {{"weights", to_string(options.weighting)},
            {"distance_power", options.distance_power},
            {"sharing_power", options.sharing_power},
            {"neighbours", to_string(options.neighbours)},
            {"outside_hull", options.outside_hull == OutsideHull::affine ? "affine" : "refuse"},
            {"poisson_ratio", options.poisson_ratio},
            {"stiffening", options.stiffening},
            {"solver", to_string(options.solver)}};
}

const char* mode_name(BoundaryMode mode) {
    return mode == BoundaryMode::fixed ? "fixed" : mode == BoundaryMode::slide ? "slide" : "free";
}

Json boundary_json(const BoundaryRules& rules) {
    Json boundary = Json::array({mode_name(rules.otherwise)});
    for (const auto& rule : rules.groups) boundary.push_back(fmt::format("{}={}", rule.group, mode_name(rule.mode)));
    return boundary;
}

Json tags_json(const std::vector<NodeTag>& tags) {
    Json list = Json::array();
    for (const NodeTag tag : tags) list.push_back(tag.value);
    return list;
}

/// Nothing where no node has to stay, as before there were such rules.
void add_nodes(Json& json, const NodeRules& rules) {
    if (rules.keeps_vertices) json["keep_vertices"] = true;
    if (!rules.fixed_nodes.empty()) json["fixed_nodes"] = tags_json(rules.fixed_nodes);
    if (!rules.fixed_groups.empty()) json["fixed_groups"] = rules.fixed_groups;
}

Json untangle_json(const GuaranteedOptions& options) {
    return {{"action", "untangle"},
            {"method", "guaranteed"},
            {"improve", options.improves},
            {"target", options.target},
            {"shape_floor", options.shape_floor},
            {"boundary", boundary_json(options.boundary)}};
}

Json improve_json(const ImproveOptions& options) {
    Json json = {{"action", "improve"},
                 {"goal", to_string(options.goal)},
                 {"target", options.target},
                 {"max_move", options.max_move ? Json(*options.max_move) : Json()},
                 {"shape_floor", options.shape_floor},
                 {"boundary", boundary_json(options.boundary)}};
    add_nodes(json, options.nodes);
    return json;
}

Json untangle_json(const SignedAngleOptions& options) {
    const bool is_automatic = options.beta_choice == BetaChoice::automatic;
    return {{"action", "untangle"},
            {"method", "signed-angle"},
            {"beta", is_automatic ? Json("auto") : Json(options.beta)},
            {"length_normalised", options.displacement == DisplacementUnit::edge_length},
            {"max_passes", options.max_passes},
            {"reject_worse_pass", options.reject_worse_pass}};
}

Json untangle_json(const UnsignedAngleOptions& options) {
    return {{"action", "untangle"},
            {"method", "unsigned-angle"},
            {"literal", !options.is_guarded},
            {"max_passes", options.max_passes}};
}

Json to_json(const Action& action) {
    return std::visit(
        Overloaded{[](const OpenAction& its) -> Json {
                       return {{"action", "open"}, {"mesh", its.mesh}};
                   },
                   [](const DeformAction& its) -> Json {
                       return {{"action", "deform"}, {"deformation", its.deformation}};
                   },
                   [](const WarpAction& its) -> Json {
                       Json json = {{"action", "warp"}, {"deformation", its.deformation}};
                       json.update(weights_json(its.options));
                       if (its.increments)
                           json["increments"] = {{"steps", its.increments->steps},
                                                 {"new_weights", its.increments->recomputes_weights},
                                                 {"smallest_step", its.increments->smallest_step}};
                       return json;
                   },
                   [](const UntangleAction& its) -> Json {
                       return std::visit(
                           [](const auto& options) {
                               Json json = untangle_json(options);
                               add_nodes(json, options.nodes);
                               return json;
                           },
                           its.options);
                   },
                   [](const ImproveAction& its) -> Json { return improve_json(its.options); },
                   [](const FlipAction&) -> Json {
                       return {{"action", "flip"}};
                   },
                   [](const ReorientAction&) -> Json {
                       return {{"action", "reorient"}};
                   },
                   [](const DragAction& its) -> Json {
                       const Eigen::Matrix3d& m = its.motion.linear;
                       Json json = {{"action", "drag"}, {"nodes", tags_json(its.nodes)}};
                       if (!its.weights.empty()) json["shares"] = its.weights;
                       if (!its.pinned.empty()) json["pinned"] = tags_json(its.pinned);
                       json["shift"] = {its.motion.shift[0], its.motion.shift[1], its.motion.shift[2]};
                       if (its.kind == ResponseKind::affine) {
                           json["linear"] = {
                               {m(0, 0), m(0, 1), m(0, 2)}, {m(1, 0), m(1, 1), m(1, 2)}, {m(2, 0), m(2, 1), m(2, 2)}};
                           json["origin"] = its.origin;
                       }
                       json.update(weights_json(its.options));
                       if (!its.rules.boundary.is_all_fixed()) json["boundary"] = boundary_json(its.rules.boundary);
                       if (its.rules.solves_anew) json["solves_anew"] = true;
                       return json;
                   },
                   [](const PlaceAction& its) -> Json {
                       Json rows = Json::array();
                       for (const auto& row : its.rows)
                           rows.push_back({row.node.value, row.position[0], row.position[1], row.position[2]});
                       return {{"action", "place"}, {"nodes", std::move(rows)}};
                   },
                   [](const HistoryAction& its) -> Json {
                       return {{"action", "history"}, {"step", its.step}};
                   }},
        action);
}

// ---------------------------------------------------------------------------------------------------------- reading

/// One line. Complaints name the file, the line and the value.
class ActionReader {
  public:
    ActionReader(const Json& json, const std::string& file, long line) : json_(json), file_(file), line_(line) {}

    Action read() const {
        const std::string action = text("action");
        if (action == "open") return OpenAction{text("mesh")};
        if (action == "deform") return DeformAction{text("deformation")};
        if (action == "warp") return read_warp();
        if (action == "untangle") return UntangleAction{read_untangle()};
        if (action == "improve") return ImproveAction{read_improve()};
        if (action == "flip") return FlipAction{};
        if (action == "reorient") return ReorientAction{};
        if (action == "drag") return read_drag();
        if (action == "place") return read_place();
        if (action == "history") return HistoryAction{integer("step", 0, 1 << 30)};
        fail(fmt::format(
            "unknown action \"{}\"; one of open, deform, warp, untangle, improve, flip, reorient, drag, place, history "
            "was expected.",
            action));
    }

  private:
    [[noreturn]] void fail(const std::string& message) const { throw InvalidInput(file_, line_, message); }
    const Json& at(const char* key) const {
        const auto found = json_.find(key);
        if (found == json_.end()) fail(fmt::format("\"{}\" is missing.", key));
        return *found;
    }
    bool has(const char* key) const { return json_.contains(key); }
    std::string text(const char* key) const {
        const Json& value = at(key);
        if (!value.is_string()) fail(fmt::format("\"{}\" must be a text, not {}.", key, brief(value)));
        return value.get<std::string>();
    }
    static std::string brief(const Json& value) {
        const std::string all = value.dump(-1, ' ', true, Json::error_handler_t::replace);
        return all.size() > 60 ? all.substr(0, 57) + "..." : all;
    }
    double number_of(const Json& value, const char* key) const {
        if (!value.is_number()) fail(fmt::format("\"{}\" must be of numbers, not {}.", key, brief(value)));
        const double number = value.get<double>();
        if (!std::isfinite(number)) fail(fmt::format("\"{}\" has a number that is not finite.", key));
        return number;
    }
    double number(const char* key, double otherwise) const { return has(key) ? number_of(at(key), key) : otherwise; }
    int integer(const char* key, int least, int most) const {
        const Json& value = at(key);
        if (!value.is_number_integer() || value.get<std::int64_t>() < least || value.get<std::int64_t>() > most)
            fail(fmt::format("\"{}\" must be a whole number from {} to {}, not {}.", key, least, most, brief(value)));
        return value.get<int>();
    }
    bool flag(const char* key, bool otherwise) const {
        if (!has(key)) return otherwise;
        if (!at(key).is_boolean()) fail(fmt::format("\"{}\" must be true or false, not {}.", key, brief(at(key))));
        return at(key).get<bool>();
    }
    const Json& list(const char* key) const {
        if (!at(key).is_array()) fail(fmt::format("\"{}\" must be a list, not {}.", key, brief(at(key))));
        return at(key);
    }
    Vector3 vector_of(const Json& value, const char* key) const {
        if (!value.is_array() || value.size() != 3)
            fail(fmt::format("\"{}\" must be of three numbers each, not {}.", key, brief(value)));
        return {number_of(value[0], key), number_of(value[1], key), number_of(value[2], key)};
    }
    std::vector<NodeTag> tags(const char* key) const {
        std::vector<NodeTag> result;
        for (const Json& value : list(key)) {
            if (!value.is_number_integer())
                fail(fmt::format("\"{}\" must be of node tags, not {}.", key, brief(value)));
            result.push_back({value.get<std::int64_t>()});
        }
        return result;
    }
    template <class Value>
    Value choice(const char* key, Value otherwise, std::initializer_list<std::pair<const char*, Value>> values) const {
        if (!has(key)) return otherwise;
        const std::string its = text(key);
        std::string all;
        for (const auto& [name, value] : values) {
            if (its == name) return value;
            all += (all.empty() ? "" : ", ") + std::string(name);
        }
        fail(fmt::format("\"{}\" is \"{}\"; one of {} was expected.", key, its, all));
    }

    WarpOptions read_weights() const {
        WarpOptions options;
        const auto entry = [](auto value) { return std::pair<const char*, decltype(value)>(to_string(value), value); };
        options.weighting = choice("weights", options.weighting,
                                   {entry(Weighting::convex), entry(Weighting::affine), entry(Weighting::elastic)});
        options.distance_power = number("distance_power", options.distance_power);
        options.sharing_power = number("sharing_power", options.sharing_power);
        options.neighbours =
            choice("neighbours", options.neighbours,
                   {entry(NeighbourKind::all), entry(NeighbourKind::high_order), entry(NeighbourKind::edge_connected)});
        options.outside_hull =
            choice("outside_hull", options.outside_hull,
                   {std::pair("affine", OutsideHull::affine), std::pair("refuse", OutsideHull::refuse)});
        options.poisson_ratio = number("poisson_ratio", options.poisson_ratio);
        options.stiffening = number("stiffening", options.stiffening);
        options.solver =
            choice("solver", options.solver,
                   {entry(SolverChoice::automatic), entry(SolverChoice::direct), entry(SolverChoice::iterative)});
        return options;
    }
    WarpAction read_warp() const {
        WarpAction action{text("deformation"), read_weights(), {}};
        if (!has("increments")) return action;
        if (!at("increments").is_object()) fail("\"increments\" must be an object.");
        const ActionReader its(at("increments"), file_, line_);
        IncrementOptions& increments = action.increments.emplace();
        increments.steps = its.integer("steps", 0, 100000);
        increments.recomputes_weights = its.flag("new_weights", increments.recomputes_weights);
        increments.smallest_step = its.number("smallest_step", increments.smallest_step);
        return action;
    }
    BoundaryRules read_boundary() const {
        BoundaryRules rules;
        if (!has("boundary")) return rules;
        for (const Json& rule : list("boundary")) {
            if (!rule.is_string()) fail(fmt::format("\"boundary\" must be of texts, not {}.", brief(rule)));
            try {
                rules.add(rule.get<std::string>());
            } catch (const InvalidInput& problem) {
                fail(problem.what());
            }
        }
        return rules;
    }
    NodeRules read_nodes() const {
        NodeRules rules;
        rules.keeps_vertices = flag("keep_vertices", false);
        if (has("fixed_nodes")) rules.fixed_nodes = tags("fixed_nodes");
        if (!has("fixed_groups")) return rules;
        for (const Json& group : list("fixed_groups")) {
            if (!group.is_string()) fail(fmt::format("\"fixed_groups\" must be of names, not {}.", brief(group)));
            rules.fixed_groups.push_back(group.get<std::string>());
        }
        return rules;
    }
    ImproveOptions read_improve() const {
        ImproveOptions options;
        options.goal = choice("goal", options.goal,
                              {std::pair("jacobian", ImproveGoal::jacobian), std::pair("shape", ImproveGoal::shape)});
        options.target = number("target", options.target);
        if (has("max_move") && !at("max_move").is_null()) options.max_move = number_of(at("max_move"), "max_move");
        options.shape_floor = number("shape_floor", options.shape_floor);
        options.boundary = read_boundary();
        options.nodes = read_nodes();
        return options;
    }
    UntangleOptions read_untangle() const {
        UntangleOptions options = read_method();
        std::visit([this](auto& its) { its.nodes = read_nodes(); }, options);
        return options;
    }
    UntangleOptions read_method() const {
        const std::string method = text("method");
        if (method == "guaranteed") {
            GuaranteedOptions options;
            options.improves = flag("improve", options.improves);
            options.target = number("target", options.target);
            options.shape_floor = number("shape_floor", options.shape_floor);
            options.boundary = read_boundary();
            return options;
        }
        if (method == "signed-angle") {
            SignedAngleOptions options;
            const bool is_automatic = at("beta").is_string();
            if (is_automatic && text("beta") != "auto") fail("\"beta\" must be a number or \"auto\".");
            options.beta_choice = is_automatic ? BetaChoice::automatic : BetaChoice::given;
            if (!is_automatic) options.beta = number("beta", options.beta);
            if (flag("length_normalised", false)) options.displacement = DisplacementUnit::edge_length;
            if (has("max_passes")) options.max_passes = integer("max_passes", 1, 1000000);
            options.reject_worse_pass = flag("reject_worse_pass", options.reject_worse_pass);
            return options;
        }
        if (method == "unsigned-angle") {
            UnsignedAngleOptions options =
                flag("literal", false) ? UnsignedAngleOptions::literal() : UnsignedAngleOptions();
            if (has("max_passes")) options.max_passes = integer("max_passes", 1, 1000000);
            return options;
        }
        fail(fmt::format("unknown method \"{}\"; one of guaranteed, signed-angle, unsigned-angle was expected.",
                         method));
    }
    DragAction read_drag() const {
        DragAction action;
        action.nodes = tags("nodes");
        if (has("shares")) {
            for (const Json& share : list("shares")) action.weights.push_back(number_of(share, "shares"));
            if (action.weights.size() != action.nodes.size())
                fail(fmt::format("there are {} nodes and {} shares.", action.nodes.size(), action.weights.size()));
        }
        if (has("pinned")) action.pinned = tags("pinned");
        const Vector3 shift = vector_of(at("shift"), "shift");
        action.motion.shift = {shift[0], shift[1], shift[2]};
        if (has("linear")) {
            action.kind = ResponseKind::affine;
            const Json& rows = list("linear");
            if (rows.size() != 3) fail(fmt::format("\"linear\" must have three rows, not {}.", rows.size()));
            for (int i = 0; i < 3; ++i) {
                const Vector3 row = vector_of(rows[static_cast<std::size_t>(i)], "linear");
                action.motion.linear.row(i) << row[0], row[1], row[2];
            }
            action.origin = vector_of(at("origin"), "origin");
        }
        action.options = read_weights();
        action.rules = {read_boundary(), flag("solves_anew", false)};
        return action;
    }
    PlaceAction read_place() const {
        PlaceAction action;
        for (const Json& row : list("nodes")) {
            if (!row.is_array() || row.size() != 4 || !row[0].is_number_integer())
                fail(fmt::format("\"nodes\" must be of rows [tag, x, y, z], not {}.", brief(row)));
            action.rows.push_back(
                {{row[0].get<std::int64_t>()},
                 {number_of(row[1], "nodes"), number_of(row[2], "nodes"), number_of(row[3], "nodes")}});
        }
        return action;
    }

    const Json& json_;
    const std::string& file_;
    long line_;
};

}  // namespace

std::string to_json_line(const Action& action) {
    return to_json(action).dump(-1, ' ', false, Json::error_handler_t::replace);
}

Action parse_action(std::string_view line, const std::string& file, long line_number) {
    if (is_json_too_deep(line))
        throw InvalidInput(file, line_number,
                           fmt::format("lists stand in each other more than {} deep.", deepest_json));
    Json json;
    try {
        json = Json::parse(line);
    } catch (const Json::exception&) {
        throw InvalidInput(file, line_number, "this is not one whole JSON object; an action on one line was expected.");
    }
    if (!json.is_object()) throw InvalidInput(file, line_number, "an object {\"action\": ...} was expected.");
    return ActionReader(json, file, line_number).read();
}

std::vector<Action> parse_session(std::string_view text, const std::string& file) {
    std::vector<Action> actions;
    long number = 0;
    while (!text.empty()) {
        const std::size_t end = text.find('\n');
        std::string_view line = text.substr(0, end);
        text = end == std::string_view::npos ? std::string_view() : text.substr(end + 1);
        ++number;
        if (line.find_first_not_of(" \t\r") == std::string_view::npos) continue;
        actions.push_back(parse_action(line, file, number));
    }
    if (actions.empty())
        throw InvalidInput(file, 0, "the session is empty; a line {\"action\": \"open\", ...} was expected.");
    return actions;
}

std::vector<Action> read_session(const std::filesystem::path& file) {
    return parse_session(read_text_file(file), file.string());
}

bool is_session_file(const std::filesystem::path& file) {
    std::ifstream stream(file, std::ios::binary);
    // Long enough for the longest name of a mesh file in the line that opens it.
    std::string start(1u << 15, '\0');
    stream.read(start.data(), static_cast<std::streamsize>(start.size()));
    start.resize(static_cast<std::size_t>(std::max<std::streamsize>(0, stream.gcount())));
    const std::size_t begin = start.find_first_not_of(" \t\r\n");
    if (begin == std::string::npos || start[begin] != '{') return false;
    const std::string_view line = std::string_view(start).substr(begin, start.find('\n', begin) - begin);
    const auto names = [line](const char* key) { return line.find(key) != std::string_view::npos; };
    return names("\"action\"") && !names("\"operations\"");
}

void write_session(const std::filesystem::path& file, const std::vector<Action>& actions) {
    std::string text;
    for (const Action& action : actions) text += to_json_line(action) + '\n';
    write_text_file(file, text);
}

}  // namespace curvewright
