#include "core/warp/incremental.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/base/error.h"

namespace curvewright {
namespace {

bool is_valid(const QualitySummary& summary) {
    return summary.invalid == 0 && summary.undecided == 0;
}

void require_valid(const QualityReport& quality, const MeshTopology& topology) {
    if (is_valid(quality.summary)) return;
    const Index worst = quality.worst(1).front();
    throw InvalidInput(
        fmt::format("The mesh is not valid to begin with (element {} has scaled Jacobian {:.3g}), so there is no last "
                    "valid state to stop at; untangle it first, or warp it at once.",
                    topology.element_tag(worst).value, quality.elements[worst].scaled_jacobian));
}

/// The caller sees one task whose progress only grows: what is inside a step moves it within the step's share.
class StepProgress {
  public:
    explicit StepProgress(const TaskContext& context) : context_(context) {}
    TaskContext context_of_step(double from, double to) {
        TaskContext inner;
        inner.stop = context_.stop;
        if (context_.progress)
            inner.progress = [this, from, to](std::string_view, double fraction) {
                reached_ = std::max(reached_, from + (to - from) * std::clamp(fraction, 0.0, 1.0));
                context_.progress("Warping step by step", reached_);
            };
        return inner;
    }

  private:
    const TaskContext& context_;
    double reached_ = 0.0;
};

}  // namespace

IncrementalResult warp_in_increments(const CurvedMesh& mesh, const BoundaryPath& path, const WarpOptions& options,
                                     const IncrementOptions& increments, const TaskContext& context,
                                     const IncrementObserver& observer) {
    if (increments.steps < 0 || increments.steps > 100000)
        throw InvalidInput(fmt::format("{} increments; expected 1 to 100000, or 0 for automatic.", increments.steps));
    if (!(increments.smallest_step > 0.0 && increments.smallest_step <= 1.0))
        throw InvalidInput(
            fmt::format("The smallest step is {}; it must be above 0 and at most 1.", increments.smallest_step));
    QualityOptions quality_options;
    IncrementalResult result;
    result.coordinates = mesh.coordinates();
    result.quality = assess_quality(mesh, quality_options, context);
    require_valid(result.quality, mesh.topology());
    quality_options.orientation_sign = result.quality.orientation_sign;

    IncrementReport& report = result.increments;
    StepProgress progress(context);
    std::optional<Warper> warper;
    double neighbours = 0.0, weights = 0.0, solve = 0.0;
    const bool is_automatic = increments.steps == 0;
    double step = is_automatic ? 1.0 : 1.0 / increments.steps;
    while (report.fraction < 1.0) try {
            const int number = report.accepted + 1;
            double target = is_automatic ? report.fraction + step : number * step;
            if (target > 1.0 - 1e-9 || number == increments.steps) target = 1.0;
            const TaskContext inner = progress.context_of_step(report.fraction, target);
            if (!warper) {
                warper.emplace(mesh.with_coordinates(result.coordinates), options, inner);
                neighbours += warper->setup_report().neighbours_seconds;
                weights += warper->setup_report().weights_seconds;
                solve += warper->setup_report().solve_seconds;
            }
            WarpResult moved = warper->move(path(target), inner);
            solve += moved.report.solve_seconds - warper->setup_report().solve_seconds;
            QualityReport quality = assess_quality(mesh.with_coordinates(moved.coordinates), quality_options, inner);
            const bool is_accepted = is_valid(quality.summary);
            report.steps.push_back({target, quality.summary, is_accepted});
            if (observer) observer(report.steps.back(), moved.coordinates);
            result.report = std::move(moved.report);
            if (is_accepted) {
                report.fraction = target;
                ++report.accepted;
                result.coordinates = std::move(moved.coordinates);
                result.quality = std::move(quality);
                if (increments.recomputes_weights) warper.reset();
                if (is_automatic) step = std::min(2.0 * step, 1.0 - report.fraction);
                continue;
            }
            const Index worst = quality.worst(1).front();
            report.failed_fraction = target;
            report.failed_element = worst;
            report.failed_scaled_jacobian = quality.elements[worst].scaled_jacobian;
            if (!is_automatic || 0.5 * step < increments.smallest_step) break;
            step = 0.5 * (target - report.fraction);
        } catch (const Cancelled&) {
            if (!increments.keeps_best_on_cancel) throw;
            report.is_cancelled = true;
            break;
        }
    if (report.is_complete()) {
        report.failed_element.reset();
        report.failed_fraction = report.failed_scaled_jacobian = 0.0;
    }
    result.report.neighbours_seconds = neighbours;
    result.report.weights_seconds = weights;
    result.report.solve_seconds = solve;
    return result;
}

std::string describe(const IncrementReport& report, const MeshTopology& topology) {
    const auto percent = [](double fraction) { return fmt::format("{:.4g} %", 100.0 * fraction); };
    if (report.is_complete())
        return report.steps.size() == static_cast<std::size_t>(report.accepted)
                   ? fmt::format("The whole motion in {} {}.", report.accepted, report.accepted == 1 ? "step" : "steps")
                   : fmt::format("The whole motion in {} {} ({} tried).", report.accepted,
                                 report.accepted == 1 ? "step" : "steps", report.steps.size());
    if (report.is_cancelled)
        return fmt::format("Cancelled at {} of the motion, after {} {}.", percent(report.fraction), report.accepted,
                           report.accepted == 1 ? "step" : "steps");
    return fmt::format(
        "Stopped at {} of the motion, the last state without tangled elements: the step to {} (step {}) tangles "
        "element {} "
        "(scaled Jacobian {:.3g}).",
        percent(report.fraction), percent(report.failed_fraction), report.accepted + 1,
        topology.element_tag(*report.failed_element).value, report.failed_scaled_jacobian);
}

}  // namespace curvewright
