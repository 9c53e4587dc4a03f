#include "core/untangle/unsigned_angles.h"

#include <algorithm>
#include <limits>

#include <fmt/format.h>

#include "core/base/error.h"
#include "core/basis/reference_element.h"
#include "core/mesh/conformity.h"
#include "core/optimize/bfgs.h"
#include "core/mesh/renumbering.h"
#include "core/quality/jacobian_bounds.h"
#include "core/quality/quality.h"
#include "core/untangle/edge_angles.h"
#include "core/untangle/face_nodes.h"
#include "core/untangle/standing.h"

namespace curvewright {
namespace {

namespace event = untangle_event;

void check(const CurvedMesh& mesh, const UnsignedAngleOptions& options) {
    const auto type = mesh.topology().uniform_type();
    if (!type || type->shape != Shape::triangle || type->order < 2)
        throw Unsupported(
            fmt::format("Untangling by unsigned angles works on triangles of order 2 and up; this mesh has {}.",
                        type ? name(*type) + " elements" : std::string("elements of several types")));
    require_assessable(mesh);
    if (options.max_passes < 1)
        throw InvalidInput(fmt::format("The number of passes is {}; it must be at least 1.", options.max_passes));
    if (options.first_steps.empty()) throw InvalidInput("There is no first step to try; at least one is needed.");
    for (const double step : options.first_steps)
        if (!(step > 0.0 && step <= 1e3))
            throw InvalidInput(fmt::format("The first step is {}; it must be above 0 and at most 1000.", step));
    if (!(options.target >= 0.0 && options.target <= 1.0))
        throw InvalidInput(fmt::format("The target is {}; it must be from 0 to 1.", options.target));
    if (!(options.difference_step > 0.0 && options.difference_step <= 0.1))
        throw InvalidInput(fmt::format("The step of the differences is {}; it must be above 0 and at most 0.1.",
                                       options.difference_step));
}

/// Which moves of an edge are kept: those that raise its triangles' least scaled Jacobian, or the best one in any case.
enum class Moves { gains, all };

/// Guarded passes in turn that lead to no better mesh before the method gives up.
constexpr int patience = 4;

/// The work of Alg. 4 on one mesh: the state is `x_` and what is proved of its elements.
class UnsignedAngleUntangler {
  public:
    UnsignedAngleUntangler(const CurvedMesh& mesh, const UnsignedAngleOptions& options, UntangleObserver* observer,
                           const TaskContext& context)
        : mesh_(mesh),
          topology_(mesh.topology()),
          options_(options),
          observer_(observer),
          context_(context),
          bounds_(*topology_.uniform_type()),
          edges_(find_interior_edges(topology_)),
          kept_(options.nodes, topology_),
          face_placements_(face_placements()),
          x_(mesh.coordinates()) {
        QualityReport report = assess_quality(mesh, quality_options_, context);
        quality_options_.orientation_sign = report.orientation_sign;
        qualities_ = std::move(report.elements);
        std::erase_if(edges_, [this](const InteriorEdge& edge) {
            return std::any_of(edge.nodes.begin(), edge.nodes.end(),
                               [this](Index node) { return kept_.is_kept(node); });
        });
    }

    UntangleResult run() {
        tell(event::Started{&mesh_});
        UntangleResult result;
        Coordinates best = x_;
        try {
            make_passes(result, best);
        } catch (const Cancelled&) {
            if (!options_.keeps_best_on_cancel) throw;
            result.reason = StopReason::cancelled;
            if (observer_) tell_put_back(best);
            x_ = best;
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

    void make_passes(UntangleResult& result, Coordinates& best) {
        // A valid mesh is not changed; see improve().
        result.reason = is_untangled() ? StopReason::untangled : StopReason::pass_limit;
        std::vector<ElementQuality> best_qualities = qualities_;
        Standing best_standing(qualities_);
        int fruitless = 0;  // passes in turn that did not lead to a better mesh
        Moves moves = options_.is_guarded ? Moves::gains : Moves::all;
        while (result.passes < options_.max_passes && result.reason == StopReason::pass_limit) {
            const Coordinates before = x_;
            tell(event::PassBegan{++result.passes});
            move_edges(result.passes, moves);
            const double change = (x_ - before).norm() / x_.norm();
            const Standing standing(qualities_);
            const bool is_better = standing.is_better_than(best_standing);
            if (is_better) {
                best = x_;
                best_qualities = qualities_;
                best_standing = standing;
            }
            fruitless = is_better ? 0 : fruitless + 1;
            if (!has_work() || (change == 0.0 && (is_untangled() || moves == Moves::all)) ||
                (options_.is_guarded && fruitless == patience))
                result.reason = end_reason();
            else if (options_.is_guarded)
                moves = change == 0.0 ? Moves::all : Moves::gains;
            const bool is_last = result.reason != StopReason::pass_limit || result.passes == options_.max_passes;
            if (is_last && options_.is_guarded) {
                if (observer_) tell_put_back(best);
                x_ = best;
                qualities_ = best_qualities;
            }
            if (observer_) tell_pass_ended(result.passes, change);
        }
    }

    void tell_put_back(const Coordinates& best) {
        event::NodesPlaced placed = placed_nodes(event::Placement::put_back, x_, best);
        if (!placed.nodes.empty()) tell(std::move(placed));
    }
    void tell_pass_ended(int pass, double change) {
        event::PassEnded ended{pass, change, 1.0, 0, 0, &x_};
        for (const ElementQuality& quality : qualities_) {
            ended.min_scaled_jacobian = std::min(ended.min_scaled_jacobian, quality.scaled_jacobian);
            ended.invalid += quality.validity == Validity::invalid ? 1 : 0;
            ended.undecided += quality.validity == Validity::undecided ? 1 : 0;
        }
        tell(std::move(ended));
    }

    bool is_untangled() const { return std::all_of(qualities_.begin(), qualities_.end(), is_valid); }

    double patch_minimum(const InteriorEdge& edge) const {
        return std::min(qualities_[edge.triangles[0]].scaled_jacobian, qualities_[edge.triangles[1]].scaled_jacobian);
    }

    void certify(Index triangle) {
        const auto nodes = topology_.element_nodes(triangle);
        Eigen::MatrixX3d positions(static_cast<Eigen::Index>(nodes.size()), 3);
        for (std::size_t i = 0; i < nodes.size(); ++i) positions.row(static_cast<Eigen::Index>(i)) = x_.row(nodes[i]);
        qualities_[triangle] = bounds_.bound(
            positions, quality_options_.orientation_sign->of_element(topology_, triangle), quality_options_);
    }

    bool is_done(Index triangle) const {
        return is_valid(qualities_[triangle]) && qualities_[triangle].scaled_jacobian >= options_.target;
    }
    bool has_work() const {
        for (Index triangle = 0; triangle < topology_.element_count(); ++triangle)
            if (!is_done(triangle)) return true;
        return false;
    }
    StopReason end_reason() const { return is_untangled() ? StopReason::untangled : StopReason::no_progress; }

    void move_edges(int pass, Moves moves) {
        const std::string phase = fmt::format("Untangling, pass {}", pass);
        for (std::size_t i = 0; i < edges_.size(); ++i) {
            if (i % 1024 == 0) context_.report(phase, static_cast<double>(i) / static_cast<double>(edges_.size()));
            const InteriorEdge& edge = edges_[i];
            if (is_done(edge.triangles[0]) && is_done(edge.triangles[1])) continue;
            context_.check();
            move_edge(edge, moves);
        }
    }

    /// The nodes that move with an edge: its own, then the face nodes of its triangles.
    std::vector<Index> nodes_of(const InteriorEdge& edge) const {
        std::vector<Index> nodes = edge.nodes;
        if (face_placements_.empty()) return nodes;
        for (const Index triangle : edge.triangles)
            for (const int local : face_placements_[0].local_nodes())
                nodes.push_back(topology_.element_nodes(triangle)[local]);
        return nodes;
    }
    std::vector<event::Position> positions(const std::vector<Index>& nodes) const {
        std::vector<event::Position> result;
        for (const Index node : nodes) result.push_back(position_of(x_, node));
        return result;
    }
    std::vector<event::Position> positions(const InteriorEdge& edge, const Eigen::VectorXd& variables) const {
        std::vector<event::Position> result = positions(edge.nodes);
        for (std::size_t i = 0; i < result.size(); ++i)
            for (std::size_t d = 0; d < 2; ++d) result[i][d] = variables[static_cast<Eigen::Index>(2 * i + d)];
        return result;
    }

    Eigen::VectorXd present_variables(const InteriorEdge& edge) const {
        Eigen::VectorXd variables(2 * static_cast<Eigen::Index>(edge.nodes.size()));
        for (std::size_t i = 0; i < edge.nodes.size(); ++i)
            variables.segment<2>(static_cast<Eigen::Index>(2 * i)) = x_.row(edge.nodes[i]).head<2>();
        return variables;
    }
    /// The edge's nodes evenly spaced on the straight line between its ends.
    Eigen::VectorXd straight_variables(const InteriorEdge& edge) const {
        const auto nodes = topology_.element_nodes(edge.triangles[0]);
        const auto& local = reference_element(*topology_.uniform_type()).edges[edge.local_edges[0]].nodes;
        const Eigen::Vector2d start = x_.row(nodes[local[0]]).head<2>(), end = x_.row(nodes[local[1]]).head<2>();
        Eigen::VectorXd variables(2 * static_cast<Eigen::Index>(edge.nodes.size()));
        for (std::size_t i = 0; i < edge.nodes.size(); ++i) {
            const double t = static_cast<double>(i + 1) / static_cast<double>(edge.nodes.size() + 1);
            variables.segment<2>(static_cast<Eigen::Index>(2 * i)) = (1.0 - t) * start + t * end;
        }
        return variables;
    }

    /// What a move of an edge may change: the nodes of its triangles and what is proved of these.
    struct PatchState {
        std::array<Coordinates, 2> x;
        std::array<ElementQuality, 2> qualities;
    };
    PatchState save(const InteriorEdge& edge) const {
        PatchState state;
        for (int side = 0; side < 2; ++side) {
            const auto nodes = topology_.element_nodes(edge.triangles[side]);
            state.x[side].resize(static_cast<Eigen::Index>(nodes.size()), 3);
            for (std::size_t i = 0; i < nodes.size(); ++i)
                state.x[side].row(static_cast<Eigen::Index>(i)) = x_.row(nodes[i]);
            state.qualities[side] = qualities_[edge.triangles[side]];
        }
        return state;
    }
    void restore(const InteriorEdge& edge, const PatchState& state) {
        for (int side = 0; side < 2; ++side) {
            const auto nodes = topology_.element_nodes(edge.triangles[side]);
            for (std::size_t i = 0; i < nodes.size(); ++i)
                x_.row(nodes[i]) = state.x[side].row(static_cast<Eigen::Index>(i));
            qualities_[edge.triangles[side]] = state.qualities[side];
        }
    }

    /// The ways to place face nodes that are tried; none: they stay.
    std::vector<FaceNodes> face_placements() const {
        const int order = topology_.order();
        if (!options_.moves_face_nodes || order < 3) return {};
        std::vector<FaceNodes> result{{order, FaceRule::blend}};
        if (order == 3) result.emplace_back(order, FaceRule::mean);  // either may be the better one
        return result;
    }
    void place(const InteriorEdge& edge, const Eigen::VectorXd& variables, const FaceNodes* face_nodes) {
        for (std::size_t i = 0; i < edge.nodes.size(); ++i)
            x_.row(edge.nodes[i]).head<2>() = variables.segment<2>(static_cast<Eigen::Index>(2 * i));
        for (const Index triangle : edge.triangles) {
            if (face_nodes) face_nodes->place(topology_.element_nodes(triangle), x_, &kept_);
            certify(triangle);
        }
    }

    BfgsResult minimize(const InteriorEdge& edge, const UnsignedAngleSum& sum, double first_step,
                        Eigen::VectorXd& variables) {
        const double length = sum.edge_length();
        BfgsOptions bfgs;
        bfgs.max_iterations = options_.max_iterations;
        bfgs.gradient_tolerance = options_.gradient_tolerance / length;
        bfgs.initial_hessian = 1.0 / (first_step * length * length);
        return minimize_bfgs(
            variables,
            [&](const Eigen::VectorXd& v, Eigen::VectorXd& gradient) {
                if (options_.gradient == AngleGradient::exact) return sum.evaluate(v, gradient);
                gradient = sum.difference_gradient(v, options_.difference_step * length);
                return sum.evaluate(v);
            },
            [&](const Eigen::VectorXd& v) { return sum.evaluate(v); }, bfgs,
            [&](const BfgsState& state) {
                if (observer_)
                    tell(event::BfgsStep{state.iteration, positions(edge, state.x), state.value, state.gradient_norm,
                                         state.step, sum.angles(state.x)});
            });
    }

    void move_edge(const InteriorEdge& edge, Moves moves) {
        const UnsignedAngleSum sum(topology_, x_, edge);
        if (!(sum.edge_length() > 0.0)) return;  // the ends coincide: there is no direction to turn
        std::vector<Eigen::VectorXd> starts{present_variables(edge)};
        if (options_.tries_straight_edge) starts.push_back(straight_variables(edge));
        event::PatchEnded ended;
        if (observer_) {
            ended.nodes = nodes_of(edge);
            tell(
                event::PatchBegan{ended.nodes, {edge.triangles.begin(), edge.triangles.end()}, positions(ended.nodes)});
            ended.objective_before = sum.evaluate(starts[0]);
            ended.min_scaled_jacobian_before = patch_minimum(edge);
        }
        const PatchState before = save(edge);
        PatchState best = before;
        double best_minimum = moves == Moves::gains ? patch_minimum(edge) : -std::numeric_limits<double>::infinity();
        for (const Eigen::VectorXd& start : starts)
            for (const double first_step : options_.first_steps) {
                Eigen::VectorXd variables = start;
                const BfgsResult result = minimize(edge, sum, first_step, variables);
                ended.iterations += result.iterations;
                const auto try_placement = [&](const FaceNodes* face_nodes) {
                    place(edge, variables, face_nodes);
                    if (patch_minimum(edge) <= best_minimum) return;
                    best_minimum = patch_minimum(edge);
                    best = save(edge);
                };
                if (face_placements_.empty()) try_placement(nullptr);
                for (const FaceNodes& face_nodes : face_placements_) try_placement(&face_nodes);
                restore(edge, before);
                if (result.iterations == 0) break;  // flat: another step leads to the same place
            }
        restore(edge, best);
        if (observer_) {
            ended.positions = positions(ended.nodes);
            ended.objective_after = sum.evaluate(present_variables(edge));
            ended.min_scaled_jacobian_after = patch_minimum(edge);
            tell(std::move(ended));
        }
    }

    const CurvedMesh& mesh_;
    const MeshTopology& topology_;
    const UnsignedAngleOptions& options_;
    UntangleObserver* observer_;
    const TaskContext& context_;
    QualityOptions quality_options_;
    JacobianBounds bounds_;
    std::vector<InteriorEdge> edges_;
    const KeptNodes kept_;
    const std::vector<FaceNodes> face_placements_;
    Coordinates x_;
    std::vector<ElementQuality> qualities_;
};

}  // namespace

UntangleResult untangle_unsigned_angles(const CurvedMesh& mesh, const UnsignedAngleOptions& options,
                                        UntangleObserver* observer, const TaskContext& context) {
    check(mesh, options);
    require_conforming(mesh, context);
    const NumberedAlike alike(mesh);
    GivenNumbering given(mesh, observer);
    return UnsignedAngleUntangler(alike.mesh(), options, given.listener(), context).run();
}

}  // namespace curvewright
