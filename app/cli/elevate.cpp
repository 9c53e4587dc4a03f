#include "core/mesh/elevate.h"

#include <fmt/format.h>

#include "app/cli/command.h"
#include "app/cli/output.h"

namespace curvewright::cli {
namespace {

struct Options {
    InputOptions input;
    int order = 0;
    bool straight = false;
    OutputOptions output;
};

/// Null where the geometry is the same.
Json distance_json(const ElevateResult& result, const CurvedMesh& input, Work& work) {
    if (!result.distance) return Json();
    const GeometryDistance& distance = *result.distance;
    const std::int64_t element = input.topology().element_tag(distance.element).value;
    if (distance.absolute > 0.0)
        work.note(
            fmt::format("The elements lie up to {:.4g} ({:.3g} of the mesh's size) from where they were, element "
                        "{} the farthest, as measured at samples.",
                        distance.absolute, distance.relative, element));
    if (distance.unmeasured > 0)
        work.note(
            fmt::format("{} above order 1 could not be measured.", counted_name(Shape::pyramid, distance.unmeasured)));
    return {{"absolute", distance.absolute}, {"relative", distance.relative}, {"element", element}};
}

void note_labels(const std::vector<FieldArray>& fields, Work& work) {
    std::string names;
    for (const FieldArray& field : fields)
        if (field.place == FieldArray::Place::nodes && field.is_integer)
            names += (names.empty() ? "" : ", ") + field.name;
    if (!names.empty())
        work.note(
            fmt::format("Arrays of integers are not interpolated; new nodes have the values of the nearest old "
                        "ones: {}.",
                        names));
}

int run(const Options& options, Work& work) {
    check_output(options.output);
    const ReadResult input = read_input(options.input, work);
    const ElevateResult result =
        elevate(input.mesh,
                ElevateOptions{options.order, options.straight ? ElevatedGeometry::straight : ElevatedGeometry::kept},
                work.context());
    work.end_phase("elevate");
    for (const std::string& gap : periodic_gaps(result.mesh.topology())) work.note(gap);
    note_labels(input.fields, work);
    write_and_report(options.output, result.mesh, carried_over(input.fields, result.sources), work,
                     {{"distance", distance_json(result, input.mesh, work)}});
    return exit_done;
}

}  // namespace

void add_elevate(CLI::App& app, Invocation& invocation) {
    auto* command = add_command(app, invocation, "elevate", "Mesh of another order; a raised one keeps the geometry");
    auto options = std::make_shared<Options>();
    add_input_option(*command, options->input);
    command->add_option("--order", options->order, "Order of the result, 1 to 10")->required()->type_name("P");
    command->add_flag("--straight", options->straight, "Straight-sided elements on the same corners");
    add_output_options(*command, options->output);
    set_action(*command, invocation, options, run);
}

}  // namespace curvewright::cli
