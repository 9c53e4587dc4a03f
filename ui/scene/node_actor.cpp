#include "ui/scene/node_actor.h"

#include <algorithm>

#include <vtkActor.h>

namespace curvewright {
namespace {

constexpr double corner_diameter = 8.0, other_diameter = 5.5;
constexpr std::size_t few_points = 20000;  ///< are one part

}  // namespace

std::vector<vtkActor*> NodeActors::actors() const {
    std::vector<vtkActor*> actors;
    for (std::size_t set = 1; set < sets_.size(); ++set) actors.push_back(sets_[set].actor());
    actors.push_back(sets_[0].actor());
    return actors;
}

void NodeActors::set_nodes(const CurvedMesh& mesh, const Tessellation& tessellation, const WorldFrame& frame) {
    const MeshTopology& topology = mesh.topology();
    std::vector<bool> is_corner(static_cast<std::size_t>(topology.node_count()), false);
    for (Index element = 0; element < topology.element_count(); ++element) {
        const auto nodes = topology.element_nodes(element);
        const int corners = corner_count(topology.element_type(element).shape);
        for (int i = 0; i < corners; ++i) is_corner[nodes[i]] = true;
    }
    const auto others = static_cast<std::size_t>(
        std::ranges::count_if(tessellation.nodes(), [&](Index node) { return !is_corner[node]; }));
    const std::size_t parts = sets_.size() - 1, each = std::max(few_points, (others + parts - 1) / parts);
    std::array<std::vector<float>, 4> points;
    for (auto& flags : is_boundary_) flags.clear();
    std::size_t other = 0;
    for (Index node : tessellation.nodes()) {
        const std::size_t set = is_corner[node] ? 0 : 1 + other++ / each;
        for (int d = 0; d < 3; ++d)
            points[set].push_back(static_cast<float>(mesh.coordinates()(node, d) - tessellation.origin()[d]));
        is_boundary_[set].push_back(topology.is_boundary_node(node));
    }
    for (std::size_t set = 0; set < sets_.size(); ++set)
        sets_[set].set_points(points[set], tessellation.origin(), frame);
    color_points();
    set_visible(is_visible_);
}

void NodeActors::color_points() {
    for (std::size_t set = 0; set < sets_.size(); ++set) {
        std::vector<Color> colors;
        colors.reserve(is_boundary_[set].size());
        for (bool is_boundary : is_boundary_[set]) colors.push_back(is_boundary ? boundary_ : interior_);
        sets_[set].set_colors(colors);
    }
}

void NodeActors::set_colors(const Color& boundary, const Color& interior, const Color& rim) {
    for (PointActor& set : sets_) set.set_rim(rim);
    if (boundary == boundary_ && interior == interior_) return;
    boundary_ = boundary;
    interior_ = interior;
    color_points();
}

void NodeActors::set_visible(bool is_visible) {
    is_visible_ = is_visible;
    for (PointActor& set : sets_) set.actor()->SetVisibility(is_visible && !set.is_empty());
}

void NodeActors::update(const ViewMetrics& view, double spacing, double distance) {
    // Small elements get small points: they must not hide what they are on.
    const double room = spacing * view.pixels_per_unit(distance) / view.pixel_ratio;
    const double shrink = std::clamp(room / 45.0, 0.4, 1.0);
    for (std::size_t set = 0; set < sets_.size(); ++set)
        sets_[set].set_diameter((set == 0 ? corner_diameter : other_diameter) * shrink * view.pixel_ratio);
}

}  // namespace curvewright
