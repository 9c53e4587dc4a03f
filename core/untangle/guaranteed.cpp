#include "core/untangle/guaranteed.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include <fmt/format.h>

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/base/stopwatch.h"
#include "core/optimize/lbfgs.h"
#include "core/untangle/constrained_objective.h"
#include "core/untangle/patch_state.h"
#include "core/untangle/patches.h"
#include "core/untangle/unmendable.h"

namespace curvewright {
namespace {

std::vector<untangle_event::Position> event_positions(const std::vector<Index>& nodes, const Coordinates& x) {
    std::vector<untangle_event::Position> result;
    for (const Index node : nodes) result.push_back({x(node, 0), x(node, 1), x(node, 2)});
    return result;
}

/// Multiplications, but for a factor, of one evaluation of an element's objective: samples × nodes × dimensions.
double evaluation_work(ElementType type) {
    const int dim = dimension(type.shape), degree = std::clamp(dim * (type.order - 1), 1, max_order);
    return static_cast<double>(node_count({type.shape, degree})) * node_count(type) * dim;
}

class Untangler {
  public:
    Untangler(const CurvedMesh& mesh, const GuaranteedOptions& options, UntangleObserver* observer,
              const TaskContext& context)
        : mesh_(mesh),
          topology_(mesh.topology()),
          options_(options),
          observer_(observer),
          context_(context),
          node_elements_(elements_of_nodes(mesh.topology())) {
        state_.coordinates = mesh.coordinates();
        if (options.boundary.is_all_fixed()) {
            resolve(options.boundary, topology_);  // the groups must exist all the same
        } else {
            boundary_.emplace(mesh, options.boundary);
            for (Index node = 0; node < topology_.node_count(); ++node) state_.feet.push_back(boundary_->foot(node));
        }
    }

    GuaranteedResult run() {
        tell(untangle_event::Started{&mesh_});
        try {
            work();
        } catch (const Cancelled&) {
            if (!options_.keeps_best_on_cancel) throw;
            result_.reason = StopReason::cancelled;
        }
        if (!state_.qualities.empty()) list_unmended();
        if (boundary_) {
            result_.sliding_nodes = boundary_->sliding_nodes();
            result_.free_nodes = boundary_->free_nodes();
            result_.largest_boundary_distance = boundary_->largest_distance(state_.coordinates);
        }
        tell(untangle_event::Finished{result_.reason, pass_});
        result_.coordinates = std::move(state_.coordinates);
        return std::move(result_);
    }

  private:
    void work() {
        const QualityReport report = assess_quality(mesh_, quality_options_, context_);
        quality_options_.orientation_sign = report.orientation_sign;
        state_.qualities = report.elements;
        impossible_.resize(state_.qualities.size());
        for (const Index element : elements_where([](const auto& quality) { return !is_valid(quality); }))
            impossible_[element] = find_impossibility(
                mesh_, element, report.orientation_sign, node_elements_, [this](Index node) { return may_move(node); },
                [this](Index other) { return impossible_[other].has_value(); });
        const Stopwatch watch;
        make_valid();
        result_.valid_seconds = watch.seconds();
        const Stopwatch improving;
        if (options_.improves) improve();
        result_.improve_seconds = improving.seconds();
    }

    bool may_move(Index node) const {
        return boundary_ ? boundary_->may_move(node)
                         : topology_.is_interior_node(node) && !topology_.is_interface_node(node);
    }
    std::vector<ElementQuality> certify(const FreePatch& patch) const {
        return certify_elements(topology_, patch.elements, state_.coordinates, quality_options_, context_);
    }
    std::vector<Index> elements_where(const auto& condition) const {
        std::vector<Index> result;
        for (Index element = 0; element < topology_.element_count(); ++element)
            if (condition(state_.qualities[element])) result.push_back(element);
        return result;
    }
    /// Not valid, and not proved to be impossible.
    std::vector<Index> mendable() const {
        std::vector<Index> result = elements_where([](const auto& quality) { return !is_valid(quality); });
        std::erase_if(result, [this](Index element) { return impossible_[element].has_value(); });
        return result;
    }

    ConstrainedObjective make_objective(const FreePatch& patch) const {
        return ConstrainedObjective(PatchObjective(topology_, state_.coordinates, mesh_.coordinates(),
                                                   *quality_options_.orientation_sign, patch),
                                    boundary_ ? &*boundary_ : nullptr, state_.coordinates,
                                    feet_of(patch.nodes, state_.feet));
    }

    /// work(patch, its number) for every patch; patches share no element, and the elements of a free node are all in
    /// one patch, so each can work in place. One after the other if somebody listens.
    template <class Work>
    void for_each_patch(const std::vector<FreePatch>& patches, std::string_view phase, const Work& work) {
        if (observer_) {
            for (std::size_t i = 0; i < patches.size(); ++i) {
                context_.check();
                work(i);
                if (!phase.empty())
                    context_.report(phase, static_cast<double>(i + 1) / static_cast<double>(patches.size()));
            }
            return;
        }
        parallel_for(patches.size(), 1, context_, phase, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) work(i);
        });
    }

    /// First stage: until the certificates say valid.
    void make_valid() {
        std::vector<Index> seeds = mendable();
        const std::size_t at_start = seeds.size();
        std::vector<FreePatch> tried;
        for (int layers = options_.layers; !seeds.empty() && layers <= options_.max_layers; layers *= 2) {
            std::vector<FreePatch> patches =
                make_patches(topology_, node_elements_, seeds, layers, [this](Index node) { return may_move(node); });
            // A patch that could not grow would do the same again.
            std::erase_if(patches, [&](const FreePatch& patch) {
                return std::any_of(tried.begin(), tried.end(),
                                   [&](const FreePatch& other) { return other.elements == patch.elements; });
            });
            if (patches.empty()) break;
            begin_pass();
            std::vector<int> rounds(patches.size(), 0);
            for_each_patch(patches, {}, [&](std::size_t i) { rounds[i] = PatchRun(*this, patches[i]).untangle(); });
            for (const int count : rounds) result_.rounds += count;
            end_pass();
            seeds = mendable();
            tried = std::move(patches);
            context_.report("Making elements valid",
                            1.0 - static_cast<double>(seeds.size()) / static_cast<double>(at_start));
        }
    }

    /// Second stage: the least scaled Jacobian of every patch rises as far as it goes.
    void improve() {
        std::vector<Index> seeds = elements_to_improve();
        std::vector<FreePatch> patches = patches_to_improve(seeds);
        const bool is_limited = work_of(patches) > options_.improve_work;
        constexpr int max_passes = 3;
        for (int pass = 0; pass < (is_limited ? max_passes : 1) && !patches.empty(); ++pass) {
            if (is_limited) patches = patches_to_improve(worst_within_limit(seeds));
            const double least_before = Standing(state_.qualities).least;
            begin_pass();
            context_.report("Improving", 0.0);
            for_each_patch(patches, "Improving", [&](std::size_t i) { PatchRun(*this, patches[i]).improve(); });
            end_pass();
            if (Standing(state_.qualities).least <= least_before) break;
            if (is_limited) seeds = elements_to_improve();
        }
    }

    /// The worst first.
    std::vector<Index> elements_to_improve() const {
        std::vector<Index> seeds = elements_where([&](const ElementQuality& quality) {
            return is_valid(quality) && quality.scaled_jacobian < options_.target;
        });
        std::stable_sort(seeds.begin(), seeds.end(), [this](Index a, Index b) {
            return state_.qualities[a].scaled_jacobian < state_.qualities[b].scaled_jacobian;
        });
        return seeds;
    }
    /// What could not be mended stays as it is, with its nodes: its neighbours would be bent for nothing.
    std::vector<FreePatch> patches_to_improve(const std::vector<Index>& seeds) const {
        return make_patches(
            topology_, node_elements_, seeds, options_.layers, [this](Index node) { return may_move(node); },
            [this](Index element) { return !is_valid(state_.qualities[element]); });
    }
    double work_of(const std::vector<FreePatch>& patches) const {
        double work = 0.0;
        for (const FreePatch& patch : patches)
            for (const Index element : patch.elements) work += evaluation_work(topology_.element_type(element));
        return work;
    }
    /// As many of the seeds, from the first, as may be improved together; at least one.
    std::vector<Index> worst_within_limit(const std::vector<Index>& seeds) const {
        std::size_t fits = 1, too_many = seeds.size() + 1;
        while (fits + 1 < too_many) {
            const std::size_t middle = (fits + too_many) / 2;
            const bool is_within =
                work_of(patches_to_improve({seeds.begin(), seeds.begin() + middle})) <= options_.improve_work;
            (is_within ? fits : too_many) = middle;
        }
        return {seeds.begin(), seeds.begin() + static_cast<std::ptrdiff_t>(std::min(fits, seeds.size()))};
    }

    /// The work on one patch. Whatever ends it, the patch is left in the best state seen.
    class PatchRun {
      public:
        PatchRun(Untangler& untangler, const FreePatch& patch)
            : untangler_(untangler), state_(untangler.state_), patch_(patch), best_(patch, untangler.state_) {}

        /// Minimisations made.
        int untangle() {
            began();
            guard([this] { untangle_rounds(); });
            return round_;
        }

        void improve() {
            began();
            guard([this] { improve_to_floor(); });
        }

      private:
        template <class Work>
        void guard(const Work& work) {
            try {
                work();
            } catch (const Cancelled&) {
                best_.restore(state_);
                ended();
                throw;
            }
            best_.restore(state_);
            ended();
        }

        /// Writes the positions, has them judged and keeps them if they are the best so far.
        std::vector<ElementQuality> judge(const ConstrainedObjective& objective, double shape = 1.0) {
            const std::vector<ElementQuality> now = untangler_.certify(patch_);
            const std::vector<Foot> feet = objective.feet(variables_);
            const double floor = untangler_.options_.shape_floor;
            if (shape >= std::min(floor, worst_shape_at_start_)) best_.offer(state_.coordinates, feet, now);
            if (above_floor_ && shape >= floor && above_floor_->offer(state_.coordinates, feet, now))
                is_above_floor_ = true;
            if (untangler_.observer_) {
                const Standing standing(now);
                const Index element = patch_.elements[standing.worst];
                untangler_.tell(untangle_event::PatchCertified{round_, standing.not_valid, standing.least, element,
                                                               now[standing.worst].worst_point});
            }
            return now;
        }

        /// goes_on() is asked after every step.
        template <class GoesOn>
        void minimize(ConstrainedObjective& objective, const DistortionOptions& distortion, const LbfgsOptions& lbfgs,
                      const GoesOn& goes_on) {
            ++round_;
            const LbfgsResult result = minimize_lbfgs(
                variables_,
                [&](const Eigen::VectorXd& v, Eigen::VectorXd& g) { return objective.evaluate(v, distortion, g); },
                lbfgs,
                [&](const Eigen::VectorXd& v, double value, int iteration) {
                    untangler_.context_.check();
                    if (untangler_.observer_) {
                        objective.store(v, state_.coordinates);
                        untangler_.tell(untangle_event::EnergyStep{round_, iteration, value, distortion.eps,
                                                                   distortion.sharpness, objective.least_determinant(),
                                                                   event_positions(patch_.nodes, state_.coordinates)});
                    }
                    return goes_on();
                });
            iterations_ += result.iterations;
        }

        void untangle_rounds() {
            FreePatch active = patch_;
            std::erase_if(active.elements, [this](Index e) { return untangler_.impossible_[e].has_value(); });
            ConstrainedObjective objective = untangler_.make_objective(active);
            variables_ = objective.start();
            Eigen::VectorXd gradient;
            DistortionOptions distortion;
            distortion.eps = 1.0;
            objective_before_ = objective.evaluate(variables_, distortion, gradient);
            double least = objective.least_determinant(), best_least = least;
            const GuaranteedOptions& options = untangler_.options_;
            int rounds_without_gain = 0;
            double margin = 1e-3;
            int failed_certificates = 0;
            constexpr int patience = 20;
            while (round_ < options.max_rounds && rounds_without_gain < patience) {
                untangler_.context_.check();
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
                if (least <= 0.0 && rounds_without_gain < patience && round_ < options.max_rounds) continue;
                objective.store(variables_, state_.coordinates);
                const std::vector<ElementQuality> now = judge(objective);
                bool is_done = true;
                std::size_t number = 0;  // among the active elements
                for (std::size_t i = 0; i < now.size(); ++i) {
                    if (untangler_.impossible_[patch_.elements[i]]) continue;
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
            if (!untangler_.observer_) return;
            distortion.eps = 1.0;
            objective_after_ = objective.evaluate(variables_, distortion, gradient);
        }

        void improve_to_floor() {
            double shape_weight = untangler_.options_.shape_weight;
            if (untangler_.options_.shape_floor > 0.0) {
                shape_.emplace(untangler_.topology_, patch_.elements, untangler_.mesh_.coordinates());
                worst_shape_at_start_ = shape_->worst(state_.coordinates);
                above_floor_ = best_;
                is_above_floor_ = worst_shape_at_start_ >= untangler_.options_.shape_floor;
            }
            constexpr double largest_weight = 100.0, factor = 4.0;
            while (!improve_with(shape_weight) && shape_weight < largest_weight) {
                shape_weight *= factor;
                best_.restore(state_);
            }
            if (is_above_floor_) best_ = *above_floor_;
        }

        /// Whether the shape is above the floor at the end.
        bool improve_with(double shape_weight) {
            ConstrainedObjective objective = untangler_.make_objective(patch_);
            variables_ = objective.start();
            DistortionOptions distortion;
            double shape = 1.0;
            const auto advance = [&](const LbfgsOptions& lbfgs) {
                minimize(objective, distortion, lbfgs, [] { return true; });
                objective.recentre(variables_);
                objective.store(variables_, state_.coordinates);
                if (shape_) shape = shape_->worst(state_.coordinates);
                judge(objective, shape);
            };
            const GuaranteedOptions& options = untangler_.options_;
            Eigen::VectorXd gradient;
            LbfgsOptions lbfgs;
            lbfgs.first_step = 1e-3;
            lbfgs.max_iterations = 50;
            if (untangler_.observer_) objective_before_ = objective.evaluate(variables_, distortion, gradient);
            advance(lbfgs);  // the energy alone: evens the patch out
            lbfgs.max_iterations = 600;
            // Small patches go on until another unit or origin leads to the same minimum; large ones would take long.
            lbfgs.relative_decrease = std::clamp(5e-12 * untangler_.work_of({patch_}), 1e-6, 3e-5);
            lbfgs.history = 10;
            distortion.energy_weight = shape_weight;
            distortion.mean_weight = options.mean_weight;
            for (const double sharpness : {20.0, 40.0, 80.0, 160.0, 320.0}) {
                distortion.sharpness = sharpness;
                advance(lbfgs);
            }
            if (untangler_.observer_) objective_after_ = objective.evaluate(variables_, DistortionOptions{}, gradient);
            return shape >= untangler_.options_.shape_floor;
        }

        void began() const {
            if (untangler_.observer_)
                untangler_.tell(untangle_event::PatchBegan{patch_.nodes, patch_.elements,
                                                           event_positions(patch_.nodes, state_.coordinates)});
        }
        void ended() const {
            if (!untangler_.observer_) return;
            untangle_event::PatchEnded event;
            event.nodes = patch_.nodes;
            event.positions = event_positions(patch_.nodes, state_.coordinates);
            event.iterations = iterations_;
            event.objective_before = objective_before_;
            event.objective_after = objective_after_;
            event.min_scaled_jacobian_before = least_before_;
            event.min_scaled_jacobian_after = best_.standing().least;
            untangler_.tell(event);
        }

        Untangler& untangler_;
        MeshState& state_;
        const FreePatch& patch_;
        BestOfPatch best_;                        ///< not below the floor, or the shape at the start if that is lower
        std::optional<BestOfPatch> above_floor_;  ///< if there is a floor: not below it
        bool is_above_floor_ = false;             ///< whether a state above the floor is known
        std::optional<PatchShape> shape_;
        double worst_shape_at_start_ = 1.0;
        const double least_before_ = best_.standing().least;
        Eigen::VectorXd variables_;
        int round_ = 0, iterations_ = 0;
        double objective_before_ = 0.0, objective_after_ = 0.0;
    };

    void list_unmended() {
        list_not_valid();
        if (result_.unmended.empty() || topology_.interface_nodes().empty()) return;
        const auto names = names_of_interface_nodes(topology_);
        for (UnmendedElement& unmended : result_.unmended) {
            std::set<std::string> in_the_way;
            for (const Index node : topology_.element_nodes(unmended.element))
                if (const auto found = names.find(node); found != names.end() && !may_move(node))
                    in_the_way.insert(found->second.begin(), found->second.end());
            unmended.fixed_interfaces.assign(in_the_way.begin(), in_the_way.end());
        }
    }

    void list_not_valid() {
        for (Index element = 0; element < topology_.element_count(); ++element) {
            const ElementQuality& quality = state_.qualities[element];
            if (is_valid(quality)) continue;
            if (impossible_[element]) {
                result_.unmended.push_back({element, impossible_[element]->reason, true, impossible_[element]->bound});
                continue;
            }
            const auto nodes = topology_.element_nodes(element);
            const auto movable = std::count_if(nodes.begin(), nodes.end(), [&](Index node) { return may_move(node); });
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

    template <class Event>
    void tell(const Event& event) const {
        if (observer_) observer_->on_event(event);
    }
    void begin_pass() { tell(untangle_event::PassBegan{++pass_}); }
    void end_pass() const {
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

    const CurvedMesh& mesh_;
    const MeshTopology& topology_;
    const GuaranteedOptions& options_;
    UntangleObserver* observer_;
    const TaskContext& context_;
    QualityOptions quality_options_;
    const NodeElements node_elements_;
    std::optional<BoundaryShape> boundary_;  ///< unless all of it is fixed
    MeshState state_;
    std::vector<std::optional<Impossibility>> impossible_;  ///< per element; looked for in those that began not valid
    GuaranteedResult result_;
    int pass_ = 0;
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
    return Untangler(mesh, options, observer, context).run();
}

}  // namespace curvewright
