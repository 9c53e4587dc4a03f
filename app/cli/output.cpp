#include "app/cli/output.h"

#include <cstdio>
#include <map>

#include <fmt/format.h>

#include "core/base/error.h"
#include "core/io/matched_mesh.h"

namespace curvewright::cli {

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

ReadResult read_input(const InputOptions& input, Work& work) {
    work.set_input(input.file);
    ReadResult result = read_matched_mesh(input.file, input.merge_tolerance, work.context());
    work.notes(input.file.string(), result.notes);
    work.end_phase("read");
    return result;
}

QualityReport certify(const CurvedMesh& mesh, Work& work, const QualityOptions& options) {
    QualityReport report = assess_quality(mesh, options, work.context());
    work.end_phase("certify");
    return report;
}

QualityReport certify_result(const CurvedMesh& mesh, const QualityReport& original, Work& work) {
    QualityOptions options;
    options.orientation_sign = original.orientation_sign;
    return certify(mesh, work, options);
}

bool is_assessable(const CurvedMesh& mesh) {
    try {
        require_assessable(mesh);
        return true;
    } catch (const Unsupported&) {
        return false;
    }
}

Assessment assess(const CurvedMesh& mesh, Work& work, const QualityOptions& options) {
    try {
        return {certify(mesh, work, options), {}};
    } catch (const Unsupported& problem) {
        return {std::nullopt, problem.what()};
    }
}

Assessment assess_result(const CurvedMesh& mesh, const Assessment& original, Work& work) {
    QualityOptions options;
    if (original.report) options.orientation_sign = original.report->orientation_sign;
    return assess(mesh, work, options);
}

void add_assessment(Json& json, const Assessment& assessment) {
    json["scaled_jacobian"] = assessment.report ? summary_json(assessment.report->summary) : Json();
    if (!assessment.report) json["quality_note"] = assessment.note;
}

std::optional<QualityReport> certify_for(const OutputOptions& output, const CurvedMesh& mesh, Work& work) {
    const auto format = output.format ? output.format : format_of_suffix(output.file);
    const bool has_place = format == MeshFormat::vtu || format == MeshFormat::vtk;
    if (!has_place || !is_assessable(mesh)) return std::nullopt;
    return certify(mesh, work);
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
                  const QualityReport* quality, const Coordinates* reference, Work& work) {
    WriteOptions options = output.write_options(quality, reference);
    options.fields = &fields;
    const Provenance provenance = work.provenance();
    options.provenance = &provenance;
    work.notes(output.file.string(), write_mesh(output.file, mesh, options));
    work.end_phase("write");
}

void write_and_report(const OutputOptions& output, const CurvedMesh& mesh, const std::vector<FieldArray>& fields,
                      Work& work, const Json& more) {
    const auto quality = certify_for(output, mesh, work);
    write_output(output, mesh, fields, quality ? &*quality : nullptr, nullptr, work);
    Json json = {{"mesh", mesh_json(output.file, mesh)}};
    json.update(more);
    if (work.is_json())
        work.print(std::move(json));
    else
        fmt::print("{}: {}\n", output.file.string(), mesh_line(mesh));
}

void note_orientation(const QualityReport& report, Work& work) {
    if (report.orientation == Orientation::negative)
        work.note(
            "All elements are numbered clockwise (negative orientation). They are judged the other way round; "
            "'convert --flip' renumbers them.");
    if (report.orientation == Orientation::mixed)
        work.note(
            "Some elements are numbered the other way round than the others: their straight-sided versions have "
            "negative volume.");
}

int validity_status(const QualitySummary& summary) {
    return summary.invalid + summary.undecided > 0 ? exit_not_valid : exit_done;
}

}  // namespace curvewright::cli
