#include "core/report/parameters.h"

#include <fmt/format.h>

namespace curvewright {
namespace {

const char* mode_name(BoundaryMode mode) {
    return mode == BoundaryMode::fixed ? "fixed" : mode == BoundaryMode::slide ? "slide" : "free";
}

std::vector<std::string> rules_of(const BoundaryRules& rules) {
    std::vector<std::string> list{mode_name(rules.otherwise)};
    for (const BoundaryRules::Rule& rule : rules.groups)
        list.push_back(fmt::format("{}={}", rule.group, mode_name(rule.mode)));
    return list;
}

/// Nothing where no node has to stay.
void add_nodes(std::vector<ReportParameter>& list, const NodeRules& rules) {
    if (rules.keeps_vertices) list.push_back({"keep_vertices", true, "only high-order nodes move"});
    if (!rules.fixed_groups.empty()) list.push_back({"fixed_groups", rules.fixed_groups, "groups whose nodes stay"});
    if (!rules.fixed_nodes.empty())
        list.push_back({"fixed_nodes", static_cast<int>(rules.fixed_nodes.size()), "nodes that stay, by tag: so many"});
}

std::vector<ReportParameter> list_of(const GuaranteedOptions& options) {
    return {{"boundary", rules_of(options.boundary), "what boundary nodes may do, for all and by group"},
            {"feature_angle", options.boundary.feature_angle,
             "degrees; facets of a sliding boundary that meet at more have a feature between them"},
            {"improve", options.improves, "raise the least scaled Jacobian once all elements are valid"},
            {"target", options.target, "elements below this scaled Jacobian are improved"},
            {"shape_floor", options.shape_floor, "worst mean ratio that improving may leave; 0 = no floor"},
            {"shape_weight", options.shape_weight, "weight of the shape energy while improving"},
            {"mean_weight", options.mean_weight, "weight of the mean scaled Jacobian while improving"},
            {"improve_work", options.improve_work, "work that improving may take at once, multiplications"},
            {"layers", options.layers, "layers of elements around the damage whose nodes may move, at first"},
            {"max_layers", options.max_layers, "and at most"},
            {"max_rounds", options.max_rounds, "minimisations per patch before it is given up"}};
}

std::vector<ReportParameter> list_of(const SignedAngleOptions& options) {
    const bool is_automatic = options.beta_choice == BetaChoice::automatic;
    const bool is_relative = is_automatic || options.displacement == DisplacementUnit::edge_length;
    return {{"beta", is_automatic ? ReportParameter::Value(std::string("auto")) : ReportParameter::Value(options.beta),
             "weight of the angles against the displacement; auto: the best for every edge"},
            {"length_normalised", is_relative, "displacements are measured in lengths of the edge"},
            {"max_passes", options.max_passes, "passes at most"},
            {"convergence", options.convergence, "relative change of the positions at which the passes end"},
            {"simplex_iterations", options.simplex_iterations, "steps of a Nelder-Mead minimisation at most"},
            {"simplex_tolerance", options.simplex_tolerance, "spread and step at which it ends"},
            {"simplex_size", options.simplex_size, "of its first simplex, in lengths of the edge"},
            {"reject_worse_pass", options.reject_worse_pass, "a pass that lowers the certified quality is taken back"},
            {"target", options.target, "with beta auto: edges of elements that reach it are left alone"}};
}

std::vector<ReportParameter> list_of(const UnsignedAngleOptions& options) {
    const bool is_exact = options.gradient == AngleGradient::exact;
    return {{"gradient", std::string(is_exact ? "exact" : "central differences"), "of the sum of the angles"},
            {"difference_step", options.difference_step, "of the central differences, in lengths of the edge"},
            {"max_passes", options.max_passes, "passes at most"},
            {"first_steps", options.first_steps, "scales of the first quasi-Newton step; the best of them is taken"},
            {"tries_straight_edge", options.tries_straight_edge, "begin from the straight edge as well"},
            {"moves_face_nodes", options.moves_face_nodes, "face nodes follow the curved edges"},
            {"is_guarded", options.is_guarded, "only moves that raise the certified quality are kept"},
            {"target", options.target, "edges with a triangle below this scaled Jacobian are moved"},
            {"gradient_tolerance", options.gradient_tolerance, "|gradient| × edge length at which an edge is done"},
            {"max_iterations", options.max_iterations, "steps of a BFGS minimisation at most"}};
}

/// What a method is called, for programs and for people, and how it works.
struct MethodWords {
    const char *name, *title, *description;
};

MethodWords words_of(const UntangleOptions& options) {
    switch (method_of(options)) {
        case UntangleMethod::guaranteed:
            return {"guaranteed", "Guaranteed method",
                    "Minimises a foldover energy over the nodes near tangled elements until the certificate of every "
                    "element says valid, then raises the least scaled Jacobian. Never returns a worse mesh."};
        case UntangleMethod::signed_angles:
            return {"signed-angle", "Signed angles",
                    "Moves the high-order nodes of every interior edge so that the signed angles at its ends open "
                    "(Nelder-Mead), then the nodes inside the triangles."};
        case UntangleMethod::unsigned_angles:
            return {"unsigned-angle", "Unsigned angles",
                    "Minimises the sum of the unsigned angles at the ends of every edge of a tangled triangle (BFGS)."};
    }
    return {"", "", ""};
}

}  // namespace

std::string method_name(const UntangleOptions& options) {
    return words_of(options).name;
}

std::string method_title(const UntangleOptions& options) {
    return words_of(options).title;
}

std::string method_description(const UntangleOptions& options) {
    return words_of(options).description;
}

std::vector<ReportParameter> parameters_of(const UntangleOptions& options) {
    return std::visit(
        [](const auto& of_method) {
            std::vector<ReportParameter> list = list_of(of_method);
            add_nodes(list, of_method.nodes);
            return list;
        },
        options);
}

}  // namespace curvewright
