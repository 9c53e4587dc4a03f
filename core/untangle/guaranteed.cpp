#include "core/untangle/guaranteed.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include <fmt/format.h>

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/base/stopwatch.h"
#include "core/mesh/node_elements.h"
#include "core/optimize/lbfgs.h"
#include "core/quality/jacobian_bounds.h"
#include "core/quality/quality.h"
#include "core/untangle/distortion.h"

namespace curvewright {
namespace {

bool is_valid(const ElementQuality& quality) {
    return quality.validity == Validity::valid;
}

/// How good a set of elements is: fewer that are not valid first, then a higher least scaled Jacobian.
struct Standing {
    Index not_valid = 0;
    double least = std::numeric_limits<double>::infinity();

    explicit Standing(const std::vector<ElementQuality>& qualities) {
        for (const ElementQuality& quality : qualities) {
            not_valid += is_valid(quality) ? 0 : 1;
            least = std::min(least, quality.scaled_jacobian);
        }
    }
    bool is_better_than(const Standing& other) const {
        return not_valid != other.not_valid ? not_valid < other.not_valid : least > other.least;
    }
};

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
        const QualityReport report = assess_quality(mesh, quality_options_, context);
        quality_options_.orientation_sign = report.orientation_sign;
        qualities_ = report.elements;
    }

    GuaranteedResult run() {
        GuaranteedResult result;
        result.coordinates = mesh_.coordinates();
        tell(untangle_event::Started{&mesh_});
        const Stopwatch watch;
        make_valid(result);
        result.valid_seconds = watch.seconds();
        const Stopwatch improving;
        if (options_.improves) improve(result);
        result.improve_seconds = improving.seconds();
        list_unmended(result);
        tell(untangle_event::Finished{result.reason, pass_});
        return result;
    }

  private:
    /// The elements within some layers of the seeds, cut into patches that share no element, each with its free nodes.
    std::vector<FreePatch> make_patches(const std::vector<Index>& seeds, int layers) const {
        std::vector<int> patch_of(static_cast<std::size_t>(topology_.element_count()), -1);
        std::vector<Index> front = seeds;
        for (const Index element : seeds) patch_of[element] = 0;
        for (int layer = 0; layer < layers; ++layer) {
            std::vector<Index> next;
            for (const Index element : front)
                for (const Index node : topology_.element_nodes(element))
                    for (const Index other : node_elements_.of(node))
                        if (patch_of[other] < 0) {
                            patch_of[other] = 0;
                            next.push_back(other);
                        }
            front = std::move(next);
        }
        // Connected parts; 0 so far means "in some patch".
        std::vector<FreePatch> patches;
        std::vector<Index> stack;
        for (Index first = 0; first < topology_.element_count(); ++first) {
            if (patch_of[first] != 0) continue;
            const int number = static_cast<int>(patches.size()) + 1;
            FreePatch& patch = patches.emplace_back();
            patch_of[first] = number;
            stack.assign(1, first);
            while (!stack.empty()) {
                const Index element = stack.back();
                stack.pop_back();
                patch.elements.push_back(element);
                for (const Index node : topology_.element_nodes(element))
                    for (const Index other : node_elements_.of(node))
                        if (patch_of[other] == 0) {
                            patch_of[other] = number;
                            stack.push_back(other);
                        }
            }
            std::sort(patch.elements.begin(), patch.elements.end());
            for (const Index element : patch.elements)
                for (const Index node : topology_.element_nodes(element)) {
                    const auto around = node_elements_.of(node);
                    if (topology_.is_interior_node(node) &&
                        std::all_of(around.begin(), around.end(), [&](Index e) { return patch_of[e] == number; }))
                        patch.nodes.push_back(node);
                }
            std::sort(patch.nodes.begin(), patch.nodes.end());
            patch.nodes.erase(std::unique(patch.nodes.begin(), patch.nodes.end()), patch.nodes.end());
        }
        std::erase_if(patches, [](const FreePatch& patch) { return patch.nodes.empty(); });
        return patches;
    }

    std::vector<ElementQuality> certify(const std::vector<Index>& elements, const Coordinates& x) const {
        std::vector<ElementQuality> result(elements.size());
        parallel_for(elements.size(), 64, context_, {}, [&](std::size_t begin, std::size_t end) {
            std::optional<JacobianBounds> bounds;
            std::optional<ElementType> type;
            Eigen::MatrixX3d positions;
            for (std::size_t i = begin; i < end; ++i) {
                const ElementType own = topology_.element_type(elements[i]);
                if (type != own) {
                    bounds.emplace(own);
                    type = own;
                }
                const auto nodes = topology_.element_nodes(elements[i]);
                positions.resize(static_cast<Eigen::Index>(nodes.size()), 3);
                for (std::size_t n = 0; n < nodes.size(); ++n)
                    positions.row(static_cast<Eigen::Index>(n)) = x.row(nodes[n]);
                result[i] = bounds->bound(positions, *quality_options_.orientation_sign, quality_options_);
            }
        });
        return result;
    }
    std::vector<ElementQuality> present(const std::vector<Index>& elements) const {
        std::vector<ElementQuality> result;
        for (const Index element : elements) result.push_back(qualities_[element]);
        return result;
    }

    /// Positions of the patch's free nodes, one row each.
    static Coordinates positions(const FreePatch& patch, const Coordinates& x) {
        Coordinates result(static_cast<Eigen::Index>(patch.nodes.size()), 3);
        for (std::size_t i = 0; i < patch.nodes.size(); ++i)
            result.row(static_cast<Eigen::Index>(i)) = x.row(patch.nodes[i]);
        return result;
    }
    static void restore(const FreePatch& patch, const Coordinates& positions, Coordinates& x) {
        for (std::size_t i = 0; i < patch.nodes.size(); ++i)
            x.row(patch.nodes[i]) = positions.row(static_cast<Eigen::Index>(i));
    }

    /// The best state of a patch that has been seen, beginning with the one it has.
    class Best {
      public:
        Best(const Untangler& untangler, const FreePatch& patch, const Coordinates& x)
            : qualities_(untangler.present(patch.elements)), standing_(qualities_), positions_(positions(patch, x)) {}
        void offer(const FreePatch& patch, const Coordinates& x, std::vector<ElementQuality> qualities) {
            const Standing standing(qualities);
            if (!standing.is_better_than(standing_)) return;
            standing_ = standing;
            qualities_ = std::move(qualities);
            positions_ = positions(patch, x);
        }
        /// Makes it the present state.
        void take(Untangler& untangler, const FreePatch& patch, Coordinates& x) const {
            restore(patch, positions_, x);
            for (std::size_t i = 0; i < patch.elements.size(); ++i)
                untangler.qualities_[patch.elements[i]] = qualities_[i];
        }

      private:
        std::vector<ElementQuality> qualities_;
        Standing standing_;
        Coordinates positions_;
    };

    std::vector<Index> elements_where(const auto& condition) const {
        std::vector<Index> result;
        for (Index element = 0; element < topology_.element_count(); ++element)
            if (condition(qualities_[element])) result.push_back(element);
        return result;
    }

    /// First stage: until the certificates say valid.
    void make_valid(GuaranteedResult& result) {
        const auto tangled = [&] { return elements_where([](const auto& quality) { return !is_valid(quality); }); };
        std::vector<Index> seeds = tangled();
        const std::size_t at_start = seeds.size();
        for (int layers = options_.layers; !seeds.empty() && layers <= options_.max_layers; layers *= 2) {
            begin_pass();
            const std::vector<FreePatch> patches = make_patches(seeds, layers);
            std::vector<int> rounds(patches.size(), 0);
            // Patches share no element, and the elements of a free node are all in one patch: each can work in place.
            parallel_for(patches.size(), 1, context_, {}, [&](std::size_t begin, std::size_t end) {
                for (std::size_t i = begin; i < end; ++i) rounds[i] = untangle_patch(patches[i], result.coordinates);
            });
            for (const int count : rounds) result.rounds += count;
            end_pass(result.coordinates);
            seeds = tangled();
            context_.report("Making elements valid",
                            1.0 - static_cast<double>(seeds.size()) / static_cast<double>(at_start));
        }
    }

    int untangle_patch(const FreePatch& patch, Coordinates& x) {
        PatchObjective objective(topology_, x, mesh_.coordinates(), *quality_options_.orientation_sign, patch);
        Best best(*this, patch, x);
        Eigen::VectorXd variables = objective.variables(x), gradient;
        DistortionOptions distortion;
        distortion.eps = 1.0;
        objective.evaluate(variables, distortion, gradient);
        double least = objective.least_determinant(), best_least = least;
        int rounds = 0, rounds_without_gain = 0;
        constexpr double margin = 1e-3;
        constexpr int patience = 20;
        for (; rounds < options_.max_rounds && rounds_without_gain < patience; ++rounds) {
            context_.check();
            // Garanzha et al. 2021, section 3: eps follows the least determinant.
            distortion.eps = std::sqrt(1e-6 + 0.04 * std::pow(std::min(0.0, least), 2));
            LbfgsOptions lbfgs;
            lbfgs.max_iterations = 10 + rounds;
            minimize(objective, distortion, lbfgs, variables, [&] { return objective.least_determinant() <= margin; });
            objective.evaluate(variables, distortion, gradient);
            least = objective.least_determinant();
            const bool gains = least > best_least + 1e-3 * std::abs(best_least);
            best_least = std::max(best_least, least);
            rounds_without_gain = gains ? 0 : rounds_without_gain + 1;
            if (least <= 0.0 && rounds_without_gain < patience && rounds + 1 < options_.max_rounds) continue;
            objective.store(variables, x);
            const std::vector<ElementQuality> now = certify(patch.elements, x);
            best.offer(patch, x, now);
            if (Standing(now).not_valid == 0) {
                ++rounds;
                break;
            }
            for (std::size_t i = 0; i < now.size(); ++i)
                if (!is_valid(now[i])) objective.add_sample(i, now[i].worst_point);
        }
        best.take(*this, patch, x);
        return rounds;
    }

    /// Second stage: the least scaled Jacobian of every patch rises as far as it goes.
    void improve(GuaranteedResult& result) {
        const std::vector<Index> seeds = elements_where([&](const ElementQuality& quality) {
            return is_valid(quality) && quality.scaled_jacobian < options_.target;
        });
        std::vector<FreePatch> patches = make_patches(seeds, options_.layers);
        // What could not be mended is not improved either: its neighbours would be bent for nothing.
        std::erase_if(patches, [&](const FreePatch& patch) {
            return std::any_of(patch.elements.begin(), patch.elements.end(),
                               [&](Index element) { return !is_valid(qualities_[element]); });
        });
        if (patches.empty()) return;
        begin_pass();
        context_.report("Improving", 0.0);
        parallel_for(patches.size(), 1, context_, "Improving", [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) improve_patch(patches[i], result.coordinates);
        });
        end_pass(result.coordinates);
    }

    /// goes_on() is asked after every step.
    template <class GoesOn>
    void minimize(PatchObjective& objective, const DistortionOptions& distortion, const LbfgsOptions& lbfgs,
                  Eigen::VectorXd& variables, const GoesOn& goes_on) const {
        minimize_lbfgs(
            variables,
            [&](const Eigen::VectorXd& v, Eigen::VectorXd& g) { return objective.evaluate(v, distortion, g); }, lbfgs,
            [&](const Eigen::VectorXd&, double, int) {
                context_.check();
                return goes_on();
            });
    }

    void improve_patch(const FreePatch& patch, Coordinates& x) {
        PatchObjective objective(topology_, x, mesh_.coordinates(), *quality_options_.orientation_sign, patch);
        Best best(*this, patch, x);
        Eigen::VectorXd variables = objective.variables(x);
        DistortionOptions distortion;
        const auto advance = [&](const LbfgsOptions& lbfgs) {
            minimize(objective, distortion, lbfgs, variables, [] { return true; });
            objective.store(variables, x);
            best.offer(patch, x, certify(patch.elements, x));
        };
        LbfgsOptions lbfgs;
        lbfgs.first_step = 1e-3;
        lbfgs.max_iterations = 50;
        advance(lbfgs);  // the energy alone: evens the patch out
        lbfgs.max_iterations = 200;
        lbfgs.relative_decrease = 3e-5;
        lbfgs.history = 10;
        distortion.energy_weight = options_.shape_weight;
        distortion.mean_weight = options_.mean_weight;
        for (const double sharpness : {20.0, 40.0, 80.0, 160.0, 320.0}) {
            distortion.sharpness = sharpness;
            advance(lbfgs);
        }
        best.take(*this, patch, x);
    }

    void list_unmended(GuaranteedResult& result) const {
        for (Index element = 0; element < topology_.element_count(); ++element) {
            if (is_valid(qualities_[element])) continue;
            const auto nodes = topology_.element_nodes(element);
            const auto free =
                std::count_if(nodes.begin(), nodes.end(), [&](Index node) { return topology_.is_interior_node(node); });
            result.unmended.push_back({element, free == 0
                                                    ? std::string("all of its nodes lie on the boundary")
                                                    : fmt::format("no valid position was found for its {} interior {}",
                                                                  free, free == 1 ? "node" : "nodes")});
        }
        if (!result.unmended.empty()) result.reason = StopReason::no_progress;
    }

    template <class Event>
    void tell(const Event& event) const {
        if (observer_) observer_->on_event(event);
    }
    void begin_pass() { tell(untangle_event::PassBegan{++pass_}); }
    void end_pass(const Coordinates& x) const {
        if (!observer_) return;
        untangle_event::PassEnded event;
        event.pass = pass_;
        event.coordinates = &x;
        const double norm = x.norm();
        event.relative_change = norm > 0.0 ? (x - mesh_.coordinates()).norm() / norm : 0.0;
        event.min_scaled_jacobian = Standing(qualities_).least;
        for (const ElementQuality& quality : qualities_) {
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
    std::vector<ElementQuality> qualities_;  ///< of the present state, per element
    const NodeElements node_elements_;
    int pass_ = 0;
};

}  // namespace

GuaranteedResult untangle_guaranteed(const CurvedMesh& mesh, const GuaranteedOptions& options,
                                     UntangleObserver* observer, const TaskContext& context) {
    if (options.layers < 1 || options.max_layers < options.layers)
        throw InvalidInput("The layers around the damage must be at least 1 and at most the largest number of them.");
    if (!(options.shape_weight > 0.0 && options.shape_weight <= 100.0))
        throw InvalidInput(
            fmt::format("The shape weight is {}; it must be above 0 and at most 100.", options.shape_weight));
    if (!(options.mean_weight >= 0.0 && options.mean_weight <= 100.0))
        throw InvalidInput(fmt::format("The mean weight is {}; it must be from 0 to 100.", options.mean_weight));
    if (!(options.target > 0.0 && options.target <= 1.0))
        throw InvalidInput(fmt::format("The target is {}; it must be above 0 and at most 1.", options.target));
    return Untangler(mesh, options, observer, context).run();
}

}  // namespace curvewright
