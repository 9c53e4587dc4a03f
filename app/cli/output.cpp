#include "app/cli/output.h"

#include <cstdio>
#include <map>

#include <fmt/format.h>

#include "core/base/error.h"

namespace curvewright::cli {

void print_json(const Json& json) {
    fmt::print("{}\n", json.dump(2, ' ', false, Json::error_handler_t::replace));
}

Json mesh_json(const std::filesystem::path& file, const CurvedMesh& mesh) {
    const MeshTopology& topology = mesh.topology();
    return {{"file", file.string()},          {"dimension", topology.dimension()},
            {"order", topology.order()},      {"elements", topology.element_count()},
            {"nodes", topology.node_count()}, {"interior_nodes", topology.interior_nodes().size()}};
}

Json summary_json(const QualitySummary& summary) {
    return {{"min", summary.min},     {"mean", summary.mean},       {"max", summary.max},
            {"valid", summary.valid}, {"invalid", summary.invalid}, {"undecided", summary.undecided}};
}

Json worst_json(const CurvedMesh& mesh, const QualityReport& report) {
    Json list = Json::array();
    for (Index element : report.worst(10)) {
        const Eigen::RowVector3d center = mesh.element_center(element);
        list.push_back({{"element", mesh.topology().element_tag(element).value},
                        {"scaled_jacobian", report.elements[element].scaled_jacobian},
                        {"center", {center[0], center[1], center[2]}}});
    }
    return list;
}

std::string mesh_line(const CurvedMesh& mesh) {
    const MeshTopology& topology = mesh.topology();
    std::map<ElementType, long> counts;
    for (Index element = 0; element < topology.element_count(); ++element) ++counts[topology.element_type(element)];
    std::string types;
    for (const auto& [type, count] : counts)
        types += fmt::format("{}P{} {}", types.empty() ? "" : ", ", type.order, counted_name(type.shape, count));
    if (types.empty()) types = "no elements";
    return fmt::format("{}; {} nodes ({} interior, {} on the boundary)", types, topology.node_count(),
                       topology.interior_nodes().size(), topology.boundary_nodes().size());
}

std::string summary_line(const QualitySummary& summary) {
    return fmt::format(
        "scaled Jacobian (min J / max J): min {:.4g}, mean {:.4g}, max {:.4g}; {} valid, {} invalid, {} "
        "undecided",
        summary.min, summary.mean, summary.max, summary.valid, summary.invalid, summary.undecided);
}

ReadResult read_input(const std::filesystem::path& file, const Invocation& invocation, const TaskContext& context,
                      Json& timings) {
    const Stopwatch watch;
    ReadResult result = read_mesh(file, context);
    timings["read"] = timings.value("read", 0.0) + watch.seconds();
    if (!invocation.common.quiet)
        for (const std::string& note : result.notes) fmt::print(stderr, "{}: {}\n", file.string(), note);
    return result;
}

QualityReport certify(const CurvedMesh& mesh, const TaskContext& context, Json& timings,
                      const QualityOptions& options) {
    const Stopwatch watch;
    QualityReport report = assess_quality(mesh, options, context);
    timings["certify"] = timings.value("certify", 0.0) + watch.seconds();
    return report;
}

QualityReport certify_result(const CurvedMesh& mesh, const QualityReport& original, const TaskContext& context,
                             Json& timings) {
    QualityOptions options;
    options.orientation_sign = original.orientation_sign;
    return certify(mesh, context, timings, options);
}

bool is_assessable(const CurvedMesh& mesh) {
    try {
        require_assessable(mesh);
        return true;
    } catch (const Unsupported&) {
        return false;
    }
}

Assessment assess(const CurvedMesh& mesh, const TaskContext& context, Json& timings, const QualityOptions& options) {
    try {
        return {certify(mesh, context, timings, options), {}};
    } catch (const Unsupported& problem) {
        return {std::nullopt, problem.what()};
    }
}

Assessment assess_result(const CurvedMesh& mesh, const Assessment& original, const TaskContext& context,
                         Json& timings) {
    QualityOptions options;
    if (original.report) options.orientation_sign = original.report->orientation_sign;
    return assess(mesh, context, timings, options);
}

void add_assessment(Json& json, const Assessment& assessment) {
    json["scaled_jacobian"] = assessment.report ? summary_json(assessment.report->summary) : Json();
    if (!assessment.report) json["quality_note"] = assessment.note;
}

std::optional<QualityReport> certify_for(const OutputOptions& output, const CurvedMesh& mesh,
                                         const TaskContext& context, Json& timings) {
    const auto format = output.format ? output.format : format_of_suffix(output.file);
    const bool has_place = format == MeshFormat::vtu || format == MeshFormat::vtk;
    if (!has_place || !is_assessable(mesh)) return std::nullopt;
    return certify(mesh, context, timings);
}

void check_output(const OutputOptions& output) {
    const std::string name = output.file.string();
    if (!output.format && !format_of_suffix(output.file))
        throw InvalidInput(name, 0, "the suffix is none of .msh, .vtu and .vtk; --format tells the format otherwise.");
    const auto folder = output.file.has_parent_path() ? output.file.parent_path() : std::filesystem::path(".");
    std::error_code error;
    if (!std::filesystem::is_directory(folder, error))
        throw InvalidInput(name, 0, fmt::format("there is no folder {} to write it to.", folder.string()));
    if (std::filesystem::is_directory(output.file, error))
        throw InvalidInput(name, 0, "there is a folder of that name; a file was expected.");
}

void write_output(const OutputOptions& output, const CurvedMesh& mesh, const std::vector<FieldArray>& fields,
                  const QualityReport* quality, const Coordinates* reference, const Invocation& invocation,
                  Json& timings) {
    const Stopwatch watch;
    WriteOptions options = output.write_options(quality, reference);
    options.fields = &fields;
    const std::vector<std::string> notes = write_mesh(output.file, mesh, options);
    timings["write"] = watch.seconds();
    if (!invocation.common.quiet)
        for (const std::string& note : notes) fmt::print(stderr, "{}: {}\n", output.file.string(), note);
}

void write_and_report(const OutputOptions& output, const CurvedMesh& mesh, const std::vector<FieldArray>& fields,
                      const Invocation& invocation, const TaskContext& context, Json& timings, const Stopwatch& watch) {
    const auto quality = certify_for(output, mesh, context, timings);
    write_output(output, mesh, fields, quality ? &*quality : nullptr, nullptr, invocation, timings);
    finish_timings(timings, watch);
    if (invocation.common.json)
        print_json({{"mesh", mesh_json(output.file, mesh)}, {"timings", timings}});
    else
        fmt::print("{}: {}\n", output.file.string(), mesh_line(mesh));
}

void finish_timings(Json& timings, const Stopwatch& watch) {
    timings["total"] = watch.seconds();
}

void warn_about_orientation(const QualityReport& report, const Invocation& invocation) {
    if (invocation.common.quiet) return;
    if (report.orientation == Orientation::negative)
        fmt::print(stderr,
                   "All elements are numbered clockwise (negative orientation). They are judged the other way "
                   "round; 'convert --flip' renumbers them.\n");
    if (report.orientation == Orientation::mixed)
        fmt::print(stderr,
                   "Some elements are numbered the other way round than the others: their straight-sided "
                   "versions have negative volume.\n");
}

int validity_status(const QualitySummary& summary) {
    return summary.invalid + summary.undecided > 0 ? exit_not_valid : exit_done;
}

}  // namespace curvewright::cli
