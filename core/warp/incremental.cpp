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

void require_sensible(const IncrementOptions& increments) {
    if (increments.steps < 0 || increments.steps > 100000)
        throw InvalidInput(fmt::format("{} increments; expected 1 to 100000, or 0 for automatic.", increments.steps));
    if (!(increments.smallest_step > 0.0 && increments.smallest_step <= 1.0))
        throw InvalidInput(
            fmt::format("The smallest step is {}; it must be above 0 and at most 1.", increments.smallest_step));
}

/// One motion of the boundary in increments: what has been reached, and the step that is tried next.
class IncrementalMotion {
  public:
    IncrementalMotion(const CurvedMesh& mesh, const BoundaryPath& path, const WarpOptions& options,
                      const IncrementOptions& increments, const TaskContext& context)
        : mesh_(mesh),
          path_(path),
          options_(options),
          increments_(increments),
          progress_(context),
          is_automatic_(increments.steps == 0),
          step_(is_automatic_ ? 1.0 : 1.0 / increments.steps) {
        result_.coordinates = mesh.coordinates();
        result_.quality = assess_quality(mesh, quality_options_, context);
        require_valid(result_.quality, mesh.topology());
        quality_options_.orientation_sign = result_.quality.orientation_sign;
    }

    /// Steps until the motion is complete, a step fails for good, or the task is cancelled and the best is to be kept.
    IncrementalResult run(const IncrementObserver& observer) {
        try {
            while (report().fraction < 1.0 && take_step(observer)) {
            }
        } catch (const Cancelled&) {
            if (!increments_.keeps_best_on_cancel) throw;
            report().is_cancelled = true;
        }
        if (report().is_complete()) forget_failure();
        result_.report.neighbours_seconds = neighbours_seconds_;
        result_.report.weights_seconds = weights_seconds_;
        result_.report.solve_seconds = solve_seconds_;
        return std::move(result_);
    }

  private:
    IncrementReport& report() { return result_.increments; }

    /// Tries one step; false when it failed and no smaller one is to be tried.
    bool take_step(const IncrementObserver& observer) {
        const double target = next_target();
        const TaskContext inner = progress_.context_of_step(report().fraction, target);
        WarpResult moved = move_to(target, inner);
        QualityReport quality = assess_quality(mesh_.with_coordinates(moved.coordinates), quality_options_, inner);
        const bool is_accepted = is_valid(quality.summary);
        report().steps.push_back({target, quality.summary, is_accepted});
        if (observer) observer(report().steps.back(), moved.coordinates);
        result_.report = std::move(moved.report);
        if (!is_accepted) return shorten_step(target, quality);
        accept(target, std::move(moved.coordinates), std::move(quality));
        return true;
    }

    double next_target() {
        const int number = report().accepted + 1;
        const double target = is_automatic_ ? report().fraction + step_ : number * step_;
        return target > 1.0 - 1e-9 || number == increments_.steps ? 1.0 : target;
    }

    WarpResult move_to(double target, const TaskContext& inner) {
        if (!warper_) {
            warper_.emplace(mesh_.with_coordinates(result_.coordinates), options_, inner);
            neighbours_seconds_ += warper_->setup_report().neighbours_seconds;
            weights_seconds_ += warper_->setup_report().weights_seconds;
            solve_seconds_ += warper_->setup_report().solve_seconds;
        }
        WarpResult moved = warper_->move(path_(target), inner);
        solve_seconds_ += moved.report.solve_seconds - warper_->setup_report().solve_seconds;
        return moved;
    }

    void accept(double target, Coordinates coordinates, QualityReport quality) {
        report().fraction = target;
        ++report().accepted;
        result_.coordinates = std::move(coordinates);
        result_.quality = std::move(quality);
        if (increments_.recomputes_weights) warper_.reset();
        if (is_automatic_) step_ = std::min(2.0 * step_, 1.0 - report().fraction);
    }

    bool shorten_step(double target, const QualityReport& quality) {
        const Index worst = quality.worst(1).front();
        report().failed_fraction = target;
        report().failed_element = worst;
        report().failed_scaled_jacobian = quality.elements[worst].scaled_jacobian;
        if (!is_automatic_ || 0.5 * step_ < increments_.smallest_step) return false;
        step_ = 0.5 * (target - report().fraction);
        return true;
    }

    void forget_failure() {
        report().failed_element.reset();
        report().failed_fraction = report().failed_scaled_jacobian = 0.0;
    }

    const CurvedMesh& mesh_;
    const BoundaryPath& path_;
    const WarpOptions& options_;
    const IncrementOptions& increments_;
    QualityOptions quality_options_;
    StepProgress progress_;
    const bool is_automatic_;
    double step_;  ///< length of the next step, as a fraction of the whole motion
    std::optional<Warper> warper_;
    IncrementalResult result_;
    double neighbours_seconds_ = 0.0, weights_seconds_ = 0.0, solve_seconds_ = 0.0;
};

}  // namespace

IncrementalResult warp_in_increments(const CurvedMesh& mesh, const BoundaryPath& path, const WarpOptions& options,
                                     const IncrementOptions& increments, const TaskContext& context,
                                     const IncrementObserver& observer) {
    require_sensible(increments);
    return IncrementalMotion(mesh, path, options, increments, context).run(observer);
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
        "element {} (scaled Jacobian {:.3g}).",
        percent(report.fraction), percent(report.failed_fraction), report.accepted + 1,
        topology.element_tag(*report.failed_element).value, report.failed_scaled_jacobian);
}

}  // namespace curvewright
