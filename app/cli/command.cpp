#include "app/cli/command.h"

#include <map>

#include "app/cli/work.h"

namespace curvewright::cli {

WriteOptions OutputOptions::write_options(const QualityReport* quality, const Coordinates* reference) const {
    WriteOptions options;
    options.format = format;
    if (binary) options.binary = true;
    options.quality = quality;
    options.reference = reference;
    return options;
}

CLI::App* add_command(CLI::App& app, Invocation& invocation, const std::string& name, const std::string& description) {
    CLI::App* command = app.add_subcommand(name, description);
    command->add_flag("--json", invocation.common.json, "One JSON object on standard output, nothing else there");
    command->add_option("--threads", invocation.common.threads, "Number of threads (default: one per processor)")
        ->check(CLI::Range(1, 1024));
    command->add_flag("--quiet", invocation.common.quiet, "No progress on standard error");
    return command;
}

void add_output_options(CLI::App& command, OutputOptions& options, bool is_positional) {
    command.add_option(is_positional ? "output" : "-o,--output", options.file, "File to write (.msh, .vtu, .vtk)")
        ->required()
        ->type_name("OUT");
    static const std::map<std::string, MeshFormat> formats = {
        {"msh2", MeshFormat::msh2}, {"msh4", MeshFormat::msh4}, {"vtu", MeshFormat::vtu}, {"vtk", MeshFormat::vtk}};
    command
        .add_option_function<std::string>(
            "--format", [&options](const std::string& text) { options.format = formats.at(text); },
            "Format, whatever the suffix says: msh2, msh4, vtu or vtk")
        ->check(CLI::IsMember({"msh2", "msh4", "vtu", "vtk"}));
    command.add_flag("--binary", options.binary, "Binary instead of text (vtu, vtk)");
}

void add_input_option(CLI::App& command, InputOptions& input, const std::string& placeholder) {
    command.add_option("mesh", input.file, "Mesh (.msh, .msh.gz, .vtu, .vtk)")->required()->type_name(placeholder);
    command
        .add_option("--merge-nodes", input.merge_tolerance,
                    "Merge nodes that are closer than T times the mesh's size (default: only where every cell has its "
                    "own nodes)")
        ->check(CLI::Range(0.0, 0.5))
        ->type_name("T");
    command.add_flag("--reorient", input.reorients,
                     "Renumber elements that run against their neighbours, and parts that are clockwise, first");
}

int run_command(const std::function<int(Work&)>& run, const Invocation& invocation, const TaskContext& context) {
    Work work(invocation, context);
    return run(work);
}

void add_deformation_option(CLI::App& command, std::filesystem::path& file) {
    command.add_option("--deformation", file, "Operations (.json), node table (.csv) or a mesh")
        ->required()
        ->type_name("D");
}

}  // namespace curvewright::cli
