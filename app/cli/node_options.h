#pragma once

#include <string>
#include <vector>

#include "app/cli/command.h"
#include "core/untangle/node_rules.h"

namespace curvewright::cli {

/// Which nodes have to stay, as given.
struct NodeArguments {
    bool keeps_vertices = false;
    std::vector<std::string> fixed;  ///< files and groups

    /// Throws InvalidInput for what is neither a file nor a group of the mesh, and like read_node_list.
    NodeRules rules(const MeshTopology& topology) const;
};

/// Adds --keep-vertices and --fix-nodes.
void add_node_options(CLI::App& command, NodeArguments& arguments);
/// Adds --keep-best.
CLI::Option* add_keep_best_option(CLI::App& command, bool& keeps_best);

}  // namespace curvewright::cli
