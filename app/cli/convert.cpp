#include "app/cli/command.h"
#include "app/cli/output.h"

namespace curvewright::cli {
namespace {

struct Options {
    InputOptions input;
    OutputOptions output;
    bool flip = false;
};

int run(const Options& options, Work& work) {
    check_output(options.output);
    const ReadResult input = read_input(options.input, work);
    CurvedMesh mesh = input.mesh;
    if (options.flip) mesh = flip_orientation(mesh);
    write_and_report(options.output, mesh, input.fields, work);
    return exit_done;
}

}  // namespace

void add_convert(CLI::App& app, Invocation& invocation) {
    auto* command = add_command(app, invocation, "convert", "Write the mesh in another format; nothing moves");
    auto options = std::make_shared<Options>();
    add_input_option(*command, options->input);
    add_output_options(*command, options->output, true);
    command->add_flag("--flip", options->flip, "Number the elements the other way round (clockwise meshes)");
    set_action(*command, invocation, options, run);
}

}  // namespace curvewright::cli
