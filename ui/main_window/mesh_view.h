#pragma once

#include <memory>
#include <optional>
#include <vector>

#include <QImage>
#include <QOpenGLWidget>

#include "ui/document/mesh_document.h"
#include "ui/scene/mesh_scene.h"
#include "ui/scene/mouse_map.h"
#include "ui/tools/canvas.h"

namespace curvewright {

class SceneInteractorStyle;
class Tool;

/// The picture of the mesh: a MeshScene in a Qt widget (a vtkGenericOpenGLRenderWindow that draws into the widget's
/// framebuffer). Renders at most once per repaint of the window, and only if something has changed.
class MeshView : public QOpenGLWidget, public Canvas {
    Q_OBJECT

  public:
    /// object_name: also of the tests.
    explicit MeshView(QWidget* parent = nullptr, const QString& object_name = QStringLiteral("mesh_view"));
    ~MeshView() override;

    /// Shows a state of the document; one without mesh shows nothing.
    void show_state(const MeshState& state);
    /// A frame of a motion of the state shown: see MeshScene::show_frame.
    void show_frame(const Coordinates& positions, const QualityReport* quality);
    /// Who gets the left button, the wheel and the keys before the camera does; null = nobody. Not owned.
    void set_tool(Tool* tool);
    /// The options to draw with; the pixel ratio is the view's own.
    void set_options(const SceneOptions& options);
    const SceneOptions& options() const;

    /// Which button moves the camera how.
    void set_mouse_map(const MouseMap& map);
    /// Closer to the middle of the view (factor > 1).
    void zoom(double factor);

    void set_highlighted_elements(const std::vector<Index>& elements);
    void look(ViewDirection direction);
    /// Whether any side of the element is drawn: not if it is inside a solid or the clip plane hides it.
    bool draws_element(Index element) const;
    /// Takes over where another view's camera is.
    void follow_camera(const MeshView& other);
    /// Moves the camera to an element within 200 ms.
    void fly_to(Index element);
    /// Moves the camera so that a ball fills the view; radius 0: a little of the mesh around the point.
    void fit_to(const Eigen::RowVector3d& center, double radius);

    /// What the view shows, drawn anew at `scale` times its size in device pixels. Null if nothing can be drawn.
    QImage picture(int scale);

    bool is_flat() const override;
    QPointF to_display(const Eigen::RowVector3d& point) const override;
    Eigen::RowVector3d to_mesh(QPointF position, const Eigen::RowVector3d& at_depth_of) const override;
    double units_per_pixel(const Eigen::RowVector3d& at) const override;
    Eigen::Matrix3d view_axes() const override;
    std::optional<Index> node_at(QPointF position, double radius,
                                 const std::function<bool(Index node)>& accepts) const override;
    std::optional<Index> element_at(QPointF position) const override;
    std::vector<Index> nodes_inside(const std::vector<QPointF>& polygon, bool see_through) const override;
    std::vector<Index> elements_inside(const std::vector<QPointF>& polygon, bool see_through) const override;
    void show_marks(Marks marks, const std::vector<QPointF>& rubber) override;
    void show_cursor(const QCursor& cursor) override { setCursor(cursor); }

  signals:
    /// The mouse is there now, in the view's pixels.
    void pointer_moved(QPointF position);
    /// A frame was drawn from somewhere else than the one before, but not where follow_camera() put it.
    void camera_moved();
    /// A frame has been drawn anew and is about to be seen.
    void frame_drawn();
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
    void keyPressEvent(QKeyEvent* event) override;
    bool event(QEvent* event) override;

  private:
    struct Parts;

    void release_graphics();
    void request_frame();
    /// From where the camera is to where `set` puts it.
    void fly(const std::function<void()>& set);
    void send(unsigned long vtk_event, QPointF position, Qt::KeyboardModifiers modifiers, bool is_repeat = false);
    void scale_to_device();
    /// Device pixels, origin bottom left, as the scene counts.
    std::array<double, 2> to_device(QPointF position) const;
    QPointF from_device(double x, double y) const;
    void hover(QPointF position, Qt::KeyboardModifiers modifiers);
    /// What the arrow and page keys do to the camera; whether the key is one of them.
    bool navigate(const QKeyEvent& event);
    SceneInteractorStyle* camera_style() const;

    std::unique_ptr<Parts> parts_;
};

}  // namespace curvewright
