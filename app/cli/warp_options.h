#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "app/cli/command.h"
#include "core/warp/incremental.h"

namespace curvewright::cli {

/// What the command line of `warp` says.
struct WarpArguments {
    InputOptions input;
    std::filesystem::path deformation;
    OutputOptions output;
    WarpOptions warp;
    std::optional<int> steps;  ///< --increments: 0 = auto; none: the whole motion at once
    bool keeps_weights = false;
    bool keeps_best = false;
    /// Names of the options given that the chosen weights do not use.
    std::vector<std::string> without_effect;

    /// pre: steps
    IncrementOptions increments() const;
};

/// Adds those that say how the interior follows.
void add_weight_options(CLI::App& command, WarpOptions& options);
/// Adds the options of `warp` but the common ones. arguments must live as long as the command.
void add_warp_options(CLI::App& command, WarpArguments& arguments);

}  // namespace curvewright::cli
