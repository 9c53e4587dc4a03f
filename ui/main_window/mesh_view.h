#pragma once

#include <memory>
#include <optional>
#include <vector>

#include <QImage>
#include <QOpenGLWidget>

#include "ui/document/mesh_document.h"
#include "ui/scene/mesh_scene.h"

namespace curvewright {

/// The picture of the mesh: a MeshScene in a Qt widget (a vtkGenericOpenGLRenderWindow that draws into the widget's
/// framebuffer). Renders at most once per repaint of the window, and only if something has changed.
class MeshView : public QOpenGLWidget {
    Q_OBJECT

  public:
    explicit MeshView(QWidget* parent = nullptr);
    ~MeshView() override;

    /// Shows a state of the document; one without mesh shows nothing.
    void show_state(const MeshState& state);
    /// The options to draw with; the pixel ratio is the view's own.
    void set_options(const SceneOptions& options);
    const SceneOptions& options() const;

    void set_highlighted_elements(const std::vector<Index>& elements);
    void look(ViewDirection direction);
    /// Whether any side of the element is drawn: not if it is inside a solid or the clip plane hides it.
    bool draws_element(Index element) const;
    /// Moves the camera to an element within 200 ms.
    void fly_to(Index element);

    /// What the view shows, drawn anew at `scale` times its size in device pixels. Null if nothing can be drawn.
    QImage picture(int scale);

  signals:
    /// An element was clicked (none: the background).
    void element_clicked(std::optional<Index> element);

  protected:
    void initializeGL() override;
    void resizeGL(int width, int height) override;
    void paintGL() override;
    void mousePressEvent(QMouseEvent* event) override;
    void mouseMoveEvent(QMouseEvent* event) override;
    void mouseReleaseEvent(QMouseEvent* event) override;
    void wheelEvent(QWheelEvent* event) override;
    void leaveEvent(QEvent* event) override;

  private:
    struct Parts;

    void release_graphics();
    void request_frame();
    void send(unsigned long vtk_event, QPointF position, Qt::KeyboardModifiers modifiers, bool is_repeat = false);
    void scale_to_device();

    std::unique_ptr<Parts> parts_;
};

}  // namespace curvewright
