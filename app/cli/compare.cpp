#include <algorithm>

#include <fmt/format.h>

#include "app/cli/command.h"
#include "app/cli/output.h"
#include "core/quality/mesh_comparison.h"

namespace curvewright::cli {
namespace {

struct Options {
    InputOptions before;
    std::filesystem::path after;
    std::optional<double> tolerance;
};

template <class Tag>
Json tags_json(const std::vector<Tag>& tags) {
    Json list = Json::array();
    for (const Tag& tag : tags) list.push_back(tag.value);
    return list;
}

Json motion_json(const NodeMotion& motion, double size) {
    const auto relative = [size](double distance) { return size > 0.0 ? distance / size : 0.0; };
    return {
        {"nodes", motion.nodes},
        {"moved", motion.moved},
        {"max", motion.max},
        {"mean", motion.mean},
        {"rms", motion.rms},
        {"relative", {{"max", relative(motion.max)}, {"mean", relative(motion.mean)}, {"rms", relative(motion.rms)}}},
        {"farthest", motion.farthest ? Json(motion.farthest->value) : Json()}};
}

Json to_json(const Options& options, const CurvedMesh& before, const CurvedMesh& after, const MeshComparison& found) {
    Json groups = Json::array();
    for (const GroupMotion& group : found.groups) {
        Json json = {{"name", group.name}};
        json.update(motion_json(group.motion, found.size));
        json["nodes_added"] = group.nodes_added;
        json["nodes_removed"] = group.nodes_removed;
        groups.push_back(std::move(json));
    }
    Json quality;
    if (found.quality_before && found.quality_after) {
        quality = {{"before", summary_json(*found.quality_before)},
                   {"after", summary_json(*found.quality_after)},
                   {"became_invalid", tags_json(found.became_invalid)},
                   {"became_valid", tags_json(found.became_valid)},
                   {"most_worsened", Json()}};
        if (const auto& worst = found.most_worsened)
            quality["most_worsened"] = {
                {"element", worst->tag.value}, {"before", worst->before}, {"after", worst->after}};
    }
    return {{"meshes", {mesh_json(options.before.file, before), mesh_json(options.after, after)}},
            {"size", found.size},
            {"motion", motion_json(found.all, found.size)},
            {"boundary", motion_json(found.boundary, found.size)},
            {"interior", motion_json(found.interior, found.size)},
            {"groups", std::move(groups)},
            {"groups_added", found.groups_added},
            {"groups_removed", found.groups_removed},
            {"nodes_added", tags_json(found.nodes_added)},
            {"nodes_removed", tags_json(found.nodes_removed)},
            {"elements",
             {{"added", tags_json(found.elements_added)},
              {"removed", tags_json(found.elements_removed)},
              {"reconnected", tags_json(found.elements_reconnected)},
              {"reclassified", tags_json(found.elements_reclassified)},
              {"moved", tags_json(found.elements_moved)}}},
            {"lower_cells", {{"added", found.lower_cells_added}, {"removed", found.lower_cells_removed}}},
            {"quality", std::move(quality)}};
}

void print_motion(const char* what, const NodeMotion& motion, double size) {
    if (motion.moved == 0) {
        fmt::print("  {:<12} none of {} moved\n", what, motion.nodes);
        return;
    }
    fmt::print("  {:<12} {} of {} moved: max {:.4g} ({:.3g} of the size, node {}), mean {:.4g}, rms {:.4g}\n", what,
               motion.moved, motion.nodes, motion.max, size > 0.0 ? motion.max / size : 0.0, motion.farthest->value,
               motion.mean, motion.rms);
}

template <class Tag>
void print_tags(const char* what, const std::vector<Tag>& tags) {
    if (tags.empty()) return;
    std::string list;
    const std::size_t shown = std::min<std::size_t>(tags.size(), 8);
    for (std::size_t i = 0; i < shown; ++i) list += fmt::format("{}{}", i > 0 ? ", " : "", tags[i].value);
    fmt::print("  {}: {} ({}{})\n", what, tags.size(), list, shown < tags.size() ? ", ..." : "");
}

void print_text(const Options& options, const MeshComparison& found) {
    fmt::print("{} -> {} (size {:.6g})\n", options.before.file.string(), options.after.string(), found.size);
    print_motion("nodes", found.all, found.size);
    print_motion("boundary", found.boundary, found.size);
    print_motion("interior", found.interior, found.size);
    for (const GroupMotion& group : found.groups) {
        if (group.motion.moved > 0)
            fmt::print("  group        {}: {} of {} moved, max {:.4g}\n", group.name, group.motion.moved,
                       group.motion.nodes, group.motion.max);
        if (group.nodes_added + group.nodes_removed > 0)
            fmt::print("  group        {}: {} nodes added, {} removed\n", group.name, group.nodes_added,
                       group.nodes_removed);
    }
    for (const std::string& name : found.groups_added) fmt::print("  group        {} added\n", name);
    for (const std::string& name : found.groups_removed) fmt::print("  group        {} removed\n", name);
    print_tags("nodes added", found.nodes_added);
    print_tags("nodes removed", found.nodes_removed);
    print_tags("elements added", found.elements_added);
    print_tags("elements removed", found.elements_removed);
    print_tags("elements with other nodes", found.elements_reconnected);
    print_tags("elements on another entity", found.elements_reclassified);
    print_tags("elements with nodes that moved", found.elements_moved);
    if (found.lower_cells_added + found.lower_cells_removed > 0)
        fmt::print("  cells of lower dimension: {} added, {} removed\n", found.lower_cells_added,
                   found.lower_cells_removed);
    if (found.quality_before && found.quality_after) {
        fmt::print("  before       {}\n", summary_line(*found.quality_before));
        fmt::print("  after        {}\n", summary_line(*found.quality_after));
        print_tags("became invalid", found.became_invalid);
        print_tags("became valid", found.became_valid);
        // Less than that is rounding.
        if (const auto& worst = found.most_worsened; worst && worst->before - worst->after > 1e-9)
            fmt::print("  most worsened: element {} from {:.4g} to {:.4g}\n", worst->tag.value, worst->before,
                       worst->after);
    }
}

int run(const Options& options, Work& work) {
    InputOptions second = options.before;
    second.file = options.after;
    const ReadResult before = read_input(options.before, work), after = read_input(second, work);
    const MeshComparison found = compare_meshes(before.mesh, after.mesh, work.context());
    work.end_phase("compare");
    int status = exit_done;
    if (options.tolerance && (found.relative_motion() > *options.tolerance || !found.is_structure_equal() ||
                              (*options.tolerance == 0.0 && found.all.moved > 0))) {
        status = exit_less_than_asked;
        work.note(!found.is_structure_equal()
                      ? fmt::format("The meshes differ in more than the places of their nodes.")
                      : fmt::format("The meshes differ by {:.4g} of their size, more than the {:g} that were allowed.",
                                    found.relative_motion(), *options.tolerance));
    }
    if (work.is_json())
        work.print(to_json(options, before.mesh, after.mesh, found));
    else
        print_text(options, found);
    return status;
}

}  // namespace

void add_compare(CLI::App& app, Invocation& invocation) {
    auto* command = add_command(app, invocation, "compare",
                                "How far nodes moved between two states of a mesh, and which elements changed");
    auto options = std::make_shared<Options>();
    add_input_option(*command, options->before, "A");
    command->add_option("other", options->after, "The other mesh, with the same node and element tags")
        ->required()
        ->type_name("B");
    command
        ->add_option("--tolerance", options->tolerance,
                     "Status 4 if a node moved farther than T times A's size, or anything else is different")
        ->check(CLI::NonNegativeNumber)
        ->type_name("T");
    set_action(*command, invocation, options, run);
}

}  // namespace curvewright::cli
