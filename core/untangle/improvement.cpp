#include "core/untangle/improvement.h"

#include <algorithm>
#include <optional>

#include <fmt/format.h>

#include "core/quality/shape_quality.h"
#include "core/untangle/standing.h"

namespace curvewright {
namespace {

/// The work on one patch.
class ImprovingRun : PatchRun {
  public:
    ImprovingRun(PatchWork& work, const FreePatch& patch, const ImprovementOptions& options)
        : PatchRun(work, patch), options_(options) {}

    void run() {
        guard([this] { options_.goal == ImproveGoal::shape ? improve_shape() : improve_to_floor(); });
    }

  private:
    /// Has the positions judged and keeps them if they are the best so far.
    void judge(const ConstrainedObjective& objective, double shape) {
        const std::vector<ElementQuality> now = certify();
        const std::vector<Foot> feet = objective.feet(variables_);
        const double floor = options_.shape_floor;
        if (!is_within_limit()) return;
        if (shape >= std::min(floor, worst_shape_at_start_)) best_.offer(state_.coordinates, feet, now);
        if (above_floor_ && shape >= floor && above_floor_->offer(state_.coordinates, feet, now))
            is_above_floor_ = true;
    }

    void improve_to_floor() {
        double shape_weight = options_.shape_weight;
        if (options_.shape_floor > 0.0) {
            shape_.emplace(work_.topology(), patch_.elements, work_.mesh().coordinates());
            worst_shape_at_start_ = shape_->worst(state_.coordinates);
            above_floor_ = best_;
            is_above_floor_ = worst_shape_at_start_ >= options_.shape_floor;
        }
        constexpr double largest_weight = 100.0, factor = 4.0;
        while (!improve_with(shape_weight) && shape_weight < largest_weight) {
            shape_weight *= factor;
            best_.restore(state_);
        }
        if (is_above_floor_) best_ = *above_floor_;
    }

    /// Minimises, puts the nodes there and gives the worst shape, if there is a floor (else 1).
    double advance(ConstrainedObjective& objective, const DistortionOptions& distortion, const LbfgsOptions& lbfgs) {
        minimize(objective, distortion, lbfgs, [] { return true; });
        objective.recentre(variables_);
        objective.store(variables_, state_.coordinates);
        return shape_ ? shape_->worst(state_.coordinates) : 1.0;
    }

    /// Small patches go on until another unit or origin leads to the same minimum; large ones would take long.
    double relative_decrease() const { return std::clamp(5e-12 * work_.cost_of({patch_}), 1e-6, 3e-5); }

    /// Whether the shape is above the floor at the end.
    bool improve_with(double shape_weight) {
        ConstrainedObjective objective = work_.make_objective(patch_);
        variables_ = objective.start();
        DistortionOptions distortion;
        Eigen::VectorXd gradient;
        LbfgsOptions lbfgs;
        lbfgs.first_step = 1e-3;
        lbfgs.max_iterations = 50;
        if (work_.observer()) objective_before_ = objective.evaluate(variables_, distortion, gradient);
        double shape = advance(objective, distortion, lbfgs);  // the energy alone: evens the patch out
        judge(objective, shape);
        lbfgs.max_iterations = 600;
        lbfgs.relative_decrease = relative_decrease();
        lbfgs.history = 10;
        distortion.energy_weight = shape_weight;
        distortion.mean_weight = options_.mean_weight;
        for (const double sharpness : {20.0, 40.0, 80.0, 160.0, 320.0}) {
            distortion.sharpness = sharpness;
            shape = advance(objective, distortion, lbfgs);
            judge(objective, shape);
        }
        if (work_.observer()) objective_after_ = objective.evaluate(variables_, DistortionOptions{}, gradient);
        return shape >= options_.shape_floor;
    }

    /// The worst mean ratio rises by minimising a mean of higher and higher power of its inverse; every state that is
    /// taken is certified valid.
    void improve_shape() {
        shape_.emplace(work_.topology(), patch_.elements, work_.mesh().coordinates());
        double best_shape = worst_shape_at_start_ = shape_->worst(state_.coordinates);
        ConstrainedObjective objective = work_.make_objective(patch_);
        variables_ = objective.start();
        DistortionOptions distortion;
        Eigen::VectorXd gradient;
        LbfgsOptions lbfgs;
        lbfgs.first_step = 1e-3;
        lbfgs.max_iterations = 50;
        if (work_.observer()) objective_before_ = objective.evaluate(variables_, distortion, gradient);
        const auto judge_shape = [&](double shape) {
            std::vector<ElementQuality> now = certify();
            if (!(shape > best_shape) || !is_within_limit() || !std::all_of(now.begin(), now.end(), is_valid)) return;
            best_shape = shape;
            best_.take(state_.coordinates, objective.feet(variables_), std::move(now));
        };
        judge_shape(advance(objective, distortion, lbfgs));
        lbfgs.max_iterations = 300;
        lbfgs.relative_decrease = relative_decrease();
        lbfgs.history = 10;
        distortion.theta = 0.0;
        distortion.eps = 1e-6;
        for (const double power : {2.0, 4.0, 8.0, 16.0, 32.0, 64.0}) {
            distortion.power = power;
            distortion.reference = 1.0 / std::max(best_shape, 1e-3);
            judge_shape(advance(objective, distortion, lbfgs));
        }
        if (work_.observer()) objective_after_ = objective.evaluate(variables_, DistortionOptions{}, gradient);
    }

    const ImprovementOptions& options_;
    std::optional<BestOfPatch> above_floor_;  ///< if there is a floor: not below it; best_ is not below the floor, or
                                              ///< the shape at the start if that is lower
    bool is_above_floor_ = false;
    std::optional<PatchShape> shape_;  ///< if it counts
    double worst_shape_at_start_ = 1.0;
};

}  // namespace

void Improvement::run() {
    options_.is_thorough ? run_thoroughly() : run_within_work();
}

void Improvement::run_within_work() {
    std::vector<Index> seeds = elements_to_improve();
    std::vector<FreePatch> patches = patches_to_improve(seeds);
    const bool is_limited = work_.cost_of(patches) > options_.work;
    constexpr int max_passes = 3;
    for (int pass = 0; pass < (is_limited ? max_passes : 1) && !patches.empty(); ++pass) {
        if (is_limited) patches = patches_to_improve(worst_within_limit(seeds));
        const double least_before = least();
        improve(patches, "Improving");
        if (least() <= least_before) break;
        if (is_limited) seeds = elements_to_improve();
    }
}

void Improvement::run_thoroughly() {
    constexpr int max_sweeps = 3;
    constexpr double worthwhile = 1e-3;
    for (int sweep = 0; sweep < max_sweeps; ++sweep) {
        const double least_before = least();
        std::vector<char> is_done(static_cast<std::size_t>(work_.topology().element_count()), 0);
        while (run_on_worst(is_done)) continue;
        if (least() < least_before + worthwhile) break;
    }
}

bool Improvement::run_on_worst(std::vector<char>& is_done) {
    std::vector<Index> seeds = elements_to_improve();
    std::erase_if(seeds, [&](Index element) { return is_done[element] != 0; });
    if (seeds.empty()) return false;
    std::vector<FreePatch> patches = patches_to_improve(seeds);
    if (work_.cost_of(patches) > options_.work) {
        seeds = worst_within_limit(seeds);
        patches = patches_to_improve(seeds);
    }
    for (const Index element : seeds) is_done[element] = 1;
    if (!patches.empty()) improve(patches, fmt::format("Improving, pass {}", work_.pass() + 1));
    return true;
}

void Improvement::improve(const std::vector<FreePatch>& patches, std::string_view phase) {
    work_.begin_pass();
    work_.context().report(phase, 0.0);
    work_.for_each_patch(patches, phase, [&](std::size_t i) { ImprovingRun(work_, patches[i], options_).run(); });
    work_.end_pass();
}

std::vector<double> Improvement::values() const {
    if (options_.goal == ImproveGoal::shape)
        return element_shapes(work_.mesh().with_coordinates(work_.state().coordinates), work_.mesh().coordinates(),
                              {work_.context().stop, {}});
    std::vector<double> result;
    for (const ElementQuality& quality : work_.state().qualities) result.push_back(quality.scaled_jacobian);
    return result;
}

double Improvement::least() const {
    if (options_.goal == ImproveGoal::jacobian) return Standing(work_.state().qualities).least;
    const std::vector<double> all = values();
    return all.empty() ? 1.0 : *std::min_element(all.begin(), all.end());
}

std::vector<Index> Improvement::elements_to_improve() const {
    const std::vector<double> value = values();
    std::vector<Index> seeds;
    for (Index element = 0; element < work_.topology().element_count(); ++element)
        if (is_valid(work_.state().qualities[element]) && value[element] < options_.target) seeds.push_back(element);
    std::stable_sort(seeds.begin(), seeds.end(), [&](Index a, Index b) { return value[a] < value[b]; });
    return seeds;
}

/// What could not be mended stays as it is, with its nodes: its neighbours would be bent for nothing.
std::vector<FreePatch> Improvement::patches_to_improve(const std::vector<Index>& seeds) const {
    return make_patches(
        work_.topology(), work_.node_elements(), seeds, options_.layers,
        [this](Index node) { return work_.may_move(node); },
        [this](Index element) { return !is_valid(work_.state().qualities[element]); });
}

std::vector<Index> Improvement::worst_within_limit(const std::vector<Index>& seeds) const {
    std::size_t fits = 1, too_many = seeds.size() + 1;
    while (fits + 1 < too_many) {
        const std::size_t middle = (fits + too_many) / 2;
        const bool is_within =
            work_.cost_of(patches_to_improve({seeds.begin(), seeds.begin() + static_cast<std::ptrdiff_t>(middle)})) <=
            options_.work;
        (is_within ? fits : too_many) = middle;
    }
    return {seeds.begin(), seeds.begin() + static_cast<std::ptrdiff_t>(std::min(fits, seeds.size()))};
}

}  // namespace curvewright
