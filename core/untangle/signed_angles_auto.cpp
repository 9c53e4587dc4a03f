#include <algorithm>
#include <cmath>
#include <optional>

#include <fmt/format.h>

#include "core/base/parallel.h"
#include "core/quality/quality.h"
#include "core/untangle/face_nodes.h"
#include "core/untangle/signed_angle_patch.h"

namespace curvewright {
namespace {

namespace event = untangle_event;

/// One way to move an edge's nodes.
struct Trial {
    double log_ratio = 0.0;    ///< log10 of beta / (1 - beta)
    bool straightens = false;  ///< begin with the edge straight instead of as it is

    double beta() const {
        const double ratio = std::pow(10.0, log_ratio);
        return ratio / (1.0 + ratio);
    }
};

// Weights that are tried on every edge: beta from 1e-5 to 0.99, evenly spaced in log10 (beta / (1 - beta)); then the
// best one is refined by halving the spacing.
constexpr double first_log_ratio = -5.0, spacing = 0.5;
constexpr int first_trials = 15, refinements = 4;
/// What a move must gain to be worth it; the certificate's own tolerance is larger.
constexpr double least_gain = 1e-5;

/// See BetaChoice::automatic: the state is `x`.
class AutomaticUntangler {
  public:
    AutomaticUntangler(const CurvedMesh& mesh, const SignedAngleOptions& options, UntangleObserver* observer,
                       const TaskContext& context)
        : mesh_(mesh),
          topology_(mesh.topology()),
          options_(options),
          observer_(observer),
          context_(context),
          signs_(orientation_signs(mesh)),
          face_nodes_(topology_.order(), FaceRule::blend),
          kept_(options.nodes, topology_),
          edges_(group_by_edge(movable_edge_nodes())),
          colours_(colour_edges(edges_, topology_.element_count())),
          tried_(edges_.size(), 0),
          changed_(static_cast<std::size_t>(topology_.element_count()), 0),
          x_(mesh.coordinates()) {
        options_.displacement = DisplacementUnit::edge_length;
    }

    UntangleResult run() {
        tell(event::Started{&mesh_});
        // A patch with a tangled triangle is judged by its soft minimum, so the mesh's minimum may fall on the way to
        // validity: the best state of all passes is returned, and the last pass ends with it.
        UntangleResult result{x_, 0, StopReason::pass_limit};
        try {
            make_passes(result);
        } catch (const Cancelled&) {
            if (!options_.keeps_best_on_cancel) throw;
            result.reason = StopReason::cancelled;
            if (observer_) tell(placed_nodes(event::Placement::put_back, x_, result.coordinates));
        }
        tell(event::Finished{result.reason, result.passes});
        return result;
    }

  private:
    template <class Event>
    void tell(Event&& event) {
        if (observer_) observer_->on_event(UntangleEvent(std::forward<Event>(event)));
    }

    std::vector<EdgeNode> movable_edge_nodes() const {
        std::vector<EdgeNode> nodes = find_interior_edge_nodes(topology_);
        std::erase_if(nodes, [this](const EdgeNode& edge_node) { return kept_.is_kept(edge_node.node); });
        return nodes;
    }

    void make_passes(UntangleResult& result) {
        QualitySummary best = assess_quality(mesh_, {}, context_).summary;
        // A valid mesh is not changed; see improve().
        if (best.invalid + best.undecided == 0) result.reason = StopReason::untangled;
        for (int pass = 1; pass <= options_.max_passes && result.reason == StopReason::pass_limit; ++pass) {
            const Coordinates before = x_;
            tell(event::PassBegan{pass});
            if (!move_edges(pass)) result.reason = StopReason::converged;
            QualitySummary state = assess_quality(mesh_.with_coordinates(x_), {}, context_).summary;
            if (!is_worse(state, best)) {
                best = state;
                result.coordinates = x_;
            } else if (pass == options_.max_passes || result.reason != StopReason::pass_limit) {
                if (observer_) tell(placed_nodes(event::Placement::put_back, x_, result.coordinates));
                x_ = result.coordinates;
                state = best;
            }
            tell(event::PassEnded{pass, (x_ - before).norm() / x_.norm(), state.min, state.invalid, state.undecided,
                                  &x_});
            result.passes = pass;
        }
    }

    /// One pass over the edges, colour by colour. Returns whether one was moved.
    bool move_edges(int pass) {
        const std::string phase = fmt::format("Untangling, pass {}", pass);
        bool has_moved = false;
        for (std::size_t colour = 0; colour < colours_.size(); ++colour) {
            context_.report(phase, static_cast<double>(colour) / static_cast<double>(colours_.size()));
            // An edge is tried again only if one of its triangles has changed since.
            std::vector<std::size_t> due;
            for (const std::size_t edge : colours_[colour]) {
                const auto [a, b] = edges_[edge][0].triangles;
                if (tried_[edge] == 0 || std::max(changed_[a], changed_[b]) >= tried_[edge]) due.push_back(edge);
            }
            ++clock_;
            std::vector<char> moved(due.size(), 0);
            const auto improve_some = [&](std::size_t begin, std::size_t end) {
                JacobianBounds bounds(*topology_.uniform_type());
                for (std::size_t i = begin; i < end; ++i) {
                    context_.check();
                    moved[i] = improve(edges_[due[i]], bounds);
                }
            };
            if (observer_)
                improve_some(0, due.size());
            else
                parallel_for(due.size(), 8, {context_.stop, {}}, {}, improve_some);
            for (std::size_t i = 0; i < due.size(); ++i) {
                tried_[due[i]] = clock_;
                if (!moved[i]) continue;
                has_moved = true;
                for (const Index triangle : edges_[due[i]][0].triangles) changed_[triangle] = clock_;
            }
        }
        return has_moved;
    }

    /// The nodes that move with an edge: its own, then the face nodes of its triangles.
    std::vector<Index> nodes_of(const EdgeNodes& edge) const {
        std::vector<Index> nodes;
        for (const EdgeNode& node : edge) nodes.push_back(node.node);
        for (const Index triangle : edge[0].triangles)
            for (const int local : face_nodes_.local_nodes()) nodes.push_back(topology_.element_nodes(triangle)[local]);
        return nodes;
    }

    /// Moves an edge by the best of the trials, if that gains something. Reads and writes nodes of its two triangles
    /// only, so edges of one colour do not meet.
    bool improve(const EdgeNodes& edge, JacobianBounds& bounds) {
        const PatchQuality start = assess_patch(topology_, x_, edge[0], signs_, bounds);
        if (start.minimum >= options_.target) return false;
        const std::vector<Index> nodes = nodes_of(edge);
        Eigen::MatrixX2d start_positions(static_cast<Eigen::Index>(nodes.size()), 2);
        for (std::size_t i = 0; i < nodes.size(); ++i)
            start_positions.row(static_cast<Eigen::Index>(i)) = x_.row(nodes[i]).head<2>();
        const auto restore = [&] {
            for (std::size_t i = 0; i < nodes.size(); ++i)
                x_.row(nodes[i]).head<2>() = start_positions.row(static_cast<Eigen::Index>(i));
        };

        std::optional<Trial> best;
        double best_merit = merit(start, start) + least_gain;
        const auto try_out = [&](const Trial& trial) {
            move(edge, trial, nullptr);
            const PatchQuality quality = assess_patch(topology_, x_, edge[0], signs_, bounds);
            restore();
            const bool is_refused =
                quality.not_valid > start.not_valid || (quality.not_valid == 0 && quality.minimum < start.minimum);
            if (is_refused || !(merit(quality, start) > best_merit)) return;
            best = trial;
            best_merit = merit(quality, start);
        };
        for (const bool straightens : {false, true})
            for (int i = 0; i < first_trials; ++i) try_out({first_log_ratio + i * spacing, straightens});
        double step = spacing;
        for (int i = 0; best && i < refinements; ++i) {
            step /= 2;
            const Trial centre = *best;
            try_out({centre.log_ratio - step, centre.straightens});
            try_out({centre.log_ratio + step, centre.straightens});
        }
        if (observer_)
            move_watched(edge, best, nodes, start, bounds);
        else if (best)
            move(edge, *best, nullptr);
        return best.has_value();
    }

    /// What is to be raised: among valid triangles their certified minimum.
    static double merit(const PatchQuality& quality, const PatchQuality& start) {
        return start.not_valid == 0 ? quality.minimum : quality.soft_minimum;
    }

    /// Iterations and objective, summed over the nodes.
    SignedAngleMinimum move(const EdgeNodes& edge, const Trial& trial, UntangleObserver* observer) {
        if (trial.straightens) straighten(edge, observer);
        SignedAngleMinimum total;
        for (const EdgeNode& node : edge) {
            const EdgeAngles angles(topology_, x_, node, signs_);
            const SignedAngleMinimum minimum =
                minimise_signed_angles(angles, x_.row(node.node).head<2>(), displacement_unit(angles, options_),
                                       trial.beta(), options_, observer, node.node);
            x_.row(node.node).head<2>() = minimum.position;
            total.iterations += minimum.iterations;
            total.objective_before += minimum.objective_before;
            total.objective_after += minimum.objective_after;
        }
        for (const Index triangle : edge[0].triangles) face_nodes_.place(topology_.element_nodes(triangle), x_, &kept_);
        return total;
    }

    void straighten(const EdgeNodes& edge, UntangleObserver* observer) {
        const auto nodes = topology_.element_nodes(edge[0].triangles[0]);
        const int local = edge[0].local_edges[0];
        const Eigen::RowVector2d a = x_.row(nodes[local]).head<2>(), b = x_.row(nodes[(local + 1) % 3]).head<2>();
        for (const EdgeNode& node : edge)
            x_.row(node.node).head<2>() = a + (b - a) * ((node.position - 1.0) / topology_.order());
        if (!observer) return;
        event::NodesPlaced placed{event::Placement::straightened, {}, {}};
        for (const EdgeNode& node : edge) {
            placed.nodes.push_back(node.node);
            placed.positions.push_back(position_of(x_, node.node));
        }
        tell(std::move(placed));
    }

    /// Moves the edge by the trial, or leaves it where it is, and tells the observer.
    void move_watched(const EdgeNodes& edge, const std::optional<Trial>& trial, const std::vector<Index>& nodes,
                      const PatchQuality& start, JacobianBounds& bounds) {
        const auto positions = [&] {
            std::vector<event::Position> result;
            for (const Index node : nodes) result.push_back(position_of(x_, node));
            return result;
        };
        tell(event::PatchBegan{nodes, {edge[0].triangles.begin(), edge[0].triangles.end()}, positions()});
        event::PatchEnded ended;
        ended.nodes = nodes;
        ended.min_scaled_jacobian_before = ended.min_scaled_jacobian_after = start.minimum;
        if (trial) {
            const SignedAngleMinimum minimum = move(edge, *trial, observer_);
            ended.beta = trial->beta();
            ended.iterations = minimum.iterations;
            ended.objective_before = minimum.objective_before;
            ended.objective_after = minimum.objective_after;
            ended.min_scaled_jacobian_after = assess_patch(topology_, x_, edge[0], signs_, bounds).minimum;
        }
        ended.positions = positions();
        tell(std::move(ended));
    }

    const CurvedMesh& mesh_;
    const MeshTopology& topology_;
    SignedAngleOptions options_;
    UntangleObserver* observer_;
    const TaskContext& context_;
    OrientationSigns signs_;
    FaceNodes face_nodes_;
    const KeptNodes kept_;
    std::vector<EdgeNodes> edges_;
    std::vector<std::vector<std::size_t>> colours_;
    /// Number of the colour step (clock_) at which an edge was last tried and a triangle last changed; 0 = never.
    std::vector<int> tried_, changed_;
    int clock_ = 0;
    Coordinates x_;
};

}  // namespace

UntangleResult untangle_with_chosen_beta(const CurvedMesh& mesh, const SignedAngleOptions& options,
                                         UntangleObserver* observer, const TaskContext& context) {
    return AutomaticUntangler(mesh, options, observer, context).run();
}

}  // namespace curvewright
