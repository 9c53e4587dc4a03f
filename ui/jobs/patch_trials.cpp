#include "ui/jobs/patch_trials.h"

#include <algorithm>
#include <cmath>

#include <QMetaObject>

#include "core/base/error.h"

namespace curvewright {
namespace {

Eigen::RowVector3d row(const untangle_event::Position& position) {
    return {position[0], position[1], position[2]};
}

/// Half the side of the landscape: what the node has gone and will go fits, and there is something to be seen around.
double half_side(const TrialRequest& request, const PatchTrial::Outcome& outcome) {
    const StepExplanation& step = *request.step;
    const Eigen::RowVector3d center = row(step.focus_start);
    double extent = (outcome.position - center).norm();
    for (const auto& position : step.path) extent = std::max(extent, (row(position) - center).norm());
    double length = step.edge_length;
    if (!(length > 0.0)) {
        // The size of the elements at the node.
        const MeshTopology& topology = request.mesh->topology();
        Eigen::RowVector3d lower = center, upper = center;
        for (const Index node : topology.element_nodes(step.worst_element)) {
            lower = lower.cwiseMin(request.mesh->coordinates().row(node));
            upper = upper.cwiseMax(request.mesh->coordinates().row(node));
        }
        length = (upper - lower).maxCoeff();
    }
    return std::max(1.25 * extent, 0.35 * length);
}

}  // namespace

TrialResult PatchTrials::answer(const TrialRequest& request, const TaskContext& context) {
    const StepExplanation& step = *request.step;
    UntangleOptions options = request.options;
    // A trace does not tell them, but only with a weight of its own for every edge are several nodes a patch.
    if (*step.method == UntangleMethod::signed_angles && !std::holds_alternative<SignedAngleOptions>(options) &&
        step.nodes.size() > 1)
        options = SignedAngleOptions{.beta_choice = BetaChoice::automatic};
    PatchTrial trial(*request.mesh, request.orientation_sign, *step.method, options, step.elements, *step.focus,
                     row(step.focus_start), request.start->coordinates());
    TrialResult result;
    result.parameters = request.parameters;
    result.focus = *step.focus;
    result.step = step.step;
    result.outcome = trial.outcome(request.parameters);
    context.check();
    const double half = half_side(request, result.outcome);
    result.landscape = trial.landscape(row(step.focus_start), half * request.across, half * request.up, resolution,
                                       request.parameters, context);
    result.levels = even_levels(result.landscape.values, level_count);
    for (const double level : result.levels) {
        context.check();
        result.contours.push_back(contour_lines(result.landscape.values, level));
    }
    return result;
}

PatchTrials::PatchTrials(QObject* parent) : QObject(parent) {
    pool_.setMaxThreadCount(1);
}

PatchTrials::~PatchTrials() {
    stop_.request_stop();
    pool_.waitForDone();
}

void PatchTrials::ask(TrialRequest request) {
    next_ = std::move(request);
    stop_.request_stop();
    if (!is_running_) start();
}

void PatchTrials::cancel() {
    next_.reset();
    stop_.request_stop();
}

void PatchTrials::start() {
    is_running_ = true;
    stop_ = {};
    pool_.start([this, request = std::move(*next_), token = stop_.get_token()] {
        std::shared_ptr<const TrialResult> result;
        try {
            result = std::make_shared<const TrialResult>(answer(request, {token, {}}));
        } catch (const Error&) {
            // Too late, or nothing that can be tried.
        }
        QMetaObject::invokeMethod(this, [this, result, token] {
            is_running_ = false;
            if (!token.stop_requested()) emit answered(result);
            if (next_ && !is_running_) start();
        });
    });
    next_.reset();
}

}  // namespace curvewright
