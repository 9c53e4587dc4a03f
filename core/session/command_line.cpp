#include <optional>
#include <string>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "core/session/session_file.h"

namespace curvewright {
namespace {

using Json = nlohmann::ordered_json;

/// For a POSIX shell.
std::string quoted(const std::string& word) {
    constexpr std::string_view plain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-./=,:@%+";
    if (!word.empty() && word.find_first_not_of(plain) == std::string::npos) return word;
    std::string result = "'";
    for (const char c : word) result += c == '\'' ? "'\\''" : std::string(1, c);
    return result + "'";
}

std::string replay_line(const std::vector<Action>& actions, const std::string& output) {
    std::string line = fmt::format("curvewright-cli replay - -o {} <<'END'\n", quoted(output));
    for (const Action& action : actions) line += to_json_line(action) + '\n';
    return line + "END\n";
}

std::string number(double value) {
    return Json(value).dump();
}

/// " --keep-vertices --fix-nodes GROUP"; nothing for nodes by tag, which a command takes from a file only.
std::optional<std::string> node_words(const NodeRules& rules) {
    if (!rules.fixed_nodes.empty()) return std::nullopt;
    std::string words = rules.keeps_vertices ? " --keep-vertices" : "";
    for (const std::string& group : rules.fixed_groups) words += " --fix-nodes " + quoted(group);
    return words;
}

std::string boundary_words(const BoundaryRules& rules, const Json& json) {
    std::string words;
    if (!rules.is_all_fixed())
        for (const Json& rule : json["boundary"]) words += " --boundary " + quoted(rule.get<std::string>());
    return words;
}

std::string method_words(const UntangleOptions& untangle, const Json& json) {
    std::string line = " --method " + json["method"].get<std::string>();
    if (const auto* options = std::get_if<GuaranteedOptions>(&untangle)) {
        if (!options->improves)
            line += " --valid-only";
        else if (options->target != GuaranteedOptions().target)  // what is asked for explicitly must be reached
            line += " --target " + number(options->target);
        if (options->shape_floor > 0.0) line += " --shape-floor " + number(options->shape_floor);
        return line + boundary_words(options->boundary, json);
    }
    if (const auto* signed_angles = std::get_if<SignedAngleOptions>(&untangle)) {
        const bool is_automatic = signed_angles->beta_choice == BetaChoice::automatic;
        line += " --beta " + (is_automatic ? std::string("auto") : number(signed_angles->beta));
        if (!is_automatic && signed_angles->displacement == DisplacementUnit::edge_length)
            line += " --length-normalised";
        line += fmt::format(" --max-passes {}", signed_angles->max_passes);
        return line + (signed_angles->reject_worse_pass ? " --reject-worse-pass" : "");
    }
    return line + (json["literal"].get<bool>() ? " --literal" : "") +
           fmt::format(" --max-passes {}", json["max_passes"].get<int>());
}

std::string improve_words(const ImproveOptions& options, const Json& json) {
    std::string line = fmt::format(" --goal {}", to_string(options.goal));
    if (options.target != ImproveOptions().target) line += " --target " + number(options.target);
    if (options.max_move) line += " --max-move " + number(*options.max_move);
    if (options.shape_floor > 0.0) line += " --shape-floor " + number(options.shape_floor);
    return line + boundary_words(options.boundary, json);
}

}  // namespace

std::string command_line(const Action& action, const std::string& input, const std::string& output) {
    const Json json = Json::parse(to_json_line(action));
    std::string line;
    const auto begin = [&](const char* command) {
        line = fmt::format("curvewright-cli {} {} -o {}", command, quoted(input), quoted(output));
    };
    if (const auto* deform = std::get_if<DeformAction>(&action)) {
        begin("deform");
        return line + " --deformation " + quoted(deform->deformation);
    }
    if (const auto* warp = std::get_if<WarpAction>(&action)) {
        const WarpOptions& options = warp->options;
        begin("warp");
        line += " --deformation " + quoted(warp->deformation);
        line += fmt::format(" --weights {}", to_string(options.weighting));
        if (options.weighting == Weighting::elastic) {
            line += fmt::format(" --poisson-ratio {} --stiffening {}", number(options.poisson_ratio),
                                number(options.stiffening));
        } else {
            line +=
                fmt::format(" --distance-power {} --sharing-power {} --neighbours {}", number(options.distance_power),
                            number(options.sharing_power), to_string(options.neighbours));
        }
        line += fmt::format(" --solver {}", to_string(options.solver));
        if (warp->increments) {
            line += warp->increments->steps == 0 ? std::string(" --increments auto")
                                                 : fmt::format(" --increments {}", warp->increments->steps);
            if (!warp->increments->recomputes_weights) line += " --keep-weights";
        }
        return line;
    }
    if (const auto* untangle = std::get_if<UntangleAction>(&action)) {
        const auto nodes = node_words(std::visit([](const auto& its) { return its.nodes; }, untangle->options));
        if (!nodes) return replay_line({OpenAction{input}, action}, output);
        begin("untangle");
        return line + method_words(untangle->options, json) + *nodes;
    }
    if (const auto* improving = std::get_if<ImproveAction>(&action)) {
        const auto nodes = node_words(improving->options.nodes);
        if (!nodes) return replay_line({OpenAction{input}, action}, output);
        begin("improve");
        return line + improve_words(improving->options, json) + *nodes;
    }
    if (std::holds_alternative<OpenAction>(action))
        return fmt::format("curvewright-cli convert {} {}", quoted(input), quoted(output));
    return replay_line({OpenAction{input}, action}, output);
}

std::string command_line(const std::vector<Action>& actions, const std::string& output) {
    const auto* open = actions.empty() ? nullptr : std::get_if<OpenAction>(&actions.front());
    if (open && actions.size() == 1) return command_line(actions.front(), open->mesh, output);
    if (open && actions.size() == 2) return command_line(actions.back(), open->mesh, output);
    return replay_line(actions, output);
}

}  // namespace curvewright
