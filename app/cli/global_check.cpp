#include "app/cli/global_check.h"

#include <fmt/format.h>

namespace curvewright::cli {
namespace {

Json facet_json(const CurvedMesh& mesh, Facet facet) {
    const Eigen::RowVector3d center = facet_center(mesh, facet);
    return {{"element", mesh.topology().element_tag(facet.element).value},
            {"facet", facet.local},
            {"center", {center[0], center[1], center[2]}}};
}

}  // namespace

GlobalCheck::GlobalCheck(const CurvedMesh& mesh, const QualityReport& quality, Work& work,
                         const BoundaryEmbedding* known)
    : report_(assess_global_validity(mesh, quality, {}, work.context(), known)) {
    work.end_phase("global");
    if (report_.boundary.answer != GlobalValidity::yes || report_.conformity != GlobalValidity::yes)
        work.note(report_.reason);
}

void GlobalCheck::add_to(Json& json, const CurvedMesh& mesh) const {
    json["globally_valid"] = to_string(report_.answer);
    json["globally_valid_reason"] = report_.reason;
    Json pairs = Json::array();
    for (const auto* list : {&report_.boundary.crossings, &report_.conflicts})
        for (const FacetPair& pair : *list) pairs.push_back({facet_json(mesh, pair.a), facet_json(mesh, pair.b)});
    json["crossing_facets"] = pairs;
    json["crossing_facet_pairs"] = report_.boundary.crossing_count + report_.conflict_count;
}

std::string GlobalCheck::line() const {
    return fmt::format("globally valid: {}", to_string(report_.answer));
}

int GlobalCheck::status() const {
    return report_.answer == GlobalValidity::no ? exit_not_valid : exit_done;
}

int GlobalCheck::boundary_status() const {
    return report_.boundary.answer == GlobalValidity::no ? exit_not_valid : exit_done;
}

std::optional<GlobalCheck> check_globally(const CurvedMesh& mesh, const Assessment& quality, Work& work) {
    if (!quality.report) return std::nullopt;
    return GlobalCheck(mesh, *quality.report, work);
}

}  // namespace curvewright::cli
