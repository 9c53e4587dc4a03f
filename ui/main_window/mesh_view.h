#pragma once

#include <memory>
#include <optional>
#include <vector>

#include <QImage>
#include <QOpenGLWidget>

#include "ui/document/mesh_document.h"
#include "ui/document/view_bookmarks.h"
#include "ui/scene/mesh_scene.h"
#include "ui/scene/mouse_map.h"
#include "ui/tools/canvas.h"

namespace curvewright {

class SceneInteractorStyle;
class Tool;
struct PictureOptions;
struct PreparationWork;
struct SceneContent;

/// When a view waits for its picture.
enum class DrawingMode {
    at_once,    ///< a repaint of the window draws and waits for the picture
    behind,     ///< the graphics draw while the event loop goes on; the window is repainted when the picture is there
    automatic,  ///< behind when pictures take long, as large meshes do without a graphics card
};

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
    /// What the colours show.
    void set_coloring(const Coloring& coloring);
    /// The map with the range that is shown now.
    const ColorScale& shown_scale() const;

    /// Meshes of so many nodes are drawn when what is to be drawn has been prepared on another thread. What is shown
    /// until then is the state before, or nothing if that was of another mesh; the last of several changes wins.
    static inline Index least_nodes_prepared = 30000;
    /// Whether what it shows is so large.
    bool is_large() const;
    bool is_preparing() const;
    /// Stays with what is shown until something changes again. not_drawn() tells it.
    void stop_preparing();
    /// Waits until what was asked for is shown, for those who cannot go on without.
    void finish_preparing();
    /// All that the view shows, or is going to.
    SceneContent content() const;

    void set_drawing_mode(DrawingMode mode);
    /// Whether something is asked for that is not seen yet.
    bool has_frame_under_way() const;
    /// Of views made from now on; tests want their pictures at once.
    static inline DrawingMode first_drawing_mode = DrawingMode::automatic;

    /// Which button moves the camera how.
    void set_mouse_map(const MouseMap& map);
    /// Closer to the middle of the view (factor > 1).
    void zoom(double factor);

    /// What is in the middle of the free part of the view stays there, `factor` times as much is seen beside it.
    void widen(double factor);

    void set_highlighted_elements(const std::vector<Index>& elements);
    void look(ViewDirection direction);
    /// Whether any side of the element is drawn: not if it is inside a solid or the clip plane hides it.
    bool draws_element(Index element) const;
    /// Whether nobody has moved the camera since the mesh was fitted: it will be fitted to other sizes too.
    bool keeps_fitted() const;
    /// Takes over where another view's camera is.
    void follow_camera(const MeshView& other);
    /// Moves the camera to an element within 200 ms.
    void fly_to(Index element);
    /// Where the camera is, and moving it to where one was within 200 ms. They belong to a mesh that is shown.
    ViewPose pose() const;
    void fly_to(const ViewPose& pose);
    bool is_flying() const;
    /// Moves the camera so that a ball fills the view; radius 0: a little of the mesh around the point.
    void fit_to(const Eigen::RowVector3d& center, double radius);

    /// What the view shows, drawn anew at `scale` times its size in device pixels. Null if nothing can be drawn.
    QImage picture(int scale);
    /// The same at any size. Null if nothing can be drawn; why_no_picture() of the largest side may tell why.
    QImage picture(const PictureOptions& options);
    /// What the graphics can draw, pixels.
    int largest_picture_side();
    QSize device_size() const;
    const MeshScene& scene() const;

    bool is_flat() const override;
    QRectF free_area() const override;
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
    /// What was asked for is what is shown: after a preparation only.
    void content_shown();
    /// Preparing takes longer than one would expect (true), or has ended.
    void preparing_changed(bool takes_long);
    /// What was asked for is not going to be shown: it was stopped, or there is not enough memory.
    void not_drawn();
    /// A frame is being drawn behind, or is begun again: until frame_drawn(), another one would only be waited for.
    void frame_begun();
    /// A frame has been drawn anew and is about to be seen.
    void frame_drawn();
    /// An element was clicked (none: the background).
    void element_clicked(std::optional<Index> element);
    void legend_clicked();

  protected:
    void initializeGL() override;
    void resizeEvent(QResizeEvent* event) override;
    void resizeGL(int width, int height) override;
    void paintGL() override;
    void mousePressEvent(QMouseEvent* event) override;
    void mouseMoveEvent(QMouseEvent* event) override;
    void mouseReleaseEvent(QMouseEvent* event) override;
    void wheelEvent(QWheelEvent* event) override;
    void leaveEvent(QEvent* event) override;
    void keyPressEvent(QKeyEvent* event) override;
    bool event(QEvent* event) override;
    bool eventFilter(QObject* watched, QEvent* event) override;

  private:
    struct Parts;

    void show_nothing();
    void prepare();
    void begin_preparation();
    void take_preparation(const std::shared_ptr<PreparationWork>& work);
    void upload_preparation();
    void show_preparation();
    void tell_prepared();
    void forget_preparation();
    void release_graphics();
    /// What is drawn has changed, or only from where, and the tool's marks.
    void request_frame();
    void request_other_view();
    /// Renders; with waits = false up to where the picture would be waited for.
    void schedule_frame_behind();
    void begin_frame_behind();
    void begin_frame();
    void draw_behind();
    void poll_frame_behind();
    void continue_frame_behind();
    /// The picture that was drawn behind becomes the one that is shown; waits for it if it is not there.
    void finish_frame_behind();
    void abandon_frame_behind();
    void hold_repaints(bool is_held);
    void tell_drawn();
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
