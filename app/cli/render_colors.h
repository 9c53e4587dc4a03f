#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/cli/command.h"
#include "app/cli/output.h"
#include "ui/scene/coloring.h"

namespace curvewright::cli {

/// What the colours of a picture show.
struct RenderColors {
    std::string quantity = "scaled-jacobian";
    std::optional<ColorMap> map;
    bool is_reversed = false;
    std::vector<double> range;  ///< empty, or lower and upper end
};

/// Adds --color-by, --map, --reverse-map and --range.
void add_color_options(CLI::App& command, RenderColors& colors);

/// Throws InvalidInput that lists what there is if the mesh's file has no such array, and Unsupported if a quantity
/// cannot be computed for its elements.
Coloring find_coloring(const RenderColors& colors, const ReadResult& input, const TaskContext& context);

/// "by", "map", "reversed", "range".
Json colors_json(const RenderColors& colors, const ColorScale& shown);

}  // namespace curvewright::cli
