#include "core/timeline/landscape.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "core/mesh/node_elements.h"
#include "core/mesh/renumbering.h"
#include "core/optimize/bfgs.h"
#include "core/optimize/lbfgs.h"
#include "core/untangle/distortion.h"
#include "core/untangle/face_nodes.h"
#include "core/untangle/signed_angle_patch.h"

namespace curvewright {

// ---- contour lines

std::vector<std::vector<Eigen::Vector2d>> contour_lines(const Eigen::MatrixXd& values, double level) {
    // Where the level is crossed: on the edge from (row, column) to the next column (0) or row (1) of the grid. A cell
    // has two or four of them; in a saddle the mean of its corners says which belong together.
    using Edge = std::array<Eigen::Index, 3>;
    std::multimap<Edge, Edge> links;
    const auto join = [&](const Edge& a, const Edge& b) {
        links.emplace(a, b);
        links.emplace(b, a);
    };
    for (Eigen::Index r = 0; r + 1 < values.rows(); ++r)
        for (Eigen::Index c = 0; c + 1 < values.cols(); ++c) {
            const std::array<double, 4> corner{values(r, c), values(r, c + 1), values(r + 1, c + 1), values(r + 1, c)};
            if (std::any_of(corner.begin(), corner.end(), [](double v) { return !std::isfinite(v); })) continue;
            const std::array<Edge, 4> edge{Edge{r, c, 0}, Edge{r, c + 1, 1}, Edge{r + 1, c, 0}, Edge{r, c, 1}};
            std::vector<int> crossed;
            for (int i = 0; i < 4; ++i)
                if ((corner[i] > level) != (corner[(i + 1) % 4] > level)) crossed.push_back(i);
            if (crossed.size() == 2) join(edge[crossed[0]], edge[crossed[1]]);
            if (crossed.size() == 4) {
                const bool is_middle_high = corner[0] + corner[1] + corner[2] + corner[3] > 4.0 * level;
                // The corners that differ from the middle are cut off.
                const bool cuts_first = (corner[0] > level) != is_middle_high;
                join(edge[cuts_first ? 3 : 0], edge[cuts_first ? 0 : 1]);
                join(edge[cuts_first ? 1 : 2], edge[cuts_first ? 2 : 3]);
            }
        }
    const auto point = [&](const Edge& edge) {
        const auto [r, c, direction] = edge;
        const double a = values(r, c), b = direction == 0 ? values(r, c + 1) : values(r + 1, c);
        const double t = std::clamp((level - a) / (b - a), 0.0, 1.0);
        return Eigen::Vector2d(static_cast<double>(r) + (direction == 1 ? t : 0.0),
                               static_cast<double>(c) + (direction == 0 ? t : 0.0));
    };
    const auto unlink = [&](const Edge& a, const Edge& b) {
        const auto [begin, end] = links.equal_range(a);
        for (auto link = begin; link != end; ++link)
            if (link->second == b) {
                links.erase(link);
                return;
            }
    };
    std::vector<std::vector<Eigen::Vector2d>> lines;
    const auto follow = [&](Edge edge) {
        std::vector<Eigen::Vector2d> line{point(edge)};
        for (auto next = links.find(edge); next != links.end(); next = links.find(edge)) {
            const Edge to = next->second;
            links.erase(next);
            unlink(to, edge);
            edge = to;
            line.push_back(point(edge));
        }
        lines.push_back(std::move(line));
    };
    std::vector<Edge> ends;  // open lines first
    for (auto link = links.begin(); link != links.end(); link = links.upper_bound(link->first))
        if (links.count(link->first) == 1) ends.push_back(link->first);
    for (const Edge& end : ends)
        if (links.count(end) > 0) follow(end);
    while (!links.empty()) follow(Edge(links.begin()->first));
    return lines;
}

std::vector<double> even_levels(const Eigen::MatrixXd& values, int count) {
    std::vector<double> sorted;
    for (const double value : values.reshaped())
        if (std::isfinite(value)) sorted.push_back(value);
    std::sort(sorted.begin(), sorted.end());
    std::vector<double> levels;
    if (sorted.empty()) return levels;
    for (int i = 1; i <= count; ++i) {
        const double below = sorted[static_cast<std::size_t>(static_cast<double>(i) / (count + 1) *
                                                             static_cast<double>(sorted.size() - 1))];
        const auto above = std::upper_bound(sorted.begin(), sorted.end(), below + 1e-9 * std::abs(below));
        const double level = above == sorted.end() ? below : 0.5 * (below + *above);
        if (levels.empty() || level > levels.back()) levels.push_back(level);
    }
    return levels;
}

// ---- the methods' objectives

namespace {

namespace event = untangle_event;

Eigen::RowVector3d with_z(const Eigen::Vector2d& point, double z) {
    return {point[0], point[1], z};
}

}  // namespace

/// What a method minimises, as a function of the position of the node in focus.
class PatchTrial::Objective {
  public:
    virtual ~Objective() = default;
    virtual double value(const Eigen::RowVector3d& position, const TrialParameters& parameters) = 0;
    /// Fills position, path and objective; nodes that move and their positions at the end.
    virtual Outcome minimise(const TrialParameters& parameters, std::vector<Index>& nodes,
                             std::vector<Eigen::RowVector3d>& positions) = 0;
    /// Places what follows the nodes.
    virtual void complete(Coordinates&) const {}
};

namespace {

/// The blend that the face nodes of an edge's two triangles follow.
class FollowingFaceNodes {
  public:
    FollowingFaceNodes(const MeshTopology& topology, const InteriorEdge& edge, bool follow)
        : topology_(topology), edge_(edge) {
        if (follow && topology.order() >= 3) face_nodes_.emplace(topology.order(), FaceRule::blend);
    }
    void place(Coordinates& x) const {
        if (!face_nodes_) return;
        for (const Index triangle : edge_.triangles) face_nodes_->place(topology_.element_nodes(triangle), x);
    }

  private:
    const MeshTopology& topology_;
    const InteriorEdge edge_;
    std::optional<FaceNodes> face_nodes_;
};

}  // namespace

class PatchTrial::SignedAngles : public Objective {
  public:
    SignedAngles(const CurvedMesh& mesh, const OrientationSigns& signs, const SignedAngleOptions& options, const InteriorEdge& edge,
                 Index focus, const Eigen::RowVector3d& start)
        : options_(options),
          focus_(focus),
          start_(start),
          followers_(mesh.topology(), edge, options.beta_choice == BetaChoice::automatic),
          angles_(mesh.topology(), mesh.coordinates(), edge_node(edge, focus), signs) {
        if (options_.beta_choice == BetaChoice::automatic) options_.displacement = DisplacementUnit::edge_length;
        unit_ = displacement_unit(angles_, options_);
    }
    double value(const Eigen::RowVector3d& position, const TrialParameters& parameters) override {
        double sum = 0.0;
        for (const double angle : angles_.evaluate(position.head<2>())) sum += std::exp(-10.0 * angle);
        return (1.0 - parameters.beta) * (position - start_).head<2>().norm() / unit_ + parameters.beta * sum;
    }
    Outcome minimise(const TrialParameters& parameters, std::vector<Index>& nodes,
                     std::vector<Eigen::RowVector3d>& positions) override {
        struct Path : UntangleObserver {
            void on_event(const UntangleEvent& told) override {
                const auto& best = std::get<event::SimplexStep>(told).simplex[0];
                points.emplace_back(best[0], best[1]);
            }
            std::vector<Eigen::Vector2d> points;
        } path;
        const SignedAngleMinimum minimum =
            minimise_signed_angles(angles_, start_.head<2>(), unit_, parameters.beta, options_, &path, focus_);
        Outcome outcome;
        outcome.position = with_z(minimum.position, start_[2]);
        outcome.objective = minimum.objective_after;
        outcome.path.push_back(start_);
        for (const Eigen::Vector2d& point : path.points) outcome.path.push_back(with_z(point, start_[2]));
        nodes = {focus_};
        positions = {outcome.position};
        return outcome;
    }
    void complete(Coordinates& x) const override { followers_.place(x); }

  private:
    static EdgeNode edge_node(const InteriorEdge& edge, Index focus) {
        const auto place = std::find(edge.nodes.begin(), edge.nodes.end(), focus) - edge.nodes.begin();
        return {focus, edge.triangles, edge.local_edges, static_cast<int>(place) + 2};
    }

    SignedAngleOptions options_;
    Index focus_;
    Eigen::RowVector3d start_;
    FollowingFaceNodes followers_;
    EdgeAngles angles_;
    double unit_ = 1.0;
};

class PatchTrial::UnsignedAngles : public Objective {
  public:
    UnsignedAngles(const CurvedMesh& mesh, const UnsignedAngleOptions& options, const InteriorEdge& edge, Index focus)
        : options_(options),
          edge_(edge),
          followers_(mesh.topology(), edge, options.moves_face_nodes),
          sum_(mesh.topology(), mesh.coordinates(), edge),
          place_(std::find(edge.nodes.begin(), edge.nodes.end(), focus) - edge.nodes.begin()),
          z_(mesh.coordinates()(focus, 2)),
          variables_(2 * static_cast<Eigen::Index>(edge.nodes.size())) {
        for (std::size_t i = 0; i < edge.nodes.size(); ++i)
            variables_.segment<2>(static_cast<Eigen::Index>(2 * i)) = mesh.coordinates().row(edge.nodes[i]).head<2>();
    }
    double value(const Eigen::RowVector3d& position, const TrialParameters&) override {
        Eigen::VectorXd variables = variables_;
        variables.segment<2>(2 * place_) = position.head<2>();
        return sum_.evaluate(variables);
    }
    Outcome minimise(const TrialParameters& parameters, std::vector<Index>& nodes,
                     std::vector<Eigen::RowVector3d>& positions) override {
        BfgsOptions bfgs;
        const double length = sum_.edge_length();
        bfgs.max_iterations = options_.max_iterations;
        bfgs.gradient_tolerance = options_.gradient_tolerance / length;
        bfgs.initial_hessian = 1.0 / (parameters.first_step * length * length);
        Eigen::VectorXd variables = variables_;
        Outcome outcome;
        const BfgsResult result = minimize_bfgs(
            variables, [&](const Eigen::VectorXd& v, Eigen::VectorXd& gradient) { return sum_.evaluate(v, gradient); },
            [&](const Eigen::VectorXd& v) { return sum_.evaluate(v); }, bfgs,
            [&](const BfgsState& state) { outcome.path.push_back(with_z(state.x.segment<2>(2 * place_), z_)); });
        outcome.objective = result.value;
        outcome.position = outcome.path.back();
        nodes = edge_.nodes;
        positions.clear();
        for (std::size_t i = 0; i < nodes.size(); ++i)
            positions.push_back(with_z(variables.segment<2>(static_cast<Eigen::Index>(2 * i)), z_));
        return outcome;
    }
    void complete(Coordinates& x) const override { followers_.place(x); }

  private:
    UnsignedAngleOptions options_;
    InteriorEdge edge_;
    FollowingFaceNodes followers_;
    UnsignedAngleSum sum_;
    Eigen::Index place_;  ///< of the node in focus among the edge's
    double z_;
    Eigen::VectorXd variables_;
};

class PatchTrial::Energy : public Objective {
  public:
    Energy(const CurvedMesh& mesh, const Coordinates& ideal, const OrientationSigns& signs,
           std::vector<Index> elements, Index focus)
        : objective_(mesh.topology(), mesh.coordinates(), ideal, signs, {std::move(elements), {focus}}),
          x_(mesh.coordinates()),
          focus_(focus) {}
    double value(const Eigen::RowVector3d& position, const TrialParameters& parameters) override {
        x_.row(focus_) = position;
        Eigen::VectorXd gradient;
        return objective_.evaluate(objective_.variables(x_), options(parameters), gradient);
    }
    Outcome minimise(const TrialParameters& parameters, std::vector<Index>& nodes,
                     std::vector<Eigen::RowVector3d>& positions) override {
        Coordinates x = x_;
        x.row(focus_) = start_.value_or(x.row(focus_));
        Eigen::VectorXd variables = objective_.variables(x);
        Outcome outcome;
        outcome.path.push_back(x.row(focus_));
        const LbfgsResult result = minimize_lbfgs(
            variables,
            [&](const Eigen::VectorXd& v, Eigen::VectorXd& gradient) {
                return objective_.evaluate(v, options(parameters), gradient);
            },
            {},
            [&](const Eigen::VectorXd& v, double, int) {
                objective_.store(v, x);
                outcome.path.push_back(x.row(focus_));
                return true;
            });
        outcome.objective = result.value;
        outcome.position = outcome.path.back();
        nodes = {focus_};
        positions = {outcome.position};
        return outcome;
    }
    void set_start(const Eigen::RowVector3d& start) { start_ = start; }

  private:
    static DistortionOptions options(const TrialParameters& parameters) {
        DistortionOptions options;
        options.eps = parameters.eps;
        return options;
    }

    PatchObjective objective_;
    Coordinates x_;
    Index focus_;
    std::optional<Eigen::RowVector3d> start_;
};

PatchTrial::PatchTrial(const CurvedMesh& mesh, const OrientationSigns& signs, UntangleMethod method,
                       const UntangleOptions& options, std::vector<Index> elements, Index focus,
                       const Eigen::RowVector3d& start, const Coordinates& ideal)
    : mesh_(numbered_alike(mesh)), signs_(signs), focus_(focus), elements_(std::move(elements)) {
    const MeshTopology& topology = mesh_.topology();
    if (method == UntangleMethod::guaranteed) {
        std::erase_if(elements_, [&](Index element) {
            const auto nodes = topology.element_nodes(element);
            return std::find(nodes.begin(), nodes.end(), focus) == nodes.end();
        });
        auto energy = std::make_unique<Energy>(mesh_, ideal, signs_, elements_, focus);
        energy->set_start(start);
        objective_ = std::move(energy);
        return;
    }
    const auto edge =
        elements_.size() == 2 ? find_interior_edge(topology, {elements_[0], elements_[1]}, focus) : std::nullopt;
    if (!edge) throw InvalidInput("The node in focus is on no edge between the two triangles of its patch.");
    // Of another run, or of none that is known: the parameters that are not tried out are the usual ones.
    if (method == UntangleMethod::signed_angles) {
        const auto* given = std::get_if<SignedAngleOptions>(&options);
        objective_ =
            std::make_unique<SignedAngles>(mesh_, signs_, given ? *given : SignedAngleOptions{}, *edge, focus, start);
    } else {
        const auto* given = std::get_if<UnsignedAngleOptions>(&options);
        objective_ = std::make_unique<UnsignedAngles>(mesh_, given ? *given : UnsignedAngleOptions{}, *edge, focus);
    }
}

PatchTrial::~PatchTrial() = default;

double PatchTrial::value(const Eigen::RowVector3d& position, const TrialParameters& parameters) {
    return objective_->value(position, parameters);
}

Landscape PatchTrial::landscape(const Eigen::RowVector3d& center, const Eigen::RowVector3d& across,
                                const Eigen::RowVector3d& up, int resolution, const TrialParameters& parameters,
                                const TaskContext& context) {
    Landscape landscape{center, across, up, Eigen::MatrixXd(resolution, resolution)};
    for (Eigen::Index row = 0; row < resolution; ++row) {
        context.check();
        for (Eigen::Index column = 0; column < resolution; ++column) {
            const double value =
                this->value(landscape.at(static_cast<double>(row), static_cast<double>(column)), parameters);
            landscape.values(row, column) = std::isfinite(value) ? value : std::numeric_limits<double>::infinity();
        }
    }
    return landscape;
}

PatchTrial::Outcome PatchTrial::outcome(const TrialParameters& parameters) {
    std::vector<Index> nodes;
    std::vector<Eigen::RowVector3d> positions;
    Outcome outcome = objective_->minimise(parameters, nodes, positions);
    Coordinates x = mesh_.coordinates();
    for (std::size_t i = 0; i < nodes.size(); ++i) x.row(nodes[i]) = positions[i];
    objective_->complete(x);
    QualityOptions options;
    options.orientation_sign = signs_;
    outcome.min_scaled_jacobian = std::numeric_limits<double>::infinity();
    for (const ElementQuality& quality : certify_elements(mesh_.topology(), elements_, x, options)) {
        outcome.min_scaled_jacobian = std::min(outcome.min_scaled_jacobian, quality.scaled_jacobian);
        outcome.not_valid += quality.validity == Validity::valid ? 0 : 1;
    }
    return outcome;
}

}  // namespace curvewright
