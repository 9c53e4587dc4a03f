#include "core/untangle/signed_angles.h"

#include <algorithm>

#include <fmt/format.h>

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/mesh/conformity.h"
#include "core/mesh/renumbering.h"
#include "core/quality/quality.h"
#include "core/untangle/face_nodes.h"
#include "core/untangle/signed_angle_patch.h"

namespace curvewright {
namespace {

namespace event = untangle_event;

void check(const CurvedMesh& mesh, const SignedAngleOptions& options) {
    const auto type = mesh.topology().uniform_type();
    if (!type || type->shape != Shape::triangle || type->order < 2)
        throw Unsupported(
            fmt::format("Untangling by signed angles works on triangles of order 2 and up; this mesh has {}.",
                        type ? name(*type) + " elements" : std::string("elements of several types")));
    require_assessable(mesh);
    if (options.beta_choice == BetaChoice::given && !(options.beta > 0.0 && options.beta <= 1.0))
        throw InvalidInput(fmt::format("beta is {}; it must be greater than 0 and at most 1.", options.beta));
    if (!(options.target > 0.0 && options.target <= 1.0))
        throw InvalidInput(fmt::format("The target is {}; it must be greater than 0 and at most 1.", options.target));
    if (options.max_passes < 1)
        throw InvalidInput(fmt::format("The number of passes is {}; it must be at least 1.", options.max_passes));
}

/// The work of Alg. 6 on one mesh: the state is `x`.
class SignedAngleUntangler {
  public:
    SignedAngleUntangler(const CurvedMesh& mesh, const SignedAngleOptions& options, UntangleObserver* observer,
                         const TaskContext& context)
        : mesh_(mesh),
          topology_(mesh.topology()),
          options_(options),
          observer_(observer),
          context_(context),
          signs_(orientation_signs(mesh)),
          bounds_(*topology_.uniform_type()),
          face_nodes_(topology_.order(), topology_.order() > 3 ? FaceRule::blend : FaceRule::mean),
          kept_(options.nodes, topology_),
          edge_nodes_(find_interior_edge_nodes(topology_)),
          x_(mesh.coordinates()) {
        std::erase_if(edge_nodes_, [this](const EdgeNode& edge_node) { return kept_.is_kept(edge_node.node); });
    }

    UntangleResult run() {
        tell(event::Started{&mesh_});
        UntangleResult result;
        Coordinates last = x_;  // after the last whole pass
        try {
            make_passes(result, last);
        } catch (const Cancelled&) {
            if (!options_.keeps_best_on_cancel) throw;
            result.reason = StopReason::cancelled;
            if (observer_) tell(placed_nodes(event::Placement::put_back, x_, last));
            x_ = last;
        }
        tell(event::Finished{result.reason, result.passes});
        result.coordinates = std::move(x_);
        return result;
    }

  private:
    template <class Event>
    void tell(Event&& event) {
        if (observer_) observer_->on_event(UntangleEvent(std::forward<Event>(event)));
    }

    void make_passes(UntangleResult& result, Coordinates& last) {
        QualityReport quality = assess_quality(mesh_, {}, context_);
        result.reason = StopReason::pass_limit;
        // A valid mesh is not changed; see improve().
        if (quality.summary.invalid + quality.summary.undecided == 0) result.reason = StopReason::untangled;
        const bool needs_quality = observer_ != nullptr || options_.reject_worse_pass;
        while (result.passes < options_.max_passes && result.reason == StopReason::pass_limit) {
            const Coordinates before = last = x_;
            const int pass = result.passes + 1;
            tell(event::PassBegan{pass});
            move_edge_nodes(pass);
            move_face_nodes();
            const double change = (x_ - before).norm() / x_.norm();
            if (needs_quality) {
                const QualityReport after = assess_quality(mesh_.with_coordinates(x_), {}, context_);
                if (options_.reject_worse_pass && is_worse(after.summary, quality.summary)) {
                    if (observer_) tell(placed_nodes(event::Placement::put_back, x_, before));
                    x_ = before;
                    result.reason = StopReason::no_progress;
                } else {
                    quality = after;
                }
                tell(event::PassEnded{pass, change, quality.summary.min, quality.summary.invalid,
                                      quality.summary.undecided, &x_});
            }
            if (result.reason == StopReason::no_progress) break;
            result.passes = pass;
            if (change <= options_.convergence) result.reason = StopReason::converged;
        }
    }

    void move_edge_nodes(int pass) {
        const std::string phase = fmt::format("Untangling, pass {}", pass);
        if (observer_) {
            for (std::size_t i = 0; i < edge_nodes_.size(); ++i) {
                context_.report(phase, static_cast<double>(i) / static_cast<double>(edge_nodes_.size()));
                move_watched(edge_nodes_[i]);
            }
            return;
        }
        if (batches_.empty()) batches_ = batch_in_order(edge_nodes_, topology_.element_count());
        std::size_t done = 0;
        for (const auto& batch : batches_) {
            context_.report(phase, static_cast<double>(done) / static_cast<double>(edge_nodes_.size()));
            parallel_for(batch.size(), 32, {context_.stop, {}}, {}, [&](std::size_t begin, std::size_t end) {
                for (std::size_t i = begin; i < end; ++i) move(edge_nodes_[batch[i]]);
            });
            done += batch.size();
        }
    }

    SignedAngleMinimum move(const EdgeNode& edge_node) {
        const EdgeAngles angles(topology_, x_, edge_node, signs_);
        const SignedAngleMinimum minimum =
            minimise_signed_angles(angles, x_.row(edge_node.node).head<2>(), displacement_unit(angles, options_),
                                   options_.beta, options_, observer_, edge_node.node);
        x_.row(edge_node.node).head<2>() = minimum.position;
        return minimum;
    }

    void move_watched(const EdgeNode& edge_node) {
        tell(event::PatchBegan{{edge_node.node},
                               {edge_node.triangles.begin(), edge_node.triangles.end()},
                               {position_of(x_, edge_node.node)}});
        event::PatchEnded ended;
        ended.nodes = {edge_node.node};
        ended.beta = options_.beta;
        ended.min_scaled_jacobian_before = assess_patch(topology_, x_, edge_node, signs_, bounds_).minimum;
        const SignedAngleMinimum minimum = move(edge_node);
        ended.iterations = minimum.iterations;
        ended.objective_before = minimum.objective_before;
        ended.objective_after = minimum.objective_after;
        ended.positions = {position_of(x_, edge_node.node)};
        ended.min_scaled_jacobian_after = assess_patch(topology_, x_, edge_node, signs_, bounds_).minimum;
        tell(std::move(ended));
    }

    void move_face_nodes() {
        if (face_nodes_.local_nodes().empty()) return;
        for (Index triangle = 0; triangle < topology_.element_count(); ++triangle)
            face_nodes_.place(topology_.element_nodes(triangle), x_, &kept_);
        if (!observer_) return;
        event::FaceNodesMoved moved;
        for (Index triangle = 0; triangle < topology_.element_count(); ++triangle)
            for (const int local : face_nodes_.local_nodes()) {
                moved.nodes.push_back(topology_.element_nodes(triangle)[local]);
                moved.positions.push_back(position_of(x_, moved.nodes.back()));
            }
        tell(std::move(moved));
    }

    const CurvedMesh& mesh_;
    const MeshTopology& topology_;
    const SignedAngleOptions& options_;
    UntangleObserver* observer_;
    const TaskContext& context_;
    OrientationSigns signs_;
    JacobianBounds bounds_;
    FaceNodes face_nodes_;
    const KeptNodes kept_;
    std::vector<EdgeNode> edge_nodes_;
    std::vector<std::vector<std::size_t>> batches_;
    Coordinates x_;
};

}  // namespace

UntangleResult untangle_signed_angles(const CurvedMesh& mesh, const SignedAngleOptions& options,
                                      UntangleObserver* observer, const TaskContext& context) {
    check(mesh, options);
    require_conforming(mesh, context);
    const NumberedAlike alike(mesh);
    GivenNumbering given(mesh, observer);
    if (options.beta_choice == BetaChoice::automatic)
        return untangle_with_chosen_beta(alike.mesh(), options, given.listener(), context);
    return SignedAngleUntangler(alike.mesh(), options, given.listener(), context).run();
}

}  // namespace curvewright
