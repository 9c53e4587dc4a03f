#include "app/cli/node_options.h"

#include <fmt/format.h>

#include "core/base/error.h"
#include "core/io/node_list_file.h"

namespace curvewright::cli {
namespace {

std::string group_list(const MeshTopology& topology) {
    std::string list;
    for (const PhysicalGroup& group : topology.groups())
        list += fmt::format("{}\"{}\"", list.empty() ? "" : ", ", MeshTopology::display_name(group));
    return list.empty() ? "it has none" : "it has " + list;
}

}  // namespace

NodeRules NodeArguments::rules(const MeshTopology& topology) const {
    NodeRules rules;
    rules.keeps_vertices = keeps_vertices;
    for (const std::string& name : fixed) {
        std::error_code error;
        if (std::filesystem::exists(name, error) && !std::filesystem::is_directory(name, error)) {
            const std::vector<NodeTag> tags = read_node_list(name, topology);
            rules.fixed_nodes.insert(rules.fixed_nodes.end(), tags.begin(), tags.end());
        } else if (topology.find_group_nodes(name)) {
            rules.fixed_groups.push_back(name);
        } else {
            throw InvalidInput(
                fmt::format("--fix-nodes {}: there is no file of that name, and the mesh has no such group; {}.", name,
                            group_list(topology)));
        }
    }
    return rules;
}

void add_node_options(CLI::App& command, NodeArguments& arguments) {
    command.add_flag("--keep-vertices", arguments.keeps_vertices,
                     "Corners of elements stay where they are: only high-order nodes move");
    command
        .add_option("--fix-nodes", arguments.fixed,
                    "Nodes that stay where they are: a file with one tag per line (or a table with a column tag), or a "
                    "group; may be given several times")
        ->type_name("FILE|GROUP")
        ->allow_extra_args(false);
}

CLI::Option* add_keep_best_option(CLI::App& command, bool& keeps_best) {
    return command.add_flag("--keep-best", keeps_best,
                            "On Ctrl+C write the best valid mesh so far, if there is one, instead of nothing");
}

}  // namespace curvewright::cli
