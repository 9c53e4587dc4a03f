#include "app/cli/output.h"

#include <algorithm>
#include <cstdio>
#include <functional>
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
    const auto figure = [&](double value) { return summary.assessed() > 0 ? Json(value) : Json(); };
    return {{"min", figure(summary.min)},           {"mean", figure(summary.mean)},
            {"max", figure(summary.max)},           {"valid", summary.valid},
            {"invalid", summary.invalid},           {"undecided", summary.undecided},
            {"not_assessed", summary.not_assessed}, {"reversed", summary.reversed}};
}

Json worst_json(const CurvedMesh& mesh, const QualityReport& report) {
    Json list = Json::array();
    for (Index element : report.worst(10)) {
        const Eigen::RowVector3d center = mesh.element_center(element);
        list.push_back({{"element", mesh.topology().element_tag(element).value},
                        {"scaled_jacobian", report.elements[element].validity == Validity::not_assessed
                                                ? Json()
                                                : Json(report.elements[element].scaled_jacobian)},
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
    std::string line = "scaled Jacobian (min J / max J): ";
    if (summary.assessed() > 0 || summary.elements() == 0)
        line += fmt::format("min {:.4g}, mean {:.4g}, max {:.4g}; ", summary.min, summary.mean, summary.max);
    line += fmt::format("{} valid, {} invalid, {} undecided", summary.valid, summary.invalid, summary.undecided);
    if (summary.not_assessed > 0) line += fmt::format(", {} not assessed", summary.not_assessed);
    if (summary.reversed > 0) line += fmt::format("; {} reversed", summary.reversed);
    return line;
}

ReadResult read_input(const InputOptions& input, Work& work) {
    work.set_input(input.file);
    ReadResult result = read_matched_mesh(input.file, input.merge_tolerance, work.context());
    work.notes(input.file.string(), result.notes);
    if (input.reorients) {
        Reorientation reoriented = reorient(result.mesh);
        work.note(fmt::format("{} {} renumbered.", reoriented.renumbered,
                              reoriented.renumbered == 1 ? "element was" : "elements were"));
        result.mesh = std::move(reoriented.mesh);
    }
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
    if (quality)
        note_assessment(mesh.topology(), *quality, work);
    else
        note_winding(mesh.topology(), work);
    write_output(output, mesh, fields, quality ? &*quality : nullptr, nullptr, work);
    Json json = {{"mesh", mesh_json(output.file, mesh)}};
    json.update(more);
    if (work.is_json())
        work.print(std::move(json));
    else
        fmt::print("{}: {}\n", output.file.string(), mesh_line(mesh));
}

namespace {

/// The first element of a kind, by its tag.
long long first_tag(const MeshTopology& topology, const std::function<bool(Index element)>& is_one) {
    for (Index element = 0; element < topology.element_count(); ++element)
        if (is_one(element)) return topology.element_tag(element).value;
    return 0;
}

}  // namespace

void note_winding(const MeshTopology& topology, Work& work) {
    if (const Index reversed = topology.reversed_count(); reversed > 0)
        work.note(fmt::format(
            "{} numbered against {} neighbours (reversed), the first is element {}; that is a matter of numbering, not "
            "of tangling, and --reorient renumbers them.",
            reversed == 1 ? "1 element is" : fmt::format("{} elements are", reversed), reversed == 1 ? "its" : "their",
            first_tag(topology, [&](Index element) { return topology.is_reversed(element); })));
    const Winding& winding = topology.winding();
    if (winding.one_sided_count > 0)
        work.note(fmt::format(
            "{} of the mesh {} one-sided, like a Möbius strip: its elements cannot be numbered alike, and none of them "
            "is told as reversed (element {} is one of them).",
            winding.one_sided_count == 1 ? "A part" : fmt::format("{} parts", winding.one_sided_count),
            winding.one_sided_count == 1 ? "is" : "are", first_tag(topology, [&](Index element) {
                return winding.is_part_one_sided[winding.part_of_element[element]] != 0;
            })));
}

void note_assessment(const MeshTopology& topology, const QualityReport& report, Work& work) {
    note_winding(topology, work);
    if (report.orientation == Orientation::negative)
        work.note(
            "All elements are numbered clockwise (negative orientation). They are judged the other way round; "
            "'convert --flip' and --reorient renumber them.");
    if (report.orientation == Orientation::mixed)
        work.note(
            "Some parts of the mesh are numbered clockwise (negative orientation) and others are not. Each is judged "
            "by "
            "its own orientation; --reorient renumbers them.");
    if (const Index pyramids = report.summary.not_assessed; pyramids > 0)
        work.note(fmt::format(
            "{} not assessed, because the shape functions of pyramids are rational; the first is element {}.",
            pyramids == 1 ? "1 pyramid was" : fmt::format("{} pyramids were", pyramids),
            first_tag(topology,
                      [&](Index element) { return topology.element_type(element).shape == Shape::pyramid; })));
}

int worse_status(int a, int b) {
    if (a == exit_not_valid || b == exit_not_valid) return exit_not_valid;
    return std::max(a, b);
}

int validity_status(const QualitySummary& summary) {
    return summary.invalid + summary.undecided > 0 ? exit_not_valid : exit_done;
}

}  // namespace curvewright::cli
