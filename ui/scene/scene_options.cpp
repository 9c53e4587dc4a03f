#include "ui/scene/scene_options.h"

#include <algorithm>
#include <limits>
#include <utility>

namespace curvewright {

std::optional<CuttingPlane> find_plane(const CurvedMesh& mesh, const std::optional<ClipPlane>& clip) {
    if (!clip || clip->position >= 1.0 || mesh.topology().dimension() < 3) return std::nullopt;
    const Eigen::RowVector3d normal(clip->normal[0], clip->normal[1], clip->normal[2]);
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (Index element = 0; element < mesh.topology().element_count(); ++element)
        for (Index node : mesh.topology().element_nodes(element)) {
            const double along = mesh.coordinates().row(node).dot(normal);
            low = std::min(low, along);
            high = std::max(high, along);
        }
    // All is hidden, what bulges over the nodes as well.
    if (clip->position <= 0.0) return CuttingPlane{normal, low - (high - low)};
    return CuttingPlane{normal, low + clip->position * (high - low)};
}

std::vector<bool> find_visible(const CurvedMesh& mesh, const SceneOptions& options) {
    const auto count = static_cast<std::size_t>(mesh.topology().element_count());
    std::vector<bool> visible;
    if (options.clip && options.clip->style == ClipStyle::whole_elements) {
        if (const std::optional<CuttingPlane> plane = find_plane(mesh, options.clip)) {
            visible.resize(count);
            for (Index element = 0; element < mesh.topology().element_count(); ++element)
                visible[static_cast<std::size_t>(element)] = plane->distance(mesh.element_center(element)) <= 0.0;
        }
    }
    if (!options.only_elements) return visible;
    const std::vector<bool> cut = std::exchange(visible, std::vector<bool>(count, false));
    for (const Index element : *options.only_elements)
        if (element >= 0 && element < mesh.topology().element_count())
            visible[static_cast<std::size_t>(element)] = cut.empty() || cut[static_cast<std::size_t>(element)];
    return visible;
}

Redrawing redrawing(const SceneOptions& before, const SceneOptions& now) {
    const auto hides_whole = [](const std::optional<ClipPlane>& clip) {
        return clip && clip->style == ClipStyle::whole_elements;
    };
    const bool is_clip_changed = before.clip != now.clip;
    if (!has_same_pieces(before, now) || before.only_elements != now.only_elements ||
        (is_clip_changed && (hides_whole(before.clip) || hides_whole(now.clip))))
        return Redrawing::all;
    if (is_clip_changed) return Redrawing::cut;  // the surface is the same, only cut elsewhere
    return before.show_node_numbers != now.show_node_numbers || before.show_element_numbers != now.show_element_numbers
               ? Redrawing::numbers
               : Redrawing::nothing;
}

}  // namespace curvewright
