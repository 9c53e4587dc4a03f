#include "core/quality/global_validity.h"

#include <algorithm>
#include <optional>

#include <fmt/format.h>

#include "core/base/parallel.h"
#include "core/basis/reference_element.h"
#include "core/quality/boundary_chain.h"
#include "core/quality/box_tree.h"
#include "core/quality/facet_pairs.h"
#include "core/quality/winding_lines.h"

namespace curvewright {
namespace {

/// Cuts that every pair of facets is allowed at first; most pairs that are apart need none.
constexpr std::int64_t first_cuts = 300;
/// Facets that touch others which are examined for an overlap, at most.
constexpr std::size_t most_suspects = 400;

/// Two facets of the chain and what was found about them.
struct Finding {
    int f = 0, g = 0;
    FacetRelation relation = FacetRelation::apart;
};

/// All pairs that are not proved to be apart.
std::vector<Finding> compare_all(const BoundaryChain& chain, const BoxTree& tree, const GlobalValidityOptions& options,
                                 const TaskContext& context) {
    std::vector<std::vector<Finding>> found(static_cast<std::size_t>(chain.size()));
    parallel_for(found.size(), 64, context, "Comparing boundary facets", [&](std::size_t begin, std::size_t end) {
        FacetPairTest test(chain);
        std::vector<int> near;
        for (std::size_t facet = begin; facet < end; ++facet) {
            const int f = static_cast<int>(facet);
            near.assign(1, f);
            tree.visit([&](const Box& box) { return box.overlaps(chain[f].box); },
                       [&](int g) {
                           if (g > f) near.push_back(g);
                       });
            std::sort(near.begin(), near.end());
            for (const int g : near) {
                const FacetRelation relation = test.compare(f, g, first_cuts, context);
                if (relation != FacetRelation::apart) found[facet].push_back({f, g, relation});
            }
        }
    });
    std::vector<Finding> all;
    std::vector<std::size_t> open;
    for (const auto& own : found)
        for (const Finding& finding : own) {
            if (finding.relation == FacetRelation::undecided) open.push_back(all.size());
            all.push_back(finding);
        }
    if (open.empty()) return all;
    const std::int64_t cuts = options.most_cuts / static_cast<std::int64_t>(open.size());
    if (cuts > first_cuts)
        parallel_for(open.size(), 1, context, "Comparing close facets", [&](std::size_t begin, std::size_t end) {
            FacetPairTest test(chain);
            for (std::size_t k = begin; k < end; ++k) {
                Finding& finding = all[open[k]];
                finding.relation = test.compare(finding.f, finding.g, cuts, context);
            }
        });
    std::erase_if(all, [](const Finding& finding) { return finding.relation == FacetRelation::apart; });
    return all;
}

void list(std::vector<FacetPair>& pairs, Index& count, const FacetPair& pair, const GlobalValidityOptions& options) {
    ++count;
    if (pairs.size() < options.most_listed) pairs.push_back(pair);
}

std::string times(int count) {
    return fmt::format("{} {}", count, count == 1 ? "time" : "times");
}

/// The sentence about what was found, and the answer.
void conclude(BoundaryEmbedding& result, const MeshTopology& topology, const BoundaryChain& chain,
              const WindingOutcome& winding, bool touches) {
    if (result.crossing_count > 0) {
        result.answer = GlobalValidity::no;
        if (!chain.doubled().empty())
            result.reason =
                fmt::format("The mesh overlaps itself: {} lie on each other with both elements on the same side.",
                            describe(topology, result.crossings.front()));
        else if (const FacetPair& first = result.crossings.front();
                 first.a.element == first.b.element && first.a.local == first.b.local)
            result.reason = fmt::format("The boundary crosses itself: {} does.", describe(topology, first));
        else
            result.reason = fmt::format("The boundary crosses itself: {} cross.", describe(topology, first));
        if (result.crossing_count > 1) {
            result.reason.pop_back();
            result.reason += fmt::format(", the first of {} pairs.", result.crossing_count);
        }
        return;
    }
    if (winding.fault) {
        result.answer = GlobalValidity::no;
        const Facet facet = chain[winding.fault->facet].facet;
        const FacetPair pair{facet, facet};
        result.reason =
            winding.fault->winding > 1
                ? fmt::format("The mesh overlaps itself: beside {}, the boundary encloses the same points {}.",
                              describe(topology, pair), times(winding.fault->winding))
                : fmt::format("The boundary is inside out: beside {}, it winds {} the wrong way round.",
                              describe(topology, pair), times(-winding.fault->winding));
        return;
    }
    if (result.unsettled_count > 0) {
        const std::string first = describe(topology, result.unsettled.front());
        result.reason = touches ? fmt::format(
                                      "The boundary touches itself, up to rounding: {}; whether it crosses itself "
                                      "there is not proved.",
                                      first)
                                : fmt::format("Whether {} cross was not found within the work that is allowed.", first);
        if (result.unsettled_count > 1) {
            result.reason.pop_back();
            result.reason += fmt::format(" ({} pairs in all).", result.unsettled_count);
        }
        return;
    }
    if (winding.unsettled_components > 0) {
        const Facet facet = chain[winding.first_unsettled].facet;
        result.reason = fmt::format("How often the boundary winds around the points beside {} was not found.",
                                    describe(topology, {facet, facet}));
        return;
    }
    result.answer = GlobalValidity::yes;
    result.reason = "The boundary does not cross itself and bounds its inside once.";
}

void require_flat_or_solid(const MeshTopology& topology) {
    if (topology.dimension() < 2)
        throw Unsupported("Whether a mesh is valid as a whole is told of meshes of surface or volume elements only.");
}

/// Elements numbered against their component's majority.
std::vector<bool> reversed_elements(const MeshTopology& topology) {
    const std::vector<char>& is_reversed = topology.winding().is_reversed;
    return {is_reversed.begin(), is_reversed.end()};
}

GlobalValidity judge_elements(const MeshTopology& topology, const QualityReport& quality, std::string& reason) {
    Index undecided = -1;
    for (Index element = 0; element < topology.element_count(); ++element) {
        const Validity validity = quality.elements[static_cast<std::size_t>(element)].validity;
        if (validity == Validity::invalid) {
            reason = fmt::format("{} of {} elements {} tangled; the first is element {}.", quality.summary.invalid,
                                 topology.element_count(), quality.summary.invalid == 1 ? "is" : "are",
                                 topology.element_tag(element).value);
            return GlobalValidity::no;
        }
        if (validity != Validity::valid && undecided < 0) undecided = element;
    }
    if (undecided < 0) return GlobalValidity::yes;
    if (quality.summary.undecided == 0) {
        reason = fmt::format("{} of {} elements {} not assessed.", quality.summary.not_assessed,
                             topology.element_count(), quality.summary.not_assessed == 1 ? "was" : "were");
        return GlobalValidity::undecided;
    }
    reason = fmt::format("Whether J > 0 everywhere in element {} is not known.", topology.element_tag(undecided).value);
    return GlobalValidity::undecided;
}

const char* sentence_of(FacetConflict::Kind kind) {
    switch (kind) {
        case FacetConflict::Kind::shared_by_many:
            return "More than two elements share a facet: {}.";
        case FacetConflict::Kind::other_order:
            return "Neighbours have the nodes of their common facet in different order: {}.";
        case FacetConflict::Kind::same_side:
            return "Neighbours lie on the same side of their common facet: {}.";
    }
    return "{}";
}

GlobalValidity judge_facets(const MeshTopology& topology, GlobalValidityReport& report, std::string& reason,
                            const GlobalValidityOptions& options) {
    for (const FacetPair& pair : report.boundary.unmatched) report.conflicts.push_back(pair);
    report.conflict_count = report.boundary.unmatched_count;
    if (report.conflict_count > 0)
        reason = fmt::format("Facets with the same corners do not match, being of different order: {}.",
                             describe(topology, report.conflicts.front()));
    for (const FacetConflict& conflict : find_facet_conflicts(topology, reversed_elements(topology))) {
        list(report.conflicts, report.conflict_count, {conflict.a, conflict.b}, options);
        if (reason.empty())
            reason =
                fmt::format(fmt::runtime(sentence_of(conflict.kind)), describe(topology, report.conflicts.front()));
    }
    return report.conflict_count > 0 ? GlobalValidity::no : GlobalValidity::yes;
}

}  // namespace

const char* to_string(GlobalValidity answer) {
    switch (answer) {
        case GlobalValidity::yes:
            return "yes";
        case GlobalValidity::no:
            return "no";
        case GlobalValidity::undecided:
            return "undecided";
    }
    return "";
}

std::string describe(const MeshTopology& topology, const FacetPair& pair) {
    const auto one = [&](Facet facet) {
        return fmt::format("facet {} of element {}", facet.local, topology.element_tag(facet.element).value);
    };
    if (pair.a.element == pair.b.element && pair.a.local == pair.b.local) return one(pair.a);
    return one(pair.a) + " and " + one(pair.b);
}

Eigen::RowVector3d facet_center(const CurvedMesh& mesh, Facet facet) {
    const MeshTopology& topology = mesh.topology();
    const SubElement& cell = reference_element(topology.element_type(facet.element)).facets[facet.local];
    const auto nodes = topology.element_nodes(facet.element);
    Eigen::RowVector3d center = Eigen::RowVector3d::Zero();
    const int corners = corner_count(cell.type.shape);
    for (int k = 0; k < corners; ++k) center += mesh.coordinates().row(nodes[cell.nodes[k]]) / corners;
    return center;
}

BoundaryEmbedding assess_boundary_embedding(const CurvedMesh& mesh, const OrientationSigns& signs,
                                            const GlobalValidityOptions& options, const TaskContext& context) {
    const MeshTopology& topology = mesh.topology();
    require_flat_or_solid(topology);
    const BoundaryChain chain(mesh, signs, context);
    std::vector<Box> boxes;
    for (int facet = 0; facet < chain.size(); ++facet) boxes.push_back(chain[facet].box);
    const BoxTree tree(std::move(boxes));
    BoundaryEmbedding result;
    for (const auto& [a, b] : chain.doubled()) list(result.crossings, result.crossing_count, {a, b}, options);
    for (const auto& [a, b] : chain.unmatched()) list(result.unmatched, result.unmatched_count, {a, b}, options);
    bool touches = false;
    std::vector<int> suspects;
    for (const Finding& finding : compare_all(chain, tree, options, context)) {
        const FacetPair pair{chain[finding.f].facet, chain[finding.g].facet};
        if (finding.relation == FacetRelation::crossing) {
            list(result.crossings, result.crossing_count, pair, options);
        } else {
            touches = touches || (result.unsettled.empty() && finding.relation == FacetRelation::touching);
            list(result.unsettled, result.unsettled_count, pair, options);
            if (suspects.size() < most_suspects) suspects.insert(suspects.end(), {finding.f, finding.g});
        }
    }
    const WindingOutcome winding =
        result.crossing_count > 0 ? WindingOutcome{} : WindingLines(chain, tree).follow(suspects, context);
    conclude(result, topology, chain, winding, touches);
    return result;
}

bool has_same_boundary(const MeshTopology& topology, const Coordinates& a, const Coordinates& b) {
    return std::all_of(topology.boundary_nodes().begin(), topology.boundary_nodes().end(),
                       [&](Index node) { return a.row(node) == b.row(node); });
}

GlobalValidityReport assess_global_validity(const CurvedMesh& mesh, const QualityReport& quality,
                                            const GlobalValidityOptions& options, const TaskContext& context,
                                            const BoundaryEmbedding* known) {
    const MeshTopology& topology = mesh.topology();
    if (quality.elements.size() != static_cast<std::size_t>(topology.element_count()))
        throw InvalidInput(fmt::format("The quality report is of {} elements; the mesh has {}.",
                                       quality.elements.size(), topology.element_count()));
    GlobalValidityReport report;
    std::string elements_reason, conformity_reason;
    report.elements = judge_elements(topology, quality, elements_reason);
    report.boundary =
        known != nullptr ? *known : assess_boundary_embedding(mesh, quality.orientation_sign, options, context);
    report.conformity = judge_facets(topology, report, conformity_reason, options);
    context.check();

    const std::array<std::pair<GlobalValidity, const std::string*>, 3> parts{
        {{report.boundary.answer, &report.boundary.reason},
         {report.conformity, &conformity_reason},
         {report.elements, &elements_reason}}};
    for (const GlobalValidity worst : {GlobalValidity::no, GlobalValidity::undecided})
        for (const auto& [answer, reason] : parts)
            if (answer == worst && report.reason.empty()) {
                report.answer = worst;
                report.reason = *reason;
            }
    if (!report.reason.empty()) return report;
    report.answer = GlobalValidity::yes;
    report.reason = "Every element is valid, facets match, and the boundary does not cross itself.";
    return report;
}

}  // namespace curvewright
