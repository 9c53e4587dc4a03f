#pragma once

#include <array>
#include <optional>
#include <vector>

#include "core/mesh/curved_mesh.h"
#include "core/tessellate/plane_cut.h"
#include "ui/palette/quality_colors.h"
#include "ui/scene/text_font.h"

namespace curvewright {

/// What a clip plane takes away: the elements whose centre is on its positive side, or all that is there, through the
/// elements.
enum class ClipStyle { whole_elements, cut };

struct ClipPlane {
    std::array<double, 3> normal{1.0, 0.0, 0.0};  ///< unit
    /// Position along the normal as a fraction of the mesh's extent in that direction: 0 hides all, 1 hides none.
    double position = 0.5;
    ClipStyle style = ClipStyle::whole_elements;
    friend bool operator==(const ClipPlane&, const ClipPlane&) = default;
};

struct SceneOptions {
    bool show_edges = true;
    bool show_nodes = false;
    bool show_node_numbers = false;     ///< the file's tags, as many as there is room for
    bool show_element_numbers = false;  ///< likewise
    bool show_legend = true;
    std::optional<ClipPlane> clip;                    ///< 3D meshes only
    bool is_orthographic = false;                     ///< 3D meshes in parallel projection
    double element_size = 1.0;                        ///< below 1: gaps between the elements
    double magnification = 1.0;                       ///< of a picture from near: curved sides are cut so much finer
    std::optional<std::vector<Index>> only_elements;  ///< the others are hidden
    Color background{1.0, 1.0, 1.0};
    Color foreground{0.1, 0.1, 0.1};  ///< text, legend, axes
    Color edge_color{0.25, 0.27, 0.30};
    Color accent{0.06, 0.40, 0.95};  ///< selection and handles
    TextFont font;                   ///< of text, legend and numbers
    double pixel_ratio = 1.0;        ///< device pixels per unit: scales lines, points, text
};

/// The plane that a clip plane stands for; none if it hides nothing.
std::optional<CuttingPlane> find_plane(const CurvedMesh& mesh, const std::optional<ClipPlane>& clip);

/// What is to be drawn of a mesh: one flag per element; empty = all.
std::vector<bool> find_visible(const CurvedMesh& mesh, const SceneOptions& options);

/// Whether elements are cut into the same pieces.
inline bool has_same_pieces(const SceneOptions& before, const SceneOptions& now) {
    return before.element_size == now.element_size && before.magnification == now.magnification;
}

/// What has to be made anew of a drawing when its options change.
enum class Redrawing { nothing, numbers, cut, all };
Redrawing redrawing(const SceneOptions& before, const SceneOptions& now);
/// Whether that is more than the numbers.
inline bool draws_anew(const SceneOptions& before, const SceneOptions& now) {
    return redrawing(before, now) >= Redrawing::cut;
}

}  // namespace curvewright
