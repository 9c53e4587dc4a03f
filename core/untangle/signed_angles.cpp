#include "core/untangle/signed_angles.h"

#include <cmath>

#include <fmt/format.h>

#include "core/base/error.h"
#include "core/basis/reference_element.h"
#include "core/optimize/nelder_mead.h"
#include "core/quality/jacobian_bounds.h"
#include "core/quality/quality.h"
#include "core/untangle/edge_angles.h"

namespace curvewright {
namespace {

namespace event = untangle_event;

void check(const CurvedMesh& mesh, const SignedAngleOptions& options) {
    const auto type = mesh.topology().uniform_type();
    if (!type || type->shape != Shape::triangle || type->order < 2 || type->order > 3)
        throw Unsupported(
            fmt::format("Untangling by signed angles works on triangles of order 2 or 3; this mesh has {}.",
                        type ? name(*type) + " elements" : std::string("elements of several types")));
    require_assessable(mesh);
    if (!(options.beta > 0.0 && options.beta <= 1.0))
        throw InvalidInput(fmt::format("beta is {}; it must be greater than 0 and at most 1.", options.beta));
    if (options.max_passes < 1)
        throw InvalidInput(fmt::format("The number of passes is {}; it must be at least 1.", options.max_passes));
}

event::Position position_of(const Coordinates& x, Index node) {
    return {x(node, 0), x(node, 1), x(node, 2)};
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
          sign_(orientation_sign(find_orientation(mesh), mesh)),
          bounds_(*topology_.uniform_type()),
          edge_nodes_(find_interior_edge_nodes(topology_)),
          x_(mesh.coordinates()) {}

    UntangleResult run() {
        tell(event::Started{&mesh_});
        UntangleResult result;
        result.reason = StopReason::pass_limit;
        const bool needs_quality = observer_ != nullptr || options_.reject_worse_pass;
        QualityReport quality;
        if (options_.reject_worse_pass) quality = assess_quality(mesh_, {}, context_);
        while (result.passes < options_.max_passes && result.reason == StopReason::pass_limit) {
            const Coordinates before = x_;
            const int pass = result.passes + 1;
            tell(event::PassBegan{pass});
            move_edge_nodes(pass);
            move_face_nodes();
            const double change = (x_ - before).norm() / x_.norm();
            if (needs_quality) {
                const QualityReport after = assess_quality(mesh_.with_coordinates(x_), {}, context_);
                if (options_.reject_worse_pass && is_worse(after.summary, quality.summary)) {
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
        tell(event::Finished{result.reason, result.passes});
        result.coordinates = std::move(x_);
        return result;
    }

  private:
    template <class Event>
    void tell(Event&& event) {
        if (observer_) observer_->on_event(UntangleEvent(std::forward<Event>(event)));
    }

    /// More elements that are not proved valid, or as many and a lower minimum.
    static bool is_worse(const QualitySummary& after, const QualitySummary& before) {
        const Index bad_after = after.invalid + after.undecided, bad_before = before.invalid + before.undecided;
        return bad_after != bad_before ? bad_after > bad_before : after.min < before.min;
    }

    double patch_minimum(const EdgeNode& edge_node) {
        double minimum = std::numeric_limits<double>::infinity();
        for (Index triangle : edge_node.triangles) {
            const auto nodes = topology_.element_nodes(triangle);
            Eigen::MatrixX3d x(static_cast<Eigen::Index>(nodes.size()), 3);
            for (std::size_t i = 0; i < nodes.size(); ++i) x.row(static_cast<Eigen::Index>(i)) = x_.row(nodes[i]);
            minimum = std::min(minimum, bounds_.bound(x, sign_, {}).scaled_jacobian);
        }
        return minimum;
    }

    void move_edge_nodes(int pass) {
        const std::string phase = fmt::format("Untangling, pass {}", pass);
        for (std::size_t i = 0; i < edge_nodes_.size(); ++i) {
            if (i % 64 == 0)
                context_.report(phase, static_cast<double>(i) / static_cast<double>(edge_nodes_.size()));
            else
                context_.check();
            move_edge_node(edge_nodes_[i]);
        }
    }

    void move_edge_node(const EdgeNode& edge_node) {
        const EdgeAngles angles(topology_, x_, edge_node, sign_);
        const Eigen::Vector2d initial = x_.row(edge_node.node).head<2>();
        const double beta = options_.beta;
        const auto displacement_term = [&](const std::array<double, 2>& p) {
            return (1.0 - beta) * (Eigen::Vector2d(p[0], p[1]) - initial).norm();
        };
        const auto angle_term = [&](const std::array<double, 2>& p) {
            double sum = 0.0;
            for (double angle : angles.evaluate({p[0], p[1]})) sum += std::exp(-10.0 * angle);
            return beta * sum;
        };
        const auto objective = [&](const std::array<double, 2>& p) { return displacement_term(p) + angle_term(p); };
        const std::array<double, 2> start{initial[0], initial[1]};

        event::PatchEnded ended;
        if (observer_) {
            tell(event::PatchBegan{{edge_node.node},
                                   {edge_node.triangles.begin(), edge_node.triangles.end()},
                                   {position_of(x_, edge_node.node)}});
            ended.nodes = {edge_node.node};
            ended.beta = beta;
            ended.objective_before = objective(start);
            ended.min_scaled_jacobian_before = patch_minimum(edge_node);
        }
        const auto watch = [&](int iteration, const NelderMeadSimplex<2>& simplex) {
            if (!observer_) return;
            const auto& best = simplex.vertices[0];
            tell(event::SimplexStep{iteration, simplex.vertices, simplex.values, displacement_term(best),
                                    angle_term(best), angles.evaluate({best[0], best[1]})});
        };
        const auto minimum = nelder_mead<2>(objective, start, options_.simplex_size * angles.edge_length(),
                                            {options_.simplex_iterations, options_.simplex_tolerance}, watch);
        x_(edge_node.node, 0) = minimum.point[0];
        x_(edge_node.node, 1) = minimum.point[1];
        if (observer_) {
            ended.iterations = minimum.iterations;
            ended.objective_after = minimum.value;
            ended.positions = {position_of(x_, edge_node.node)};
            ended.min_scaled_jacobian_after = patch_minimum(edge_node);
            tell(std::move(ended));
        }
    }

    void move_face_nodes() {
        event::FaceNodesMoved moved;
        const ReferenceElement& element = reference_element(*topology_.uniform_type());
        for (Index triangle = 0; triangle < topology_.element_count(); ++triangle) {
            const auto nodes = topology_.element_nodes(triangle);
            Eigen::RowVector2d mean = Eigen::RowVector2d::Zero();
            int count = 0;
            for (const SubElement& edge : element.edges)
                for (std::size_t i = 2; i < edge.nodes.size(); ++i, ++count)
                    mean += x_.row(nodes[edge.nodes[i]]).head<2>();
            for (int local : element.interior_nodes) {
                x_.row(nodes[local]).head<2>() = mean / count;
                if (observer_) {
                    moved.nodes.push_back(nodes[local]);
                    moved.positions.push_back(position_of(x_, nodes[local]));
                }
            }
        }
        if (!moved.nodes.empty()) tell(std::move(moved));
    }

    const CurvedMesh& mesh_;
    const MeshTopology& topology_;
    const SignedAngleOptions& options_;
    UntangleObserver* observer_;
    const TaskContext& context_;
    double sign_;
    JacobianBounds bounds_;
    std::vector<EdgeNode> edge_nodes_;
    Coordinates x_;
};

}  // namespace

UntangleResult untangle_signed_angles(const CurvedMesh& mesh, const SignedAngleOptions& options,
                                      UntangleObserver* observer, const TaskContext& context) {
    check(mesh, options);
    return SignedAngleUntangler(mesh, options, observer, context).run();
}

}  // namespace curvewright
