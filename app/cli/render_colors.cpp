#include "app/cli/render_colors.h"

#include <algorithm>

#include <fmt/format.h>

#include "core/base/error.h"
#include "core/quality/element_size.h"
#include "core/quality/shape_quality.h"

namespace curvewright::cli {
namespace {

/// An array by its name, or by NAME:C with a component x, y, z or 1, 2, ...; component -1 = the length of the vectors.
std::pair<const FieldArray*, int> find_array(const std::vector<FieldArray>& fields, const std::string& name) {
    const auto named = [&fields](const std::string& wanted) -> const FieldArray* {
        const auto found =
            std::find_if(fields.begin(), fields.end(), [&](const FieldArray& field) { return field.name == wanted; });
        return found == fields.end() ? nullptr : &*found;
    };
    if (const FieldArray* whole = named(name)) return {whole, -1};
    const std::size_t colon = name.rfind(':');
    if (colon == name.npos) return {nullptr, -1};
    const FieldArray* field = named(name.substr(0, colon));
    if (field == nullptr) return {nullptr, -1};
    const std::string which = name.substr(colon + 1);
    for (int c = 0; c < field->components; ++c)
        if (which == std::to_string(c + 1) || (c < 3 && which == std::string(1, static_cast<char>('x' + c))))
            return {field, c};
    throw InvalidInput(
        fmt::format("The array {} has no component \"{}\"; it has {}.", field->name, which, field->components));
}

}  // namespace

void add_color_options(CLI::App& command, RenderColors& colors) {
    command
        .add_option(
            "--color-by", colors.quantity,
            "scaled-jacobian (default), plain, shape (mean ratio), size, or an array of the file; NAME:x, NAME:2 "
            "= a component instead of the length")
        ->type_name("NAME");
    command
        .add_option_function<std::string>(
            "--map", [&colors](const std::string& name) { colors.map = color_map_of(name); },
            "Map of colours: warm, deep, balance (diverging) or grey")
        ->check(CLI::IsMember({"warm", "deep", "balance", "grey"}));
    command.add_flag("--reverse-map", colors.is_reversed, "Turn the map round");
    command.add_option("--range", colors.range, "Ends of the range (default: that of the numbers; 0 1 of qualities)")
        ->expected(2)
        ->type_name("A B");
}

Coloring find_coloring(const RenderColors& colors, const ReadResult& input, const TaskContext& context) {
    Coloring coloring;
    coloring.map = colors.map.value_or(ColorMap::deep);
    coloring.is_reversed = colors.is_reversed;
    if (!colors.range.empty()) {
        if (!(colors.range[0] < colors.range[1]))
            throw InvalidInput(fmt::format("--range goes from {} to {}; the first number is to be the smaller one.",
                                           colors.range[0], colors.range[1]));
        coloring.lower = colors.range[0];
        coloring.upper = colors.range[1];
    }
    const std::string& by = colors.quantity;
    // An array that has the name of a quantity is not hidden by it.
    const auto [array, component] = find_array(input.fields, by);
    if (array != nullptr) {
        coloring.source = Coloring::Source::array;
        coloring.array = std::make_shared<const FieldArray>(*array);
        coloring.component = component;
        coloring.title = array->name;
        coloring.detail = array->components == 1 ? (array->place == FieldArray::Place::nodes ? "nodes" : "elements")
                          : component < 0        ? "length"
                          : component < 3 && array->components <= 3
                              ? fmt::format("component {}", static_cast<char>('x' + component))
                              : fmt::format("component {}", component + 1);
        return coloring;
    }
    if (by == "scaled-jacobian") {
        coloring.map = colors.map.value_or(ColorMap::warm);
        return coloring;
    }
    if (by == "plain") {
        coloring.source = Coloring::Source::plain;
        return coloring;
    }
    if (by == "shape" || by == "size") {
        auto numbers = std::make_shared<FieldArray>();
        numbers->place = FieldArray::Place::elements;
        coloring.source = Coloring::Source::array;
        if (by == "shape") {
            numbers->values = element_shapes(input.mesh, input.mesh.coordinates(), context);
            coloring.map = colors.map.value_or(ColorMap::warm);
            coloring.lower = coloring.lower.value_or(0.0);
            coloring.upper = coloring.upper.value_or(1.0);
            coloring.title = "Shape";
            coloring.detail = "mean ratio";
        } else {
            const int dim = input.mesh.topology().dimension();
            numbers->values = element_sizes(input.mesh, context);
            coloring.title = dim == 3 ? "Volume" : dim == 2 ? "Area" : "Length";
            coloring.detail = "of elements";
        }
        coloring.array = std::move(numbers);
        return coloring;
    }
    std::string known;
    for (const FieldArray& field : input.fields) known += fmt::format(", {}", field.name);
    throw InvalidInput(
        fmt::format("There is nothing called \"{}\" to colour by; there are scaled-jacobian, plain, shape, "
                    "size{}.",
                    by, known));
}

Json colors_json(const RenderColors& colors, const ColorScale& shown) {
    return {{"by", colors.quantity},
            {"map", to_string(shown.map)},
            {"reversed", shown.is_reversed},
            {"range", {shown.lower, shown.upper}}};
}

}  // namespace curvewright::cli
