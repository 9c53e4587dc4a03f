#include "app/cli/warp_options.h"

#include <charconv>
#include <utility>

#include "app/cli/node_options.h"

namespace curvewright::cli {
namespace {

constexpr int most_increments = 100000;

template <class Value>
CLI::Option* add_choice(CLI::App& command, const std::string& name, Value& value,
                        const std::vector<std::pair<std::string, Value>>& choices, const std::string& description) {
    std::vector<std::string> names;
    for (const auto& choice : choices) names.push_back(choice.first);
    return command
        .add_option_function<std::string>(
            name,
            [&value, choices](const std::string& text) {
                for (const auto& choice : choices)
                    if (choice.first == text) value = choice.second;
            },
            description)
        ->check(CLI::IsMember(names));
}

/// A check that a text is a number for which `is_allowed` holds; `expected` completes "must be".
template <class Predicate>
auto number_that(Predicate is_allowed, const std::string& expected) {
    return [is_allowed, expected](const std::string& text) {
        double value = 0.0;
        const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
        const bool is_number = error == std::errc() && end == text.data() + text.size();
        return is_number && is_allowed(value) ? std::string() : "'" + text + "' must be " + expected;
    };
}

/// "auto" is 0; none for a text that is neither that nor a count.
std::optional<int> read_increments(const std::string& text) {
    if (text == "auto") return 0;
    int count = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), count);
    const bool is_count = error == std::errc() && end == text.data() + text.size();
    return is_count && count >= 1 && count <= most_increments ? std::optional(count) : std::nullopt;
}

}  // namespace

void add_weight_options(CLI::App& command, WarpOptions& options) {
    add_choice<Weighting>(
        command, "--weights", options.weighting,
        {{"convex", Weighting::convex}, {"affine", Weighting::affine}, {"elastic", Weighting::elastic}},
        "convex (default), affine or elastic");
    command
        .add_option(
            "--distance-power", options.distance_power,
            "A neighbour at distance r counts r^-K; with 0 for this and --sharing-power all count alike, as in the "
            "thesis")
        ->type_name("K")
        ->check(number_that([](double value) { return value >= 0.0 && value <= 8.0; }, "a number from 0 to 8"))
        ->capture_default_str();
    command
        .add_option("--sharing-power", options.sharing_power,
                    "A neighbour that shares n elements with the node counts n^K; 0 = all alike")
        ->type_name("K")
        ->check(number_that([](double value) { return value >= -8.0 && value <= 8.0; }, "a number from -8 to 8"))
        ->capture_default_str();
    add_choice<NeighbourKind>(command, "--neighbours", options.neighbours,
                              {{"all", NeighbourKind::all},
                               {"high-order", NeighbourKind::high_order},
                               {"edge", NeighbourKind::edge_connected}},
                              "Which nodes a node is tied to: all of its elements (default), high-order without their "
                              "vertices, or those one edge away");
    add_choice<OutsideHull>(
        command, "--outside-hull", options.outside_hull,
        {{"affine", OutsideHull::affine}, {"fail", OutsideHull::refuse}},
        "A node that has no convex weights, outside the hull of its neighbours: affine weights (default) or fail");
    command
        .add_option("--poisson-ratio", options.poisson_ratio, "Elastic: between -1 and 0.5; near 0.5 keeps the volume")
        ->type_name("NU")
        ->check(number_that([](double value) { return value > -1.0 && value < 0.5; },
                            "a number between -1 and 0.5, both excluded"))
        ->capture_default_str();
    command
        .add_option("--stiffening", options.stiffening,
                    "Elastic: an element of volume V is V^-Q stiff; 0 = all alike, 1 spares small elements")
        ->type_name("Q")
        ->check(number_that([](double value) { return value >= -4.0 && value <= 4.0; }, "a number from -4 to 4"))
        ->capture_default_str();
}

namespace {

void add_solver_options(CLI::App& command, WarpOptions& options) {
    add_choice<SolverChoice>(
        command, "--solver", options.solver,
        {{"auto", SolverChoice::automatic}, {"direct", SolverChoice::direct}, {"iterative", SolverChoice::iterative}},
        "auto (default: iterative, direct if that fails), direct or iterative");
    add_choice<Ordering>(
        command, "--ordering", options.ordering,
        {{"nested-dissection", Ordering::nested_dissection}, {"minimum-degree", Ordering::minimum_degree}},
        "Order of elimination of the direct solver: nested-dissection (default) or minimum-degree");
}

void add_increment_options(CLI::App& command, WarpArguments& arguments) {
    CLI::Option* increments =
        command
            .add_option_function<std::string>(
                "--increments", [&arguments](const std::string& text) { arguments.steps = read_increments(text); },
                "Move the boundary in N equal steps, or auto: as far as goes at once, less where elements tangle. "
                "Stops at the last state without tangled elements")
            ->type_name("N|auto")
            ->check([](const std::string& text) {
                return read_increments(text) ? std::string()
                                             : "'" + text + "' must be a whole number from 1 to " +
                                                   std::to_string(most_increments) + ", or auto";
            });
    command
        .add_flag("--keep-weights", arguments.keeps_weights,
                  "With --increments: the weights of the first mesh for all steps, not new ones at every step")
        ->needs(increments);
    add_keep_best_option(command, arguments.keeps_best)->needs(increments);
}

}  // namespace

IncrementOptions WarpArguments::increments() const {
    IncrementOptions options;
    options.steps = *steps;
    options.recomputes_weights = !keeps_weights;
    options.keeps_best_on_cancel = keeps_best;
    return options;
}

void add_warp_options(CLI::App& command, WarpArguments& arguments) {
    add_input_option(command, arguments.input);
    add_deformation_option(command, arguments.deformation);
    add_output_options(command, arguments.output);
    add_weight_options(command, arguments.warp);
    add_solver_options(command, arguments.warp);
    add_increment_options(command, arguments);
    command.parse_complete_callback([&command, &arguments] {
        const bool is_elastic = arguments.warp.weighting == Weighting::elastic;
        const std::vector<std::string> unused =
            is_elastic
                ? std::vector<std::string>{"--distance-power", "--sharing-power", "--neighbours", "--outside-hull"}
                : std::vector<std::string>{"--poisson-ratio", "--stiffening"};
        for (const std::string& name : unused)
            if (command.count(name) > 0) arguments.without_effect.push_back(name);
    });
}

}  // namespace curvewright::cli
