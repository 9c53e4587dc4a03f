#include <fmt/format.h>

#include "app/cli/command.h"
#include "app/cli/output.h"
#include "core/base/error.h"
#include "core/io/atomic_file.h"
#include "core/report/report_charts.h"
#include "ui/scene/report_painter.h"

namespace curvewright::cli {
namespace {

struct Options {
    std::vector<std::filesystem::path> meshes;
    std::filesystem::path output;
    std::vector<std::string> titles;
    bool reorients = false;
};

int run(const Options& options, Work& work) {
    Json states = Json::array();
    if (options.output.extension() != ".svg")
        throw InvalidInput(options.output.string(), 0, "histograms are written as .svg.");
    std::vector<HistogramPanel> panels;
    for (std::size_t i = 0; i < options.meshes.size(); ++i) {
        const std::filesystem::path& file = options.meshes[i];
        const CurvedMesh mesh = read_input({file, options.reorients}, work).mesh;
        const QualityReport report = certify(mesh, work);
        const HistogramPanel& panel =
            panels.emplace_back(HistogramPanel{options.titles.empty() ? file.filename().string() : options.titles[i],
                                               report.summary, make_report_histogram(report)});
        note_assessment(mesh.topology(), report, work);
        states.push_back({{"mesh", mesh_json(file, mesh)},
                          {"scaled_jacobian", summary_json(report.summary)},
                          {"histogram",
                           {{"tangled", panel.histogram.tangled},
                            {"valid", panel.histogram.valid},
                            {"undecided", panel.histogram.undecided}}}});
    }
    write_text_file(options.output, histograms_document(panels, report_colors()));
    work.end_phase("write");
    if (work.is_json())
        work.print({{"picture", {{"file", options.output.string()}}}, {"states", states}});
    else
        fmt::print("{}\n", options.output.string());
    return exit_done;
}

}  // namespace

void add_histogram(CLI::App& app, Invocation& invocation) {
    auto* command = add_command(app, invocation, "histogram",
                                "Histograms of the scaled Jacobian of one mesh or several, on one scale, as a picture");
    auto options = std::make_shared<Options>();
    command->add_option("meshes", options->meshes, "Meshes (.msh, .msh.gz, .vtu, .vtk): before, after, ...")
        ->required()
        ->type_name("MESH");
    command->add_option("-o,--output", options->output, "Picture to write")->required()->type_name("SVG");
    command->add_flag("--reorient", options->reorients,
                      "Renumber elements that run against their neighbours, and parts that are clockwise, first");
    command
        ->add_option("--title", options->titles, "What stands over a histogram, one for each mesh (default: its name)")
        ->allow_extra_args(false)
        ->type_name("TEXT");
    command->parse_complete_callback([options] {
        if (!options->titles.empty() && options->titles.size() != options->meshes.size())
            throw CLI::ValidationError("--title", "is to be given as often as there are meshes, or never");
    });
    set_action(*command, invocation, options, run);
}

}  // namespace curvewright::cli
