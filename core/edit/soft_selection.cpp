#include "core/edit/soft_selection.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>

namespace curvewright {
namespace {

/// Distance of every boundary node from the nearest source: by Dijkstra's algorithm over the nodes of each facet.
std::vector<double> distances_along(const BoundaryParts& boundary, const Coordinates& x, const IndexSet& sources,
                                    double radius) {
    std::vector<double> distance(static_cast<std::size_t>(x.rows()), std::numeric_limits<double>::infinity());
    using Entry = std::pair<double, Index>;
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
    for (Index node : sources) {
        distance[static_cast<std::size_t>(node)] = 0.0;
        queue.emplace(0.0, node);
    }
    while (!queue.empty()) {
        const auto [so_far, node] = queue.top();
        queue.pop();
        if (so_far > distance[static_cast<std::size_t>(node)] || so_far > radius) continue;
        for (Index facet : boundary.facets_of_node(node))
            for (Index other : boundary.facet_nodes(facet)) {
                const double there = so_far + (x.row(other) - x.row(node)).norm();
                double& best = distance[static_cast<std::size_t>(other)];
                if (there < best) queue.emplace(best = there, other);
            }
    }
    return distance;
}

/// As the crow flies, to the nearest source.
std::vector<double> distances_straight(const MeshTopology& topology, const Coordinates& x, const IndexSet& sources) {
    std::vector<double> distance(static_cast<std::size_t>(x.rows()), std::numeric_limits<double>::infinity());
    for (Index node : topology.boundary_nodes()) {
        double& best = distance[static_cast<std::size_t>(node)];
        for (Index source : sources) best = std::min(best, (x.row(node) - x.row(source)).squaredNorm());
        best = std::sqrt(best);
    }
    return distance;
}

}  // namespace

const char* to_string(Falloff falloff) {
    switch (falloff) {
        case Falloff::smooth:
            return "smooth";
        case Falloff::sphere:
            return "sphere";
        case Falloff::root:
            return "root";
        case Falloff::linear:
            return "linear";
        case Falloff::sharp:
            return "sharp";
    }
    return "";
}

double falloff_weight(Falloff falloff, double t) {
    if (!(t < 1.0)) return 0.0;
    switch (falloff) {
        case Falloff::smooth:
            return 1.0 - t * t * (3.0 - 2.0 * t);
        case Falloff::sphere:
            return std::sqrt(1.0 - t * t);
        case Falloff::root:
            return std::sqrt(1.0 - t);
        case Falloff::linear:
            return 1.0 - t;
        case Falloff::sharp:
            return (1.0 - t) * (1.0 - t);
    }
    return 0.0;
}

DraggedSet soft_selection(const BoundaryParts& boundary, const MeshTopology& topology, const Coordinates& x,
                          const IndexSet& selected, const IndexSet& pinned, const SoftSelection& options) {
    DraggedSet set;
    if (!(options.radius > 0.0)) {
        set.nodes = without(selected, pinned);
        return set;
    }
    IndexSet sources;
    for (Index node : selected)
        if (topology.is_boundary_node(node)) sources.push_back(node);
    const std::vector<double> distance = options.follows_boundary
                                             ? distances_along(boundary, x, sources, options.radius)
                                             : distances_straight(topology, x, sources);
    IndexSet reached = selected;
    for (Index node : topology.boundary_nodes())
        if (distance[static_cast<std::size_t>(node)] < options.radius) reached.push_back(node);
    std::sort(reached.begin(), reached.end());
    reached.erase(std::unique(reached.begin(), reached.end()), reached.end());
    for (Index node : without(reached, pinned)) {
        const bool is_selected = std::binary_search(selected.begin(), selected.end(), node);
        const double weight =
            is_selected ? 1.0
                        : falloff_weight(options.falloff, distance[static_cast<std::size_t>(node)] / options.radius);
        if (weight == 0.0) continue;
        set.nodes.push_back(node);
        set.weights.push_back(weight);
    }
    return set;
}

}  // namespace curvewright
