#pragma once

#include <memory>
#include <vector>

#include <QImage>
#include <QSize>
#include <QString>

#include "ui/scene/mesh_scene.h"

class vtkGenericOpenGLRenderWindow;

namespace curvewright {

class MeshView;

/// How a picture is drawn.
struct PictureOptions {
    QSize size;  ///< pixels
    /// Lines, points and text, relative to the view's, which grow with the picture.
    double line_scale = 1.0;
    bool is_transparent = false;
    bool has_legend = true;
    /// Drawn twice as large and averaged, where the graphics can do that.
    bool is_smooth = true;
};

/// Why a picture of this size cannot be drawn, one sentence; empty if it can.
QString why_no_picture(QSize size, int largest_side);
/// What the graphics can draw, pixels. pre: an OpenGL context is current.
int largest_picture_side();

/// How much larger it is drawn than it is: 1 or 2.
int smoothing_factor(const PictureOptions& options, int largest_side);
/// Gives a scene camera and options for a picture; what is drawn is factor times as large. shown, shown_size: as for
/// draw_picture.
void set_up_picture(MeshScene& scene, const SceneOptions& shown, QSize shown_size, const PictureOptions& options,
                    int factor);
/// Draws what a window of VTK shows once more, at another size, and leaves the window as it was. A view that is fitted
/// to the window is fitted to the picture; any other one is in the picture as a whole. shown: what the view shows it
/// with, and its size in device pixels. Null if the graphics fail. pre: the window's context is current,
/// why_no_picture(size, largest_side) is empty.
QImage draw_picture(MeshScene& scene, vtkGenericOpenGLRenderWindow* window, const SceneOptions& shown, QSize shown_size,
                    const PictureOptions& options, int largest_side);

/// Draws meshes the way a view shows its own, in a context of its own: the view goes on undisturbed. For the window's
/// thread.
class PictureStudio {
  public:
    /// Takes over what the view shows, from where and how.
    explicit PictureStudio(const MeshView& view);
    ~PictureStudio();

    /// Null if the graphics fail. quality: may be null, as in MeshScene::set_mesh. highlighted: elements with an outline.
    /// pre: as for draw_picture.
    QImage draw(const CurvedMesh& mesh, const QualityReport* quality, const PictureOptions& options,
                const std::vector<Index>& highlighted = {});

  private:
    struct Parts;
    std::unique_ptr<Parts> parts_;
};

}  // namespace curvewright
