#include "core/mesh/elevate.h"

#include <fmt/format.h>

#include "app/cli/command.h"
#include "app/cli/output.h"

namespace curvewright::cli {
namespace {

struct Options {
    InputOptions input;
    int order = 0;
    OutputOptions output;
};

int run(const Options& options, Work& work) {
    check_output(options.output);
    const ReadResult input = read_input(options.input, work);
    const CurvedMesh mesh = elevate(input.mesh, options.order, work.context());
    for (const std::string& gap : periodic_gaps(mesh.topology())) work.note(gap);
    work.end_phase("elevate");
    // The elements are the same, the nodes are others.
    std::vector<FieldArray> fields;
    std::string left_out;
    for (const FieldArray& field : input.fields)
        if (field.place == FieldArray::Place::elements)
            fields.push_back(field);
        else
            left_out += (left_out.empty() ? "" : ", ") + field.name;
    if (!left_out.empty()) work.note(fmt::format("Left out, because the nodes are others: {}.", left_out));
    write_and_report(options.output, mesh, fields, work);
    return exit_done;
}

}  // namespace

void add_elevate(CLI::App& app, Invocation& invocation) {
    auto* command = add_command(app, invocation, "elevate", "Straight-sided mesh of another order on the same corners");
    auto options = std::make_shared<Options>();
    add_input_option(*command, options->input);
    command->add_option("--order", options->order, "Order of the result, 1 to 10")->required()->type_name("P");
    add_output_options(*command, options->output);
    set_action(*command, invocation, options, run);
}

}  // namespace curvewright::cli
