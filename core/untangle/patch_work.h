#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "core/base/parallel.h"
#include "core/base/task.h"
#include "core/optimize/lbfgs.h"
#include "core/untangle/constrained_objective.h"
#include "core/untangle/node_rules.h"
#include "core/untangle/observer.h"
#include "core/untangle/patch_state.h"
#include "core/untangle/patches.h"

namespace curvewright {

/// What moves on the way to a better mesh, and who may: shared by the stages of the guaranteed method.
class PatchWork {
  public:
    /// Throws like resolve (boundary rules) and KeptNodes.
    PatchWork(const CurvedMesh& mesh, const BoundaryRules& boundary, const NodeRules& nodes, UntangleObserver* observer,
              const TaskContext& context);

    const CurvedMesh& mesh() const { return mesh_; }
    const MeshTopology& topology() const { return topology_; }
    const NodeElements& node_elements() const { return node_elements_; }
    UntangleObserver* observer() const { return observer_; }
    const TaskContext& context() const { return context_; }
    /// None if all of the boundary is fixed.
    const BoundaryShape* boundary() const { return boundary_ ? &*boundary_ : nullptr; }
    MeshState& state() { return state_; }
    const MeshState& state() const { return state_; }
    const OrientationSigns& orientation_sign() const { return *quality_options_.orientation_sign; }

    /// Certifies all elements of the mesh as it was given.
    void assess();
    /// No node goes farther than this from where it was given, mesh units; none to begin with.
    void set_move_limit(double distance) { limit_ = MoveLimit{&mesh_.coordinates(), distance}; }
    const std::optional<MoveLimit>& move_limit() const { return limit_; }
    bool may_move(Index node) const {
        if (kept_.is_kept(node)) return false;
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
    ConstrainedObjective make_objective(const FreePatch& patch) const;
    /// Multiplications, but for a factor, of one evaluation of the patches' objectives: samples × nodes × dimensions.
    double cost_of(const std::vector<FreePatch>& patches) const;

    /// work(its number) for every patch; patches share no element, and the elements of a free node are all in one
    /// patch, so each can work in place. One after the other if somebody listens.
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

    template <class Event>
    void tell(const Event& event) const {
        if (observer_) observer_->on_event(event);
    }
    void begin_pass() { tell(untangle_event::PassBegan{++pass_}); }
    void end_pass() const;
    int pass() const { return pass_; }

  private:
    const CurvedMesh& mesh_;
    const MeshTopology& topology_;
    UntangleObserver* observer_;
    const TaskContext& context_;
    QualityOptions quality_options_;
    const NodeElements node_elements_;
    const KeptNodes kept_;
    std::optional<BoundaryShape> boundary_;  ///< unless all of it is fixed
    std::optional<MoveLimit> limit_;
    MeshState state_;
    int pass_ = 0;
};

/// The work on one patch. Whatever ends it, the patch is left in the best state seen.
class PatchRun {
  protected:
    PatchRun(PatchWork& work, const FreePatch& patch)
        : work_(work), state_(work.state()), patch_(patch), best_(patch, work.state()) {}
    ~PatchRun() = default;

    /// Tells the observer that the work began, does it, restores the best state and tells that it ended.
    template <class Work>
    void guard(const Work& work) {
        began();
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

    /// What the certificates say of the positions as they are, which the observer is told.
    std::vector<ElementQuality> certify() const;
    /// Whether no node of the patch is beyond the limit, if there is one.
    bool is_within_limit() const;

    /// goes_on() is asked after every step.
    template <class GoesOn>
    void minimize(ConstrainedObjective& objective, const DistortionOptions& distortion, const LbfgsOptions& lbfgs,
                  const GoesOn& goes_on) {
        ++round_;
        const LbfgsResult result = minimize_lbfgs(
            variables_,
            [&](const Eigen::VectorXd& v, Eigen::VectorXd& g) { return objective.evaluate(v, distortion, g); }, lbfgs,
            [&](const Eigen::VectorXd& v, double value, int iteration) {
                work_.context().check();
                if (work_.observer()) tell_step(objective, v, value, iteration, distortion);
                return goes_on();
            });
        iterations_ += result.iterations;
    }

    PatchWork& work_;
    MeshState& state_;
    const FreePatch& patch_;
    BestOfPatch best_;
    const double least_before_ = best_.standing().least;
    Eigen::VectorXd variables_;
    int round_ = 0, iterations_ = 0;
    double objective_before_ = 0.0, objective_after_ = 0.0;

  private:
    void began() const;
    void ended() const;
    void tell_step(ConstrainedObjective& objective, const Eigen::VectorXd& variables, double value, int iteration,
                   const DistortionOptions& distortion);
};

}  // namespace curvewright
