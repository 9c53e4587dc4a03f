#include "core/report/run_report.h"

#include <algorithm>
#include <chrono>
#include <limits>
#include <map>
#include <span>

#include <fmt/chrono.h>

#include "core/base/sha256.h"
#include "core/report/group_statistics.h"
#include "core/report/versions.h"
#include "core/session/session_file.h"

namespace curvewright {
namespace {

constexpr std::size_t worst_count = 10;

std::string hash_of(const Coordinates& x) {
    Sha256 hash;
    hash.add(std::as_bytes(std::span(x.data(), static_cast<std::size_t>(x.size()))));
    return hash.digest();
}

void describe_mesh(RunReport& report, const CurvedMesh& mesh) {
    const MeshTopology& topology = mesh.topology();
    report.dimension = topology.dimension();
    report.order = topology.order();
    report.nodes = topology.node_count();
    report.interior_nodes = static_cast<Index>(topology.interior_nodes().size());
    report.boundary_nodes = static_cast<Index>(topology.boundary_nodes().size());
    std::map<ElementType, Index> counts;
    for (Index element = 0; element < topology.element_count(); ++element) ++counts[topology.element_type(element)];
    for (const auto& [type, count] : counts) report.types.emplace_back(name(type), count);
    const auto box = bounding_box(mesh);
    for (int i = 0; i < 6; ++i) report.bounding_box[static_cast<std::size_t>(i)] = box(i / 3, i % 3);
}

void compare_positions(RunReport& report, const CurvedMesh& before, const CurvedMesh& after) {
    const MeshTopology& topology = before.topology();
    for (Index node = 0; node < topology.node_count(); ++node) {
        const double move = (after.coordinates().row(node) - before.coordinates().row(node)).norm();
        if (!(move > 0.0)) continue;
        report.largest_move = std::max(report.largest_move, move);
        ++(topology.is_boundary_node(node) ? report.moved_boundary_nodes : report.moved_interior_nodes);
    }
}

ReportQuality describe_quality(const QualityReport& quality, const CurvedMesh& mesh, const Coordinates& ideal,
                               const GlobalValidityReport& global, const TaskContext& context) {
    ReportQuality result{quality.summary,
                         assess_shape(mesh, ideal, context),
                         make_report_histogram(quality),
                         global.answer,
                         global.reason,
                         {},
                         global.boundary.crossing_count};
    const MeshTopology& topology = mesh.topology();
    for (const FacetPair& pair : global.boundary.crossings)
        result.crossings.push_back(
            {topology.element_tag(pair.a.element).value, topology.element_tag(pair.b.element).value});
    return result;
}

/// Before and after. A boundary that stayed is looked at once.
void describe_qualities(RunReport& report, const ReportSource& source, const TaskContext& context) {
    const auto before = assess_global_validity(source.before, source.quality_before, {}, context);
    const bool has_stayed =
        has_same_boundary(source.before.topology(), source.before.coordinates(), source.after.coordinates());
    const auto after = assess_global_validity(source.after, source.quality_after, {}, context,
                                              has_stayed ? &before.boundary : nullptr);
    const Coordinates& ideal = source.before.coordinates();
    report.before = describe_quality(source.quality_before, source.before, ideal, before, context);
    report.after = describe_quality(source.quality_after, source.after, ideal, after, context);
}

void compare_elements(RunReport& report, const ReportSource& source) {
    const MeshTopology& topology = source.after.topology();
    const auto facts_of = [&](Index element) {
        const auto i = static_cast<std::size_t>(element);
        const Eigen::RowVector3d center = source.after.element_center(element);
        return ReportElement{element,
                             topology.element_tag(element).value,
                             topology.element_type(element),
                             {center[0], center[1], center[2]},
                             groups_of(topology, element),
                             source.quality_before.elements[i],
                             source.quality_after.elements[i]};
    };
    for (const Index element : source.quality_before.worst(worst_count))
        report.worst_before.push_back(facts_of(element));
    for (const Index element : source.quality_after.worst(worst_count)) report.worst_after.push_back(facts_of(element));
}

void describe_certificate(RunReport& report, const ReportSource& source) {
    std::map<Index, const UnmendedElement*> reasons;
    for (const UnmendedElement& element : source.run.unmended) reasons[element.element] = &element;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < source.quality_after.elements.size(); ++i) {
        const ElementQuality& now = source.quality_after.elements[i];
        const bool was_valid = source.quality_before.elements[i].validity == Validity::valid;
        if (now.validity == Validity::valid) {
            report.mended += was_valid ? 0 : 1;
            least = std::min(least, now.min_lower / now.max_upper);
            continue;
        }
        if (now.validity == Validity::not_assessed) continue;
        report.spoiled += was_valid ? 1 : 0;
        const auto element = static_cast<Index>(i);
        ReportUnproved entry{source.after.topology().element_tag(element).value, now, {}, false, now.scaled_jacobian};
        if (const auto found = reasons.find(element); found != reasons.end()) {
            entry.reason = found->second->reason;
            entry.is_impossible = found->second->is_proved;
            entry.bound = found->second->bound;
        } else {
            entry.reason = now.validity == Validity::invalid
                               ? "the method found no valid position for its nodes"
                               : "the least Jacobian is zero up to rounding, or the bounds ran out of subdivisions";
        }
        report.impossible += entry.is_impossible ? 1 : 0;
        report.not_valid.push_back(std::move(entry));
    }
    if (report.not_valid.empty() && std::isfinite(least) && !source.quality_after.elements.empty())
        report.proved_least = least;
}

std::string now_text() {
    const std::time_t now = std::chrono::system_clock::to_time_t(std::chrono::system_clock::now());
    return fmt::format("{:%Y-%m-%d %H:%M:%S} UTC", fmt::gmtime(now));
}

}  // namespace

Index ReportHistogram::highest() const {
    Index result = tangled;
    for (std::size_t i = 0; i < valid.size(); ++i) result = std::max(result, valid[i] + undecided[i]);
    return result;
}

ReportHistogram make_report_histogram(const QualityReport& report) {
    ReportHistogram histogram;
    histogram.valid.resize(ReportHistogram::bins);
    histogram.undecided.resize(ReportHistogram::bins);
    const Histogram scale{0.0, 1.0, std::vector<Index>(ReportHistogram::bins)};
    for (const ElementQuality& quality : report.elements) {
        if (quality.validity == Validity::not_assessed) continue;
        if (quality.validity == Validity::invalid) {
            ++histogram.tangled;
            continue;
        }
        auto& bars = quality.validity == Validity::undecided ? histogram.undecided : histogram.valid;
        ++bars[static_cast<std::size_t>(scale.bin_of(quality.scaled_jacobian))];
    }
    return histogram;
}

RunReport collect_report(const ReportSource& source, const TaskContext& context) {
    context.report("Collecting the report", 0.0);
    RunReport report;
    report.input = source.input;
    report.input_coordinates = hash_of(source.before.coordinates());
    report.result_coordinates = hash_of(source.after.coordinates());
    describe_mesh(report, source.before);
    report.orientation = source.quality_before.orientation;

    report.method = method_name(source.options);
    report.method_title = method_title(source.options);
    report.method_description = method_description(source.options);
    report.parameters = parameters_of(source.options);
    if (!source.warped_first.empty())
        report.parameters.push_back(
            {"warp_first", source.warped_first,
             "the interior began where these weights of the straight-sided mesh put it, corners included"});
    if (source.input.steps.empty()) {
        report.command = command_line(UntangleAction{source.options}, source.input.file, "untangled.vtu");
        if (!source.warped_first.empty()) report.command += " --warp-first " + source.warped_first;
    }
    report.made_by = source.made_by;
    report.versions = program_versions();

    describe_qualities(report, source, context);
    compare_positions(report, source.before, source.after);
    report.groups = group_statistics(source.before.topology(), source.quality_before, source.quality_after);
    compare_elements(report, source);

    report.reason = source.run.reason;
    if (const auto* guaranteed = std::get_if<GuaranteedOptions>(&source.options)) {
        report.rounds = source.run.rounds;
        report.moves_boundary = !guaranteed->boundary.is_all_fixed();
    } else {
        report.passes = source.run.passes;
    }
    report.sliding_nodes = source.run.sliding_nodes;
    report.free_nodes = source.run.free_nodes;
    report.largest_boundary_distance = source.run.largest_boundary_distance;
    report.pass_list = source.log.passes().values();
    report.patch_list = source.log.patches().values();
    report.round_list = source.log.rounds().values();
    report.pass_count = source.log.passes().count();
    report.patch_count = source.log.patches().count();
    report.round_count = source.log.rounds().count();
    describe_certificate(report, source);

    report.written = now_text();
    report.timings = source.timings;
    return report;
}

}  // namespace curvewright
