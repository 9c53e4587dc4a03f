#include "app/cli/untangle_outcome.h"

#include <algorithm>

#include <fmt/format.h>

#include "core/report/parameters.h"
#include "core/untangle/unmended_text.h"

namespace curvewright::cli {
namespace {

Json unmended_json(const MeshTopology& topology, const UntangleRun& run) {
    Json list = Json::array();
    for (const UnmendedElement& element : run.unmended)
        list.push_back({{"element", topology.element_tag(element.element).value},
                        {"reason", element.reason},
                        {"proved", element.is_proved},
                        {"bound", element.bound}});
    return list;
}

std::string passes_text(const UntangleRun& run, double seconds) {
    return fmt::format("{} {} ({}), {:.3f} s", run.passes, run.passes == 1 ? "pass" : "passes", to_string(run.reason),
                       seconds);
}

}  // namespace

Json run_json(const MeshTopology& topology, const UntangleOptions& options, const std::string& warped_first,
              const UntangleRun& run) {
    Json json = {{"method", method_name(options)}};
    if (const auto* guaranteed = std::get_if<GuaranteedOptions>(&options)) {
        json.update(
            {{"rounds", run.rounds}, {"stopped", to_string(run.reason)}, {"unmended", unmended_json(topology, run)}});
        if (!guaranteed->boundary.is_all_fixed())
            json["boundary"] = {{"sliding_nodes", run.sliding_nodes},
                                {"free_nodes", run.free_nodes},
                                {"largest_distance", run.largest_boundary_distance}};
        return json;
    }
    if (const auto* signed_angles = std::get_if<SignedAngleOptions>(&options))
        json["beta"] = signed_angles->beta_choice == BetaChoice::automatic ? Json("auto") : Json(signed_angles->beta);
    if (const auto* unsigned_angles = std::get_if<UnsignedAngleOptions>(&options))
        json["literal"] = !unsigned_angles->is_guarded;
    json.update({{"passes", run.passes}, {"stopped", to_string(run.reason)}});
    if (!warped_first.empty()) json["warped_first"] = warped_first;
    return json;
}

void note_unmended(const MeshTopology& topology, const UntangleRun& run, Work& work) {
    constexpr std::size_t listed = 5;
    for (std::size_t i = 0; i < std::min(listed, run.unmended.size()); ++i)
        work.note(describe(run.unmended[i], topology));
    if (run.unmended.size() > listed)
        work.note(fmt::format("{} more elements are not valid; \"unmended\" of --json lists them all.",
                              run.unmended.size() - listed));
}

std::string run_text(const UntangleOptions& options, const UntangleRun& run, const Json& timings) {
    const auto seconds = [&timings](const char* name) { return timings.value(name, 0.0); };
    const auto* guaranteed = std::get_if<GuaranteedOptions>(&options);
    if (!guaranteed) return passes_text(run, seconds("warp") + seconds("untangle"));
    std::string text =
        fmt::format("guaranteed method: {:.3f} s, then {:.3f} s to improve", seconds("untangle"), seconds("improve"));
    if (!guaranteed->boundary.is_all_fixed())
        text += fmt::format("\nboundary: {} sliding nodes, {} free ones; at most {:.3g} away from the input's",
                            run.sliding_nodes, run.free_nodes, run.largest_boundary_distance);
    return text;
}

}  // namespace curvewright::cli
