#include "core/report/report_json.h"

#include <nlohmann/json.hpp>

namespace curvewright {
namespace {

using Json = nlohmann::ordered_json;

template <class List, class Function>
Json array_of(const List& list, const Function& entry) {
    Json json = Json::array();
    for (const auto& item : list) json.push_back(entry(item));
    return json;
}

template <class Value>
Json or_null(const std::optional<Value>& value) {
    return value ? Json(*value) : Json();
}

Json or_null(const std::string& text) {
    return text.empty() ? Json() : Json(text);
}

Json summary_json(const QualitySummary& summary) {
    const auto figure = [&](double value) { return summary.assessed() > 0 ? Json(value) : Json(); };
    return {{"min", figure(summary.min)},           {"mean", figure(summary.mean)},
            {"max", figure(summary.max)},           {"valid", summary.valid},
            {"invalid", summary.invalid},           {"undecided", summary.undecided},
            {"not_assessed", summary.not_assessed}, {"reversed", summary.reversed}};
}

Json quality_json(const ReportQuality& quality) {
    const ReportHistogram& histogram = quality.histogram;
    return {{"scaled_jacobian", summary_json(quality.scaled_jacobian)},
            {"shape", {{"min", quality.shape.min}, {"mean", quality.shape.mean}}},
            {"globally_valid", to_string(quality.globally_valid)},
            {"globally_valid_reason", quality.global_reason},
            {"crossing_elements", quality.crossings},
            {"crossing_facet_pairs", quality.crossing_count},
            {"histogram",
             {{"lower", 0.0},
              {"upper", 1.0},
              {"tangled", histogram.tangled},
              {"valid", histogram.valid},
              {"undecided", histogram.undecided}}}};
}

Json element_quality_json(const ElementQuality& quality) {
    if (quality.validity == Validity::not_assessed) return {{"validity", to_string(quality.validity)}};
    return {{"scaled_jacobian", quality.scaled_jacobian},
            {"validity", to_string(quality.validity)},
            {"min_jacobian", {quality.min_lower, quality.min_upper}},
            {"max_jacobian", {quality.max_lower, quality.max_upper}}};
}

Json element_json(const ReportElement& element) {
    return {{"element", element.tag},
            {"type", name(element.type)},
            {"center", element.center},
            {"groups", element.groups},
            {"before", element_quality_json(element.before)},
            {"after", element_quality_json(element.after)}};
}

Json pass_json(const convergence::Pass& pass) {
    return {{"pass", pass.pass},
            {"patches", pass.patches},
            {"minimisations", pass.minimisations},
            {"iterations", pass.iterations},
            {"objective_before", pass.objective_before},
            {"objective_after", pass.objective_after},
            {"relative_change", pass.relative_change},
            {"min_scaled_jacobian", pass.min_scaled_jacobian},
            {"invalid", pass.invalid},
            {"undecided", pass.undecided}};
}

Json patch_json(const convergence::Patch& patch) {
    return {{"pass", patch.pass},
            {"patch", patch.patch},
            {"elements", patch.elements},
            {"nodes", patch.nodes},
            {"minimisations", patch.minimisations},
            {"iterations", patch.iterations},
            {"objective_before", patch.objective_before},
            {"objective_after", patch.objective_after},
            {"min_scaled_jacobian_before", patch.min_scaled_jacobian_before},
            {"min_scaled_jacobian_after", patch.min_scaled_jacobian_after}};
}

Json round_json(const convergence::Round& round) {
    return {{"pass", round.pass},
            {"patch", round.patch},
            {"round", round.round},
            {"iterations", round.iterations},
            {"objective", or_null(round.objective)},
            {"least_determinant", or_null(round.least_determinant)},
            {"min_scaled_jacobian", or_null(round.min_scaled_jacobian)},
            {"not_valid", or_null(round.not_valid)}};
}

template <class List, class Function>
Json course_json(std::size_t count, const List& list, const Function& entry) {
    return {{"count", count}, {"listed", array_of(list, entry)}};
}

Json unproved_json(const ReportUnproved& entry) {
    Json json = {{"element", entry.tag}};
    json.update(element_quality_json(entry.quality));
    json["reason"] = entry.reason;
    json["proved_impossible"] = entry.is_impossible;
    json["bound"] = entry.bound;
    return json;
}

Json input_json(const RunReport& report) {
    const auto& box = report.bounding_box;
    return {{"file", report.input.file},
            {"sha256", or_null(report.input.sha256)},
            {"note", or_null(report.input.note)},
            {"steps",
             array_of(report.input.steps, [](const std::string& line) { return Json::parse(line, nullptr, false); })},
            {"mesh",
             {{"dimension", report.dimension},
              {"order", report.order},
              {"elements", report.elements()},
              {"types", array_of(report.types,
                                 [](const auto& type) {
                                     return Json{{"type", type.first}, {"count", type.second}};
                                 })},
              {"nodes", report.nodes},
              {"interior_nodes", report.interior_nodes},
              {"boundary_nodes", report.boundary_nodes},
              {"orientation", to_string(report.orientation)},
              {"bounding_box", {{box[0], box[1], box[2]}, {box[3], box[4], box[5]}}},
              {"coordinates_sha256", report.input_coordinates}}}};
}

Json outcome_json(const RunReport& report) {
    Json json = {{"stopped", to_string(report.reason)},
                 {"passes", or_null(report.passes)},
                 {"rounds", or_null(report.rounds)},
                 {"mended", report.mended},
                 {"spoiled", report.spoiled},
                 {"moved_interior_nodes", report.moved_interior_nodes},
                 {"moved_boundary_nodes", report.moved_boundary_nodes},
                 {"largest_move", report.largest_move},
                 {"coordinates_sha256", report.result_coordinates}};
    if (report.moves_boundary)
        json["boundary"] = {{"sliding_nodes", report.sliding_nodes},
                            {"free_nodes", report.free_nodes},
                            {"largest_distance", report.largest_boundary_distance}};
    return json;
}

}  // namespace

std::string to_json(const RunReport& report, const ReportPictures& pictures) {
    Json parameters = Json::object(), versions = Json::object(), timings = Json::object();
    for (const ReportParameter& parameter : report.parameters)
        parameters[parameter.name] = std::visit([](const auto& value) { return Json(value); }, parameter.value);
    for (const auto& [name, version] : report.versions) versions[name] = version;
    for (const auto& [name, seconds] : report.timings) timings[name] = seconds;
    const Json json = {
        {"report", "untangling"},
        {"format", 1},
        {"verdict", verdict(report)},
        {"input", input_json(report)},
        {"method", {{"name", report.method}, {"parameters", parameters}, {"command", or_null(report.command)}}},
        {"versions", versions},
        {"before", quality_json(report.before)},
        {"after", quality_json(report.after)},
        {"outcome", outcome_json(report)},
        {"groups", array_of(report.groups,
                            [](const ReportGroup& group) {
                                return Json{{"name", or_null(group.name)},
                                            {"dimension", group.dimension},
                                            {"elements", group.after.elements()},
                                            {"before", summary_json(group.before)},
                                            {"after", summary_json(group.after)}};
                            })},
        {"worst",
         {{"before", array_of(report.worst_before, element_json)},
          {"after", array_of(report.worst_after, element_json)}}},
        {"convergence",
         {{"passes", course_json(report.pass_count, report.pass_list, pass_json)},
          {"patches", course_json(report.patch_count, report.patch_list, patch_json)},
          {"rounds", course_json(report.round_count, report.round_list, round_json)}}},
        {"certificate",
         {{"all_valid", report.is_all_valid()},
          {"tolerance", report.certificate.tolerance},
          {"max_subdivisions", report.certificate.max_subdivisions},
          {"proved_least", or_null(report.proved_least)},
          {"proved_impossible", report.impossible},
          {"not_valid", array_of(report.not_valid, unproved_json)}}},
        {"pictures", {{"count", pictures.png.size()}, {"note", or_null(pictures.note)}}},
        {"run",
         {{"written", report.written},
          {"made_by",
           {{"program", "Curvewright"}, {"version", versions["Curvewright"]}, {"command", or_null(report.made_by)}}},
          {"remarks", report.remarks},
          {"timings", timings}}}};
    return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace curvewright
