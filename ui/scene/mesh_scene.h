#pragma once

#include <array>
#include <memory>
#include <optional>
#include <vector>

#include "core/mesh/curved_mesh.h"
#include "core/quality/quality.h"
#include "ui/palette/quality_colors.h"

class vtkRenderer;
class vtkRenderWindowInteractor;

namespace curvewright {

/// Elements whose centre is on the positive side of the plane are hidden (whole elements).
struct ClipPlane {
    std::array<double, 3> normal{1.0, 0.0, 0.0};  ///< unit
    /// Position along the normal as a fraction of the mesh's extent in that direction: 0 hides all, 1 hides none.
    double position = 0.5;
};

struct SceneOptions {
    bool show_edges = true;
    bool show_nodes = false;
    bool show_legend = true;
    std::optional<ClipPlane> clip;  ///< 3D meshes only
    Color background{1.0, 1.0, 1.0};
    Color foreground{0.1, 0.1, 0.1};  ///< text, legend, axes
    Color edge_color{0.25, 0.27, 0.30};
    double pixel_ratio = 1.0;  ///< device pixels per unit: scales lines, points, text
};

enum class ViewDirection { fit, plus_x, minus_x, plus_y, minus_y, plus_z, minus_z, isometric };

/// Draws one mesh state into one renderer: surface coloured by scaled Jacobian, curved element edges, nodes, tangled
/// elements that stand out, legend, axes. VTK only; it does not render by itself and knows nothing of windows.
class MeshScene {
  public:
    MeshScene();
    ~MeshScene();
    MeshScene(const MeshScene&) = delete;
    MeshScene& operator=(const MeshScene&) = delete;

    vtkRenderer* renderer() const;

    /// Shows a mesh (none = empty). quality may be null (neutral colours) or must be the report of this very mesh.
    /// The camera stays, unless the topology is another one than before: then the view is reset.
    void set_mesh(const CurvedMesh* mesh, const QualityReport* quality);
    void set_options(const SceneOptions& options);
    const SceneOptions& options() const;

    /// Elements drawn with a selection outline; empty = none.
    void set_highlighted_elements(const std::vector<Index>& elements);

    /// Sets the camera: `fit` keeps the direction. 2D meshes are always looked at face on (parallel projection).
    void look(ViewDirection direction);
    /// Moves the camera so that the element fills a good part of the view.
    void focus_element(Index element);

    /// Whether any side of the element is drawn: not if it is inside a solid or the clip plane hides it.
    bool draws_element(Index element) const;

    /// Takes over the view of another scene that shows the same mesh or another state of it.
    void copy_view(const MeshScene& other);

    /// Element under a display position (device pixels, origin bottom left); none = background.
    std::optional<Index> pick_element(double x, double y) const;

    /// Installs the way the mouse moves the camera: 2D pan and zoom to the pointer; 3D trackball.
    void attach_interactor(vtkRenderWindowInteractor* interactor);

  private:
    struct Parts;
    std::unique_ptr<Parts> parts_;
};

}  // namespace curvewright
