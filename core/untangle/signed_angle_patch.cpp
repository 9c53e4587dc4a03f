#include "core/untangle/signed_angle_patch.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>

#include "core/optimize/nelder_mead.h"

namespace curvewright {

namespace event = untangle_event;

double displacement_unit(const EdgeAngles& angles, const SignedAngleOptions& options) {
    return options.displacement == DisplacementUnit::mesh_unit ? 1.0 : angles.edge_length();
}

SignedAngleMinimum minimise_signed_angles(const EdgeAngles& angles, const Eigen::Vector2d& initial, double unit,
                                          double beta, const SignedAngleOptions& options, UntangleObserver* observer,
                                          Index node) {
    if (!(unit > 0.0)) return {initial};
    // The unknown is the displacement in units of `unit`: in the length-normalised variant everything below, the
    // tolerance included, is the same whatever the mesh's unit of length.
    using Point = std::array<double, 2>;
    const auto position = [&](const Point& u) -> Eigen::Vector2d {
        return initial + unit * Eigen::Vector2d(u[0], u[1]);
    };
    const auto displacement_term = [&](const Point& u) { return (1.0 - beta) * std::hypot(u[0], u[1]); };
    const auto angle_term = [&](const Point& u) {
        double sum = 0.0;
        for (double angle : angles.evaluate(position(u))) sum += std::exp(-10.0 * angle);
        return beta * sum;
    };
    const auto objective = [&](const Point& u) { return displacement_term(u) + angle_term(u); };
    const auto watch = [&](int iteration, const NelderMeadSimplex<2>& simplex) {
        if (!observer) return;
        const Point& best = simplex.vertices[0];
        event::SimplexStep step{node,
                                iteration,
                                {},
                                simplex.values,
                                displacement_term(best),
                                angle_term(best),
                                angles.evaluate(position(best))};
        for (int i = 0; i < 3; ++i) {
            const Eigen::Vector2d vertex = position(simplex.vertices[i]);
            step.simplex[i] = {vertex[0], vertex[1]};
        }
        observer->on_event(step);
    };
    const Point start{0.0, 0.0};
    const auto minimum = nelder_mead<2>(objective, start, options.simplex_size * angles.edge_length() / unit,
                                        {options.simplex_iterations, options.simplex_tolerance}, watch);
    return {position(minimum.point), minimum.iterations, objective(start), minimum.value};
}

PatchQuality assess_patch(const MeshTopology& topology, const Coordinates& x, const EdgeNode& edge_node,
                          const OrientationSigns& signs, JacobianBounds& bounds) {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    PatchQuality quality{0, infinity, 0.0};
    std::vector<double> relative;  // Bézier coefficients of both
    Eigen::MatrixX3d positions;
    for (const Index triangle : edge_node.triangles) {
        const auto nodes = topology.element_nodes(triangle);
        positions.resize(static_cast<Eigen::Index>(nodes.size()), 3);
        for (std::size_t i = 0; i < nodes.size(); ++i) positions.row(static_cast<Eigen::Index>(i)) = x.row(nodes[i]);
        const ElementQuality element = bounds.bound(positions, signs.of_element(topology, triangle), {});
        quality.not_valid += element.validity != Validity::valid;
        quality.minimum = std::min(quality.minimum, element.scaled_jacobian);

        // The corners do not move, so the scale is the same before and after. Corners on a line give none: 1 of the
        // coefficients' own unit (see JacobianBounds), in which the element's extent is about 1, then serves as well.
        const Eigen::RowVector3d u = positions.row(1) - positions.row(0), v = positions.row(2) - positions.row(0);
        const double straight = std::ldexp(std::abs(u[0] * v[1] - u[1] * v[0]), -bounds.exponent());
        const double scale = straight > 1e-12 ? straight : 1.0;
        for (const double coefficient : bounds.coefficients()) relative.push_back(coefficient / scale);
    }
    constexpr double sharpness = 20.0;
    const double least = *std::min_element(relative.begin(), relative.end());
    double sum = 0.0;
    for (const double value : relative) sum += std::exp(-sharpness * (value - least));
    quality.soft_minimum = least - std::log(sum / static_cast<double>(relative.size())) / sharpness;
    return quality;
}

bool is_worse(const QualitySummary& after, const QualitySummary& before) {
    const Index bad_after = after.invalid + after.undecided, bad_before = before.invalid + before.undecided;
    return bad_after != bad_before ? bad_after > bad_before : after.min < before.min;
}

std::vector<std::vector<std::size_t>> batch_in_order(const std::vector<EdgeNode>& edge_nodes, Index element_count) {
    std::vector<std::vector<std::size_t>> batches;
    std::vector<std::size_t> next(static_cast<std::size_t>(element_count), 0);  // batches that know the triangle
    for (std::size_t i = 0; i < edge_nodes.size(); ++i) {
        const auto [a, b] = edge_nodes[i].triangles;
        const std::size_t batch = std::max(next[a], next[b]);
        if (batch == batches.size()) batches.emplace_back();
        batches[batch].push_back(i);
        next[a] = next[b] = batch + 1;
    }
    return batches;
}

std::vector<EdgeNodes> group_by_edge(const std::vector<EdgeNode>& edge_nodes) {
    std::vector<EdgeNodes> edges;
    std::map<std::pair<Index, int>, std::size_t> position;  // by first triangle and local edge
    for (const EdgeNode& node : edge_nodes) {
        const auto [entry, is_new] = position.try_emplace({node.triangles[0], node.local_edges[0]}, edges.size());
        if (is_new) edges.emplace_back();
        edges[entry->second].push_back(node);
    }
    for (EdgeNodes& edge : edges)
        std::sort(edge.begin(), edge.end(),
                  [](const EdgeNode& a, const EdgeNode& b) { return a.position < b.position; });
    return edges;
}

std::vector<std::vector<std::size_t>> colour_edges(const std::vector<EdgeNodes>& edges, Index element_count) {
    std::vector<std::vector<std::size_t>> colours;
    std::vector<unsigned> used(static_cast<std::size_t>(element_count), 0);  // bit per colour of the triangle's edges
    for (std::size_t i = 0; i < edges.size(); ++i) {
        const auto [a, b] = edges[i][0].triangles;
        std::size_t colour = 0;
        while ((used[a] | used[b]) >> colour & 1u) ++colour;
        if (colour == colours.size()) colours.emplace_back();
        colours[colour].push_back(i);
        used[a] |= 1u << colour;
        used[b] |= 1u << colour;
    }
    return colours;
}

}  // namespace curvewright
