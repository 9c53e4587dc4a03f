#include "core/untangle/patch_work.h"

#include <algorithm>

#include "core/untangle/standing.h"

namespace curvewright {
namespace {

std::vector<untangle_event::Position> event_positions(const std::vector<Index>& nodes, const Coordinates& x) {
    std::vector<untangle_event::Position> result;
    for (const Index node : nodes) result.push_back({x(node, 0), x(node, 1), x(node, 2)});
    return result;
}

/// Multiplications, but for a factor, of one evaluation of an element's objective: samples × nodes × dimensions.
double evaluation_cost(ElementType type) {
    const int dim = dimension(type.shape), degree = std::clamp(dim * (type.order - 1), 1, max_order);
    return static_cast<double>(node_count({type.shape, degree})) * node_count(type) * dim;
}

}  // namespace

PatchWork::PatchWork(const CurvedMesh& mesh, const BoundaryRules& boundary, const NodeRules& nodes,
                     UntangleObserver* observer, const TaskContext& context)
    : mesh_(mesh),
      topology_(mesh.topology()),
      observer_(observer),
      context_(context),
      node_elements_(elements_of_nodes(mesh.topology())),
      kept_(nodes, mesh.topology()) {
    state_.coordinates = mesh.coordinates();
    if (boundary.is_all_fixed()) {
        resolve(boundary, topology_);  // the groups must exist all the same
    } else {
        boundary_.emplace(mesh, boundary);
        for (Index node = 0; node < topology_.node_count(); ++node) state_.feet.push_back(boundary_->foot(node));
    }
}

void PatchWork::assess() {
    const QualityReport report = assess_quality(mesh_, quality_options_, context_);
    quality_options_.orientation_sign = report.orientation_sign;
    state_.qualities = report.elements;
}

ConstrainedObjective PatchWork::make_objective(const FreePatch& patch) const {
    return ConstrainedObjective(
        PatchObjective(topology_, state_.coordinates, mesh_.coordinates(), orientation_sign(), patch), boundary(),
        state_.coordinates, feet_of(patch.nodes, state_.feet), limit_ ? &*limit_ : nullptr);
}

double PatchWork::cost_of(const std::vector<FreePatch>& patches) const {
    double cost = 0.0;
    for (const FreePatch& patch : patches)
        for (const Index element : patch.elements) cost += evaluation_cost(topology_.element_type(element));
    return cost;
}

void PatchWork::end_pass() const {
    if (!observer_) return;
    untangle_event::PassEnded event;
    event.pass = pass_;
    event.coordinates = &state_.coordinates;
    const double norm = state_.coordinates.norm();
    event.relative_change = norm > 0.0 ? (state_.coordinates - mesh_.coordinates()).norm() / norm : 0.0;
    event.min_scaled_jacobian = Standing(state_.qualities).least;
    for (const ElementQuality& quality : state_.qualities) {
        event.invalid += quality.validity == Validity::invalid ? 1 : 0;
        event.undecided += quality.validity == Validity::undecided ? 1 : 0;
    }
    observer_->on_event(event);
}

std::vector<ElementQuality> PatchRun::certify() const {
    std::vector<ElementQuality> now = work_.certify(patch_);
    if (work_.observer()) {
        const Standing standing(now);
        work_.tell(untangle_event::PatchCertified{round_, standing.not_valid, standing.least,
                                                  patch_.elements[standing.worst], now[standing.worst].worst_point});
    }
    return now;
}

bool PatchRun::is_within_limit() const {
    const auto& limit = work_.move_limit();
    return !limit || std::all_of(patch_.nodes.begin(), patch_.nodes.end(), [&](Index node) {
        return (state_.coordinates.row(node) - limit->read->row(node)).norm() <= limit->distance;
    });
}

void PatchRun::began() const {
    if (work_.observer())
        work_.tell(untangle_event::PatchBegan{patch_.nodes, patch_.elements,
                                              event_positions(patch_.nodes, state_.coordinates)});
}

void PatchRun::ended() const {
    if (!work_.observer()) return;
    untangle_event::PatchEnded event;
    event.nodes = patch_.nodes;
    event.positions = event_positions(patch_.nodes, state_.coordinates);
    event.iterations = iterations_;
    event.objective_before = objective_before_;
    event.objective_after = objective_after_;
    event.min_scaled_jacobian_before = least_before_;
    event.min_scaled_jacobian_after = best_.standing().least;
    work_.tell(event);
}

void PatchRun::tell_step(ConstrainedObjective& objective, const Eigen::VectorXd& variables, double value, int iteration,
                         const DistortionOptions& distortion) {
    objective.store(variables, state_.coordinates);
    work_.tell(untangle_event::EnergyStep{round_, iteration, value, distortion.eps, distortion.sharpness,
                                          objective.least_determinant(),
                                          event_positions(patch_.nodes, state_.coordinates)});
}

}  // namespace curvewright
