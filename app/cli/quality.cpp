#include <fmt/format.h>

#include "app/cli/command.h"
#include "app/cli/output.h"
#include "core/io/atomic_file.h"

namespace curvewright::cli {
namespace {

struct Options {
    std::filesystem::path mesh, csv;
    QualityOptions quality;
};

std::string to_csv(const CurvedMesh& mesh, const QualityReport& report) {
    std::string text = "element,scaled_jacobian,validity,min_lower,min_upper,max_lower,max_upper\n";
    for (Index element = 0; element < mesh.topology().element_count(); ++element) {
        const ElementQuality& q = report.elements[element];
        text += fmt::format("{},{},{},{},{},{},{}\n", mesh.topology().element_tag(element).value, q.scaled_jacobian,
                            to_string(q.validity), q.min_lower, q.min_upper, q.max_lower, q.max_upper);
    }
    return text;
}

int run(const Options& options, const Invocation& invocation, const TaskContext& context) {
    const Stopwatch watch;
    Json timings = Json::object();
    const CurvedMesh mesh = read_input(options.mesh, invocation, context, timings).mesh;
    const QualityReport report = certify(mesh, context, timings, options.quality);
    warn_about_orientation(report, invocation);
    if (!options.csv.empty()) {
        const Stopwatch write;
        write_text_file(options.csv, to_csv(mesh, report));
        timings["write"] = write.seconds();
    }
    finish_timings(timings, watch);
    if (invocation.common.json) {
        const Json json = {{"mesh", mesh_json(options.mesh, mesh)},
                           {"orientation", to_string(report.orientation)},
                           {"scaled_jacobian", summary_json(report.summary)},
                           {"worst", worst_json(mesh, report)},
                           {"timings", timings}};
        print_json(json);
    } else {
        fmt::print("{}: {}\n{}\n", options.mesh.string(), mesh_line(mesh), summary_line(report.summary));
        for (Index element : report.worst(10)) {
            const ElementQuality& q = report.elements[element];
            const auto center = mesh.element_center(element);
            fmt::print("  element {:>8}  {:>10.4g}  {:<9}  at ({:.6g}, {:.6g}, {:.6g})\n",
                       mesh.topology().element_tag(element).value, q.scaled_jacobian, to_string(q.validity), center[0],
                       center[1], center[2]);
        }
    }
    return validity_status(report.summary);
}

}  // namespace

void add_quality(CLI::App& app, Invocation& invocation) {
    auto* command = add_command(app, invocation, "quality", "Certified scaled Jacobian (min J / max J) per element");
    auto options = std::make_shared<Options>();
    add_input_option(*command, options->mesh, "MESH");
    command->add_option("--csv", options->csv, "Write one line per element to this file")->type_name("FILE");
    command->add_option("--tolerance", options->quality.tolerance, "Width of the bounds of J, relative to max |J|")
        ->capture_default_str()
        ->check(CLI::PositiveNumber);
    set_action(*command, invocation, options, run);
}

}  // namespace curvewright::cli
