#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <optional>

#include <fmt/format.h>

#include "app/cli/command.h"
#include "app/cli/global_check.h"
#include "app/cli/output.h"
#include "core/io/atomic_file.h"

namespace curvewright::cli {
namespace {

struct Options {
    InputOptions input;
    std::filesystem::path csv;
    QualityOptions quality;
    std::optional<double> least;  ///< that every element has to have
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

/// Notes how many elements are below the least quality asked for; the status.
int note_least(const Options& options, const QualityReport& report, Work& work) {
    const int validity = validity_status(report.summary);
    if (!options.least) return validity;
    const auto below =
        std::count_if(report.elements.begin(), report.elements.end(),
                      [&](const ElementQuality& quality) { return quality.scaled_jacobian < *options.least; });
    if (report.summary.not_assessed > 0)
        work.note(fmt::format("{} of {} elements were not assessed, so that they are not known to have at least {:g}.",
                              report.summary.not_assessed, report.elements.size(), *options.least));
    if (below == 0) return report.summary.not_assessed > 0 ? static_cast<int>(exit_not_valid) : validity;
    work.note(fmt::format("{} of {} elements {} below {:g}; the least scaled Jacobian is {:.4g}.", below,
                          report.elements.size(), below == 1 ? "is" : "are", *options.least, report.summary.min));
    return exit_not_valid;
}

int run(const Options& options, Work& work) {
    const CurvedMesh mesh = read_input(options.input, work).mesh;
    const QualityReport report = certify(mesh, work, options.quality);
    note_assessment(mesh.topology(), report, work);
    const GlobalCheck global(mesh, report, work);
    if (!options.csv.empty()) {
        write_text_file(options.csv, to_csv(mesh, report));
        work.end_phase("write");
    }
    const int status = note_least(options, report, work);
    if (work.is_json()) {
        Json json = {{"mesh", mesh_json(options.input.file, mesh)},
                     {"orientation", to_string(report.orientation)},
                     {"scaled_jacobian", summary_json(report.summary)},
                     {"worst", worst_json(mesh, report)}};
        global.add_to(json, mesh);
        work.print(json);
    } else {
        fmt::print("{}: {}\n{}\n{}\n", options.input.file.string(), mesh_line(mesh), summary_line(report.summary),
                   global.line());
        for (Index element : report.worst(10)) {
            const ElementQuality& q = report.elements[element];
            const auto center = mesh.element_center(element);
            fmt::print("  element {:>8}  {:>10.4g}  {:<9}  at ({:.6g}, {:.6g}, {:.6g})\n",
                       mesh.topology().element_tag(element).value, q.scaled_jacobian, to_string(q.validity), center[0],
                       center[1], center[2]);
        }
    }
    return worse_status(status, global.status());
}

}  // namespace

void add_quality(CLI::App& app, Invocation& invocation) {
    auto* command = add_command(app, invocation, "quality", "Certified scaled Jacobian (min J / max J) per element");
    auto options = std::make_shared<Options>();
    add_input_option(*command, options->input, "MESH");
    command->add_option("--csv", options->csv, "Write one line per element to this file")->type_name("FILE");
    command->add_option("--tolerance", options->quality.tolerance, "Width of the bounds of J, relative to max |J|")
        ->capture_default_str()
        ->check(CLI::PositiveNumber);
    command
        ->add_option_function<double>(
            "--min", [options](const double& least) { options->least = least; },
            "End with status 3 if an element's scaled Jacobian is below this")
        ->type_name("Q")
        ->check([](const std::string& text) {
            char* end = nullptr;
            const double least = std::strtod(text.c_str(), &end);
            const bool is_number = end != text.c_str() && *end == '\0' && std::isfinite(least) && least <= 1.0;
            return is_number ? std::string() : "the least quality must be a number of at most 1";
        });
    set_action(*command, invocation, options, run);
}

}  // namespace curvewright::cli
