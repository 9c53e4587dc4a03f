#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "core/mesh/curved_mesh.h"
#include "core/quality/quality.h"
#include "ui/palette/marks.h"
#include "ui/palette/quality_colors.h"
#include "ui/scene/coloring.h"
#include "ui/scene/scene_options.h"
#include "ui/scene/view_metrics.h"

class vtkRenderer;
class vtkRenderWindowInteractor;

namespace curvewright {

struct CameraState;
struct SceneContent;
class ScenePreparation;

/// The side that the camera is on: plus_z looks along -z, from above. `fit` keeps the direction.
enum class ViewDirection { fit, plus_x, minus_x, plus_y, minus_y, plus_z, minus_z, isometric };

/// Draws one mesh state into one renderer: surface coloured by scaled Jacobian or what set_coloring says, curved
/// element edges, nodes, tangled elements that stand out, legend, axes. VTK only; it does not render by itself and
/// knows nothing of windows.
class MeshScene {
  public:
    MeshScene();
    ~MeshScene();
    MeshScene(const MeshScene&) = delete;
    MeshScene& operator=(const MeshScene&) = delete;

    vtkRenderer* renderer() const;
    /// Draws the part of the picture that begins there: see TileRenderer.
    void set_first_pixel(int x, int y);

    /// The next frame is drawn in parts, one per Render() of the window, all from where the camera was for the first.
    /// Whoever changes more than the camera and the marks before the last one has to end_parts(), and then the next
    /// frame is a whole one.
    void begin_parts();
    static inline long long most_points_of_part = 250'000;  ///< of what is drawn
    void end_parts();
    bool has_more_parts() const;

    /// Shows a mesh (none = empty). quality may be null (neutral colours) or must be the report of this very mesh.
    /// The camera stays, unless the topology is another one than before: then the view is reset.
    void set_mesh(const CurvedMesh* mesh, const QualityReport* quality);
    /// The same, and all that depends on it, in steps for large meshes: begins a drawing of what is to be shown
    /// instead; its run() may be called on another thread while the scene goes on.
    ScenePreparation prepare(SceneContent content) const;
    /// Hands a part of what was made to the graphics; false: there is no more. May be left out: the next frame does it.
    /// pre: the context of the renderer's window is current.
    bool upload_next(ScenePreparation& preparation);
    /// Shows what was made. The camera stays as with set_mesh. pre: as for upload_next, if there is a window.
    void show(ScenePreparation preparation);
    /// A frame of a motion: the same mesh elsewhere. Cheaper than set_mesh: the camera's content stays, and curved
    /// sides are cut finer only now and then. set_mesh at the end puts everything right. quality: null = colours and
    /// marks stay as they are. positions: nodes × 3.
    void show_frame(const Coordinates& positions, const QualityReport* quality);
    void set_options(const SceneOptions& options);
    const SceneOptions& options() const;

    /// What the colours say from now on, of other meshes too.
    void set_coloring(const Coloring& coloring);
    const Coloring& coloring() const;
    /// The map with the range that is shown now.
    const ColorScale& shown_scale() const;
    /// Of the strip at the right that the legend covers, device pixels.
    double legend_width() const;
    /// Whether a display position (device pixels, origin bottom left) is on the legend.
    bool is_on_legend(double x, double y) const;

    /// Elements drawn with a selection outline; empty = none.
    void set_highlighted_elements(const std::vector<Index>& elements);
    const std::vector<Index>& highlighted_elements() const;

    /// Sets the camera: `fit` keeps the direction. 2D meshes are always looked at face on, in parallel projection.
    void look(ViewDirection direction);
    /// The same from anywhere: to_eye points from the mesh to the camera.
    void look_from(const Eigen::RowVector3d& to_eye);
    /// Moves the camera so that the element fills a good part of the view.
    void focus_element(Index element);

    /// Moves the camera so that a ball (mesh units) fills the view; radius 0: with a twentieth of the mesh around it.
    void focus_ball(const Eigen::RowVector3d& center, double radius);

    /// Whether anything of the element is drawn: not if it is inside a solid or the clip plane hides it.
    bool draws_element(Index element) const;

    /// Where the camera is, to be put back there.
    CameraState camera_state() const;
    void set_camera_state(const CameraState& state);
    /// Where the camera's world lies in the mesh's space.
    const WorldFrame& world_frame() const;

    /// Takes over the view of another scene that shows the same mesh or another state of it. One that is kept fitted to
    /// the window is kept fitted to this scene's own; is_exact: the camera is where the other one is, and stays there.
    void copy_view(const MeshScene& other, bool is_exact = false);

    /// Element under a display position (device pixels, origin bottom left); none = background.
    std::optional<Index> pick_element(double x, double y) const;

    // What tools need. Display positions are device pixels, origin bottom left; points are mesh coordinates.

    /// Drawn over the mesh until the next call.
    void set_marks(const Marks& marks);
    bool is_flat() const;
    /// Display position and depth (-1 near .. 1 far) of a point; the fourth is positive in front of the camera.
    Eigen::Vector4d project(const Eigen::RowVector3d& point) const;
    /// The point under a display position at the depth of another point (2D: in the mesh's plane).
    Eigen::RowVector3d unproject(double x, double y, const Eigen::RowVector3d& at_depth_of) const;
    /// Mesh units per device pixel at a point, in the plane of the view.
    double units_per_pixel(const Eigen::RowVector3d& at) const;
    /// Unit vectors of the view in the mesh's space: right, up, towards the eye.
    Eigen::Matrix3d view_axes() const;
    /// The drawn node nearest to a display position within a radius that `accepts` (and, in 3D, that no surface hides).
    std::optional<Index> pick_node(double x, double y, double radius,
                                   const std::function<bool(Index node)>& accepts) const;
    /// Drawn nodes, and elements whose centre or drawn surface's middle, lies in a polygon of display positions; hidden
    /// ones too if see_through (2D: nothing is hidden).
    std::vector<Index> nodes_inside(const std::vector<std::array<double, 2>>& polygon, bool see_through) const;
    std::vector<Index> elements_inside(const std::vector<std::array<double, 2>>& polygon, bool see_through) const;

    /// A number on the screen.
    struct ShownNumber {
        bool is_element = false;
        std::int64_t tag = 0;
        std::array<int, 4> box{};  ///< left, bottom, right, top, device pixels, halo included
    };
    /// The numbers that the last frame showed, nearest the eye first.
    std::vector<ShownNumber> shown_numbers() const;

    /// Installs the way the mouse moves the camera: 2D pan and zoom to the pointer; 3D trackball.
    void attach_interactor(vtkRenderWindowInteractor* interactor);

  private:
    struct Parts;
    std::unique_ptr<Parts> parts_;
};

}  // namespace curvewright
