#pragma once

#include <cstddef>
#include <optional>
#include <variant>
#include <vector>

#include "app/cli/command.h"
#include "app/cli/output.h"
#include "ui/scene/mesh_scene.h"

namespace curvewright::cli {

/// Elements by what they are: all that are not valid, so many of the worst, or those with given tags.
struct ElementChoice {
    enum class Kind { tangled, worst, tags } kind = Kind::worst;
    std::size_t count = 1;           ///< of the worst
    std::vector<std::int64_t> tags;  ///< of Kind::tags
};

/// Where a picture is taken from, and what of the mesh it shows.
struct RenderView {
    std::optional<Eigen::RowVector3d> to_eye;  ///< none: as the scene has it
    std::vector<double> zoom;                  ///< x, y, (z,) radius of a ball; empty: no
    std::optional<ElementChoice> focus, outline;
    double margin = 1.0;  ///< around what is focused, of its radius

    bool is_near() const { return !zoom.empty() || focus; }
};

/// Adds --view, --zoom, --focus, --margin and --outline.
void add_view_options(CLI::App& command, RenderView& view);

/// What a picture from near shows.
struct ShownBall {
    Eigen::RowVector3d center = Eigen::RowVector3d::Zero();
    double radius = 0.0;
    std::vector<Index> elements;  ///< of --focus
};
/// None if the whole mesh is to be seen. quality: null if it cannot be assessed. Throws InvalidInput if there is no
/// such element or the numbers do not fit the mesh.
std::optional<ShownBall> find_shown_ball(const RenderView& view, const CurvedMesh& mesh, const QualityReport* quality);
/// Throws like find_shown_ball.
std::vector<Index> choose_elements(const ElementChoice& choice, const CurvedMesh& mesh, const QualityReport* quality);

/// The magnification of a picture of the ball.
double magnification(const ShownBall& ball, const CurvedMesh& mesh);
/// Puts the camera of a scene that shows the mesh where the view is taken from. size: of the picture, pixels.
void apply_view(const RenderView& view, const std::optional<ShownBall>& ball, int width, int height, MeshScene& scene);

/// "center", "radius", "elements" (tags).
Json ball_json(const ShownBall& ball, const CurvedMesh& mesh);

}  // namespace curvewright::cli
