#include "core/untangle/guaranteed.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <string>

#include <fmt/format.h>

#include "core/base/error.h"
#include "core/base/stopwatch.h"
#include "core/mesh/conformity.h"
#include "core/mesh/renumbering.h"
#include "core/untangle/improvement.h"
#include "core/untangle/patch_work.h"
#include "core/untangle/standing.h"
#include "core/untangle/unmendable.h"

namespace curvewright {
namespace {

/// Per element: why it cannot be had; looked for in those that began not valid.
using Impossibilities = std::vector<std::optional<Impossibility>>;

/// The work on one patch until the certificates say valid.
class MendingRun : PatchRun {
  public:
    MendingRun(PatchWork& work, const FreePatch& patch, const Impossibilities& impossible, int max_rounds)
        : PatchRun(work, patch), impossible_(impossible), max_rounds_(max_rounds) {}

    /// Minimisations made.
    int run() {
        guard([this] { untangle_rounds(); });
        return round_;
    }

  private:
    /// Has the positions judged and keeps them if they are the best so far.
    std::vector<ElementQuality> judge(const ConstrainedObjective& objective) {
        std::vector<ElementQuality> now = certify();
        best_.offer(state_.coordinates, objective.feet(variables_), now);
        return now;
    }

    void untangle_rounds() {
        FreePatch active = patch_;
        std::erase_if(active.elements, [this](Index e) { return impossible_[e].has_value(); });
        ConstrainedObjective objective = work_.make_objective(active);
        variables_ = objective.start();
        Eigen::VectorXd gradient;
        DistortionOptions distortion;
        distortion.eps = 1.0;
        objective_before_ = objective.evaluate(variables_, distortion, gradient);
        double least = objective.least_determinant(), best_least = least;
        int rounds_without_gain = 0;
        double margin = 1e-3;
        int failed_certificates = 0;
        constexpr int patience = 20;
        while (round_ < max_rounds_ && rounds_without_gain < patience) {
            work_.context().check();
            // Garanzha et al. 2021, section 3: eps follows the least determinant.
            distortion.eps = std::sqrt(1e-6 + 0.04 * std::pow(std::min(0.0, least), 2));
            LbfgsOptions lbfgs;
            lbfgs.max_iterations = 10 + round_;
            minimize(objective, distortion, lbfgs, [&] { return objective.least_determinant() <= margin; });
            objective.recentre(variables_);
            objective.evaluate(variables_, distortion, gradient);
            least = objective.least_determinant();
            const bool gains = least > best_least + 1e-3 * std::abs(best_least);
            best_least = std::max(best_least, least);
            rounds_without_gain = gains ? 0 : rounds_without_gain + 1;
            if (least <= 0.0 && rounds_without_gain < patience && round_ < max_rounds_) continue;
            objective.store(variables_, state_.coordinates);
            const std::vector<ElementQuality> now = judge(objective);
            bool is_done = true;
            std::size_t number = 0;  // among the active elements
            for (std::size_t i = 0; i < now.size(); ++i) {
                if (impossible_[patch_.elements[i]]) continue;
                if (!is_valid(now[i])) {
                    objective.add_sample(number, now[i].worst_point);
                    is_done = false;
                }
                ++number;
            }
            if (is_done) break;
            // Where positive samples keep on hiding what is not between them, a wider berth helps.
            if (++failed_certificates > 1) margin = std::min(0.1, 2.0 * margin);
        }
        if (!work_.observer()) return;
        distortion.eps = 1.0;
        objective_after_ = objective.evaluate(variables_, distortion, gradient);
    }

    const Impossibilities& impossible_;
    const int max_rounds_;
};

class Untangler {
  public:
    Untangler(const CurvedMesh& mesh, const GuaranteedOptions& options, UntangleObserver* observer,
              const TaskContext& context)
        : work_(mesh, options.boundary, options.nodes, observer, context), options_(options) {}

    GuaranteedResult run() {
        work_.tell(untangle_event::Started{&work_.mesh()});
        try {
            work();
        } catch (const Cancelled&) {
            if (!options_.keeps_best_on_cancel) throw;
            result_.reason = StopReason::cancelled;
        }
        MeshState& state = work_.state();
        if (!state.qualities.empty()) list_unmended();
        if (const BoundaryShape* boundary = work_.boundary()) {
            result_.sliding_nodes = boundary->sliding_nodes();
            result_.free_nodes = boundary->free_nodes();
            result_.largest_boundary_distance = boundary->largest_distance(state.coordinates);
        }
        work_.tell(untangle_event::Finished{result_.reason, work_.pass()});
        result_.coordinates = std::move(state.coordinates);
        return std::move(result_);
    }

  private:
    void work() {
        work_.assess();
        impossible_.resize(work_.state().qualities.size());
        const std::vector<Index> damaged = work_.elements_where(is_in_need);
        if (damaged.empty()) return;  // a valid mesh is not changed; see improve()
        for (const Index element : damaged)
            impossible_[element] = find_impossibility(
                work_.mesh(), element, work_.orientation_sign(), work_.node_elements(),
                [this](Index node) { return work_.may_move(node); },
                [this](Index other) { return impossible_[other].has_value(); });
        const Stopwatch watch;
        make_valid();
        result_.valid_seconds = watch.seconds();
        const Stopwatch improving;
        if (options_.improves) Improvement(work_, improvement_options()).run();
        result_.improve_seconds = improving.seconds();
    }

    ImprovementOptions improvement_options() const {
        ImprovementOptions result;
        result.target = options_.target;
        result.layers = options_.layers;
        result.work = options_.improve_work;
        result.shape_weight = options_.shape_weight;
        result.mean_weight = options_.mean_weight;
        result.shape_floor = options_.shape_floor;
        return result;
    }

    /// Not valid, and not proved to be impossible.
    std::vector<Index> mendable() const {
        std::vector<Index> result = work_.elements_where(is_in_need);
        std::erase_if(result, [this](Index element) { return impossible_[element].has_value(); });
        return result;
    }

    /// First stage: until the certificates say valid.
    void make_valid() {
        std::vector<Index> seeds = mendable();
        const std::size_t at_start = seeds.size();
        std::vector<FreePatch> tried;
        for (int layers = options_.layers; !seeds.empty() && layers <= options_.max_layers; layers *= 2) {
            std::vector<FreePatch> patches = make_patches(
                work_.topology(), work_.node_elements(), seeds, layers,
                [this](Index node) { return work_.may_move(node); },
                [this](Index element) {
                    return work_.state().qualities[element].validity == Validity::not_assessed;
                });
            // A patch that could not grow would do the same again.
            std::erase_if(patches, [&](const FreePatch& patch) {
                return std::any_of(tried.begin(), tried.end(),
                                   [&](const FreePatch& other) { return other.elements == patch.elements; });
            });
            if (patches.empty()) break;
            work_.begin_pass();
            std::vector<int> rounds(patches.size(), 0);
            work_.for_each_patch(patches, {}, [&](std::size_t i) {
                rounds[i] = MendingRun(work_, patches[i], impossible_, options_.max_rounds).run();
            });
            for (const int count : rounds) result_.rounds += count;
            work_.end_pass();
            seeds = mendable();
            tried = std::move(patches);
            work_.context().report("Making elements valid",
                                   1.0 - static_cast<double>(seeds.size()) / static_cast<double>(at_start));
        }
    }

    void list_unmended() {
        list_not_valid();
        if (result_.unmended.empty() || work_.topology().interface_nodes().empty()) return;
        const auto names = names_of_interface_nodes(work_.topology());
        for (UnmendedElement& unmended : result_.unmended) {
            std::set<std::string> in_the_way;
            for (const Index node : work_.topology().element_nodes(unmended.element))
                if (const auto found = names.find(node); found != names.end() && !work_.may_move(node))
                    in_the_way.insert(found->second.begin(), found->second.end());
            unmended.fixed_interfaces.assign(in_the_way.begin(), in_the_way.end());
        }
    }

    void list_not_valid() {
        for (Index element = 0; element < work_.topology().element_count(); ++element) {
            const ElementQuality& quality = work_.state().qualities[element];
            if (!is_in_need(quality)) continue;
            if (impossible_[element]) {
                result_.unmended.push_back({element, impossible_[element]->reason, impossible_[element]->is_proved,
                                            impossible_[element]->bound});
                continue;
            }
            const auto nodes = work_.topology().element_nodes(element);
            const auto movable =
                std::count_if(nodes.begin(), nodes.end(), [&](Index node) { return work_.may_move(node); });
            std::string reason;
            if (result_.reason == StopReason::cancelled)
                reason = "untangling was cancelled";
            else if (movable == 0)
                reason = "none of its nodes may move";
            else
                reason = fmt::format("no valid position was found for {} of its nodes; min J is {:.2g} of max |J|",
                                     movable == static_cast<std::ptrdiff_t>(nodes.size())
                                         ? std::string("any")
                                         : fmt::format("the {} that may move", movable),
                                     quality.scaled_jacobian);
            result_.unmended.push_back({element, std::move(reason), false, quality.scaled_jacobian});
        }
        if (!result_.unmended.empty() && result_.reason != StopReason::cancelled)
            result_.reason = StopReason::no_progress;
    }

    PatchWork work_;
    const GuaranteedOptions& options_;
    Impossibilities impossible_;
    GuaranteedResult result_;
};

void check(const GuaranteedOptions& options) {
    if (options.layers < 1 || options.max_layers < options.layers)
        throw InvalidInput("The layers around the damage must be at least 1 and at most the largest number of them.");
    if (!(options.shape_weight > 0.0 && options.shape_weight <= 100.0))
        throw InvalidInput(
            fmt::format("The shape weight is {}; it must be above 0 and at most 100.", options.shape_weight));
    if (!(options.mean_weight >= 0.0 && options.mean_weight <= 100.0))
        throw InvalidInput(fmt::format("The mean weight is {}; it must be from 0 to 100.", options.mean_weight));
    if (!(options.improve_work > 0.0))
        throw InvalidInput(fmt::format("The work of improving is {}; it must be above 0.", options.improve_work));
    if (!(options.target > 0.0 && options.target <= 1.0))
        throw InvalidInput(fmt::format("The target is {}; it must be above 0 and at most 1.", options.target));
    if (!(options.shape_floor >= 0.0 && options.shape_floor < 1.0))
        throw InvalidInput(
            fmt::format("The shape floor is {}; it must be at least 0 and below 1.", options.shape_floor));
}

}  // namespace

GuaranteedResult untangle_guaranteed(const CurvedMesh& mesh, const GuaranteedOptions& options,
                                     UntangleObserver* observer, const TaskContext& context) {
    check(options);
    require_assessable(mesh);
    require_conforming(mesh, context);
    const NumberedAlike alike(mesh);
    GivenNumbering given(mesh, observer);
    return Untangler(alike.mesh(), options, given.listener(), context).run();
}

}  // namespace curvewright
