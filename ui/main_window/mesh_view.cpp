#include "ui/main_window/mesh_view_parts.h"

#include <array>
#include <cstdlib>
#include <utility>

#include <QKeyEvent>
#include <QMouseEvent>
#include <QOpenGLContext>
#include <QPointer>
#include <QTimer>
#include <QVariantAnimation>
#include <QWheelEvent>

#include <vtkCallbackCommand.h>
#include <vtkCamera.h>
#include <vtkCommand.h>
#include <vtkGenericOpenGLRenderWindow.h>
#include <vtkGenericRenderWindowInteractor.h>
#include <vtkNew.h>
#include <vtkRenderer.h>

#include "ui/main_window/picture_drawing.h"
#include "ui/scene/camera_control.h"
#include "ui/scene/interactor_style.h"
#include "ui/tools/tool.h"

namespace curvewright {

namespace {

CameraPose between(const CameraPose& a, const CameraPose& b, double t) {
    CameraPose pose;
    for (std::size_t i = 0; i < 3; ++i) {
        pose.position[i] = a.position[i] + t * (b.position[i] - a.position[i]);
        pose.focus[i] = a.focus[i] + t * (b.focus[i] - a.focus[i]);
        pose.up[i] = a.up[i] + t * (b.up[i] - a.up[i]);
    }
    pose.scale = a.scale + t * (b.scale - a.scale);
    return pose;
}

constexpr int click_distance = 4;  ///< pixels that a click may wander
constexpr double key_step = 48.0;  ///< pixels that an arrow key moves or turns by
constexpr double key_zoom = 1.2;   ///< factor of a page key

}  // namespace

MeshView::MeshView(QWidget* parent, const QString& object_name)
    : QOpenGLWidget(parent), parts_(std::make_unique<Parts>()) {
    setObjectName(object_name);
    setMouseTracking(true);
    setFocusPolicy(Qt::StrongFocus);
    setMinimumSize(240, 160);
    // Opaque whatever VTK leaves in the alpha channel: the window below must not shine through.
    setTextureFormat(GL_RGB8);
    Parts& parts = *parts_;

    // VTK asks for the context through events; unanswered ones make Render() do nothing.
    parts.events->SetClientData(this);
    parts.events->SetCallback([](vtkObject*, unsigned long event, void* client, void* call_data) {
        auto* view = static_cast<MeshView*>(client);
        Parts& own = *view->parts_;
        switch (event) {
            case vtkCommand::WindowMakeCurrentEvent:
                // QOpenGLWidget::makeCurrent() would bind the widget's framebuffer behind VTK's back.
                if (QOpenGLContext* context = view->context()) context->makeCurrent(context->surface());
                break;
            case vtkCommand::WindowIsCurrentEvent:
                *static_cast<bool*>(call_data) =
                    view->context() != nullptr && QOpenGLContext::currentContext() == view->context();
                break;
            case vtkCommand::WindowSupportsOpenGLEvent:
                *static_cast<int*>(call_data) = 1;
                break;
            case vtkCommand::WindowIsDirectEvent:
                *static_cast<int*>(call_data) = 1;
                break;
            case vtkCommand::RenderEvent:
                view->request_other_view();
                break;
            case vtkCommand::CreateTimerEvent: {
                const int id = own.interactor->GetTimerEventId();
                auto* timer = new QTimer(view);
                timer->setSingleShot(own.interactor->GetTimerEventType() == vtkRenderWindowInteractor::OneShotTimer);
                QObject::connect(timer, &QTimer::timeout, view, [&own, id] {
                    int timer_id = id;
                    own.interactor->InvokeEvent(vtkCommand::TimerEvent, &timer_id);
                });
                own.interactor->SetTimerEventPlatformId(id);
                own.timers.emplace_back(id, timer);
                timer->start(own.interactor->GetTimerEventDuration());
                break;
            }
            case vtkCommand::DestroyTimerEvent: {
                const int id = own.interactor->GetTimerEventPlatformId();
                std::erase_if(own.timers, [&](const auto& entry) {
                    if (entry.first != id) return false;
                    entry.second->stop();
                    entry.second->deleteLater();
                    return true;
                });
                break;
            }
            default:
                break;
        }
    });
    for (const auto event : {vtkCommand::WindowMakeCurrentEvent, vtkCommand::WindowIsCurrentEvent,
                             vtkCommand::WindowSupportsOpenGLEvent, vtkCommand::WindowIsDirectEvent})
        parts.window->AddObserver(event, parts.events);
    for (const auto event : {vtkCommand::RenderEvent, vtkCommand::CreateTimerEvent, vtkCommand::DestroyTimerEvent})
        parts.interactor->AddObserver(event, parts.events);

    parts.window->SetReadyForRendering(false);
    parts.window->SetOwnContext(0);
    parts.window->SetFrameBlitModeToNoBlit();
    parts.window->SetMultiSamples(0);
    parts.window->AddRenderer(parts.scene.renderer());
    parts.interactor->SetRenderWindow(parts.window);
    parts.interactor->EnableRenderOff();
    parts.interactor->Initialize();
    parts.scene.attach_interactor(parts.interactor);

    parts.behind.mode = first_drawing_mode;
    connect(&parts.behind.poll, &QTimer::timeout, this, &MeshView::poll_frame_behind);
    parts.preparing.explain.setSingleShot(true);
    connect(&parts.preparing.explain, &QTimer::timeout, this, [this] {
        parts_->preparing.is_told = true;
        emit preparing_changed(true);
    });
    parts.flight.setDuration(200);
    parts.flight.setStartValue(0.0);
    parts.flight.setEndValue(1.0);
    parts.flight.setEasingCurve(QEasingCurve::InOutCubic);
}

MeshView::~MeshView() {
    parts_->preparing.thread = {};
    parts_->preparing.left_over.clear();
    if (parts_->window->GetReadyForRendering()) makeCurrent();
    parts_->preparing.work.reset();
    hold_repaints(false);
    if (context()) context()->disconnect(this);
    release_graphics();
    parts_->window->RemoveObserver(parts_->events);
    parts_->interactor->RemoveObserver(parts_->events);
    parts_->interactor->SetRenderWindow(nullptr);
}

void MeshView::set_tool(Tool* tool) {
    Parts& parts = *parts_;
    if (parts.tool == tool) return;
    // Only what is in hand is given up: without that, Esc means more to some tools (the selection).
    const bool is_in_hand = std::exchange(parts.tool_has_mouse, false);
    if (parts.tool) {
        if (is_in_hand) parts.tool->cancel();
        parts.tool->leave();
    }
    parts.tool = tool;
    setCursor({});
    if (tool) tool->enter();
}

const SceneOptions& MeshView::options() const {
    return parts_->options;
}

void MeshView::look(ViewDirection direction) {
    parts_->flight.stop();
    parts_->scene.look(direction);
    request_other_view();
}

void MeshView::follow_camera(const MeshView& other) {
    parts_->flight.stop();
    parts_->scene.copy_view(other.parts_->scene, true);
    parts_->told_pose = CameraPose::of(parts_->scene.renderer()->GetActiveCamera());
    request_other_view();
}

bool MeshView::keeps_fitted() const {
    return parts_->scene.camera_state().keeps_fitted;
}

bool MeshView::draws_element(Index element) const {
    return parts_->scene.draws_element(element);
}

bool MeshView::is_flying() const {
    return parts_->flight.state() == QVariantAnimation::Running;
}

void MeshView::fly_to(Index element) {
    fly([this, element] { parts_->scene.focus_element(element); });
}

ViewPose MeshView::pose() const {
    const WorldFrame& frame = parts_->scene.world_frame();
    const CameraPose camera = CameraPose::of(parts_->scene.renderer()->GetActiveCamera());
    ViewPose pose{{}, {}, camera.up, camera.scale * frame.size};
    for (std::size_t i = 0; i < 3; ++i) {
        pose.position[i] = camera.position[i] * frame.size + frame.origin[static_cast<Eigen::Index>(i)];
        pose.focus[i] = camera.focus[i] * frame.size + frame.origin[static_cast<Eigen::Index>(i)];
    }
    return pose;
}

void MeshView::fly_to(const ViewPose& pose) {
    fly([&] {
        const WorldFrame& frame = parts_->scene.world_frame();
        vtkCamera* camera = parts_->scene.renderer()->GetActiveCamera();
        CameraPose target = CameraPose::of(camera);
        for (std::size_t i = 0; i < 3; ++i) {
            target.position[i] = (pose.position[i] - frame.origin[static_cast<Eigen::Index>(i)]) / frame.size;
            target.focus[i] = (pose.focus[i] - frame.origin[static_cast<Eigen::Index>(i)]) / frame.size;
        }
        target.up = pose.up;
        target.scale = pose.scale / frame.size;
        target.apply(camera);
    });
}

void MeshView::fit_to(const Eigen::RowVector3d& center, double radius) {
    fly([&] { parts_->scene.focus_ball(center, radius); });
}

void MeshView::fly(const std::function<void()>& set) {
    Parts& parts = *parts_;
    parts.flight.stop();
    vtkRenderer* renderer = parts.scene.renderer();
    const CameraPose start = CameraPose::of(renderer->GetActiveCamera());
    set();
    const CameraPose end = CameraPose::of(renderer->GetActiveCamera());
    // The animation does not tell its first value if it stood there before.
    start.apply(renderer->GetActiveCamera());
    parts.flight.disconnect(this);
    connect(&parts.flight, &QVariantAnimation::valueChanged, this, [this, renderer, start, end](const QVariant& value) {
        const double way = value.toDouble();
        (way < 1.0 ? between(start, end, way) : end).apply(renderer->GetActiveCamera());
        renderer->ResetCameraClippingRange();
        request_other_view();
    });
    connect(&parts.flight, &QVariantAnimation::finished, this, [this] {
        if (parts_->tool) parts_->tool->refresh();
    });
    parts.flight.start();
}

QImage MeshView::picture(int scale) {
    return picture(PictureOptions{.size = scale * device_size(), .is_smooth = false});
}

QImage MeshView::picture(const PictureOptions& options) {
    Parts& parts = *parts_;
    if (!parts.window->GetReadyForRendering()) return {};
    const int largest = largest_picture_side();
    if (!why_no_picture(options.size, largest).isEmpty()) return {};
    finish_preparing();
    makeCurrent();
    finish_frame_behind();
    QImage image = draw_picture(parts.scene, parts.window, parts.options, device_size(), options, largest);
    doneCurrent();
    request_frame();
    return image;
}

int MeshView::largest_picture_side() {
    return parts_->largest_picture_side;
}

QSize MeshView::device_size() const {
    const int* size = parts_->window->GetSize();
    return {size[0], size[1]};
}

const MeshScene& MeshView::scene() const {
    return parts_->scene;
}

void MeshView::send(unsigned long vtk_event, QPointF position, Qt::KeyboardModifiers modifiers, bool is_repeat) {
    const double ratio = devicePixelRatioF();
    const int height = parts_->window->GetSize()[1];
    parts_->interactor->SetEventInformation(
        static_cast<int>(position.x() * ratio), height - 1 - static_cast<int>(position.y() * ratio),
        modifiers.testFlag(Qt::ControlModifier), modifiers.testFlag(Qt::ShiftModifier), 0, is_repeat ? 1 : 0);
    parts_->interactor->SetAltKey(modifiers.testFlag(Qt::AltModifier));
    parts_->interactor->InvokeEvent(vtk_event);
}

void MeshView::mousePressEvent(QMouseEvent* event) {
    Parts& parts = *parts_;
    parts.flight.stop();
    if (parts.tool_has_mouse || parts.legend_has_mouse) return;
    const auto at = to_device(event->position());
    if (event->button() == Qt::LeftButton && parts.scene.is_on_legend(at[0], at[1])) {
        parts.legend_has_mouse = true;
        return;
    }
    parts.may_be_click = event->button() == Qt::LeftButton;
    parts.press_position = event->position();
    if (event->button() == Qt::LeftButton && parts.tool && parts.state.mesh &&
        parts.tool->press({event->position(), event->modifiers(), event->button()})) {
        parts.tool_has_mouse = true;
        parts.may_be_click = false;
        return;
    }
    const auto vtk_event = event->button() == Qt::LeftButton    ? vtkCommand::LeftButtonPressEvent
                           : event->button() == Qt::RightButton ? vtkCommand::RightButtonPressEvent
                                                                : vtkCommand::MiddleButtonPressEvent;
    send(vtk_event, event->position(), event->modifiers());
}

void MeshView::hover(QPointF position, Qt::KeyboardModifiers modifiers) {
    if (parts_->tool && parts_->state.mesh) parts_->tool->hover(PointerEvent{position, modifiers});
}

void MeshView::mouseMoveEvent(QMouseEvent* event) {
    Parts& parts = *parts_;
    emit pointer_moved(event->position());
    if (parts.legend_has_mouse) return;
    if (parts.tool_has_mouse) {
        parts.tool->move({event->position(), event->modifiers(), Qt::LeftButton});
        return;
    }
    if (event->buttons() == Qt::NoButton) hover(event->position(), event->modifiers());
    if ((event->position() - parts.press_position).manhattanLength() > click_distance) parts.may_be_click = false;
    send(vtkCommand::MouseMoveEvent, event->position(), event->modifiers());
}

void MeshView::mouseReleaseEvent(QMouseEvent* event) {
    Parts& parts = *parts_;
    if (parts.legend_has_mouse) {
        if (event->button() != Qt::LeftButton) return;
        parts.legend_has_mouse = false;
        const auto at = to_device(event->position());
        if (parts.scene.is_on_legend(at[0], at[1])) emit legend_clicked();
        return;
    }
    if (parts.tool_has_mouse) {
        if (event->button() != Qt::LeftButton) return;
        parts.tool_has_mouse = false;
        parts.tool->release({event->position(), event->modifiers(), event->button()});
        return;
    }
    const auto vtk_event = event->button() == Qt::LeftButton    ? vtkCommand::LeftButtonReleaseEvent
                           : event->button() == Qt::RightButton ? vtkCommand::RightButtonReleaseEvent
                                                                : vtkCommand::MiddleButtonReleaseEvent;
    send(vtk_event, event->position(), event->modifiers());
    // The camera may have moved: other things are under the mouse, handles have another size.
    if (parts.tool) {
        parts.tool->refresh();
        hover(event->position(), event->modifiers());
    }
    if (event->button() == Qt::LeftButton && parts.may_be_click && parts.state.mesh)
        emit element_clicked(element_at(event->position()));
}

void MeshView::keyPressEvent(QKeyEvent* event) {
    Parts& parts = *parts_;
    if (event->key() == Qt::Key_Escape && parts.preparing.is_told) return stop_preparing();
    if (parts.tool && event->key() == Qt::Key_Escape && parts.tool->cancel()) {
        parts.tool_has_mouse = false;
        return;
    }
    if (parts.tool && parts.tool->key(event->key(), event->modifiers())) return;
    if (!parts.tool_has_mouse && parts.state.mesh && navigate(*event)) return;
    QOpenGLWidget::keyPressEvent(event);
}

SceneInteractorStyle* MeshView::camera_style() const {
    return static_cast<SceneInteractorStyle*>(parts_->interactor->GetInteractorStyle());
}

void MeshView::set_mouse_map(const MouseMap& map) {
    camera_style()->set_mouse_map(map);
}

void MeshView::zoom(double factor) {
    parts_->flight.stop();
    camera_style()->zoom_by(factor);
    if (parts_->tool) parts_->tool->refresh();
}

void MeshView::widen(double factor) {
    parts_->flight.stop();
    vtkCamera* camera = parts_->scene.renderer()->GetActiveCamera();
    CameraPose pose = CameraPose::of(camera);
    pose.scale *= factor;
    for (std::size_t i = 0; i < 3; ++i) pose.position[i] = pose.focus[i] + factor * (pose.position[i] - pose.focus[i]);
    pose.apply(camera);
    request_other_view();
    if (parts_->tool) parts_->tool->refresh();
}

bool MeshView::navigate(const QKeyEvent& event) {
    const Qt::KeyboardModifiers held = event.modifiers() & ~Qt::KeypadModifier;
    if (held != Qt::NoModifier && held != Qt::ShiftModifier) return false;
    if (event.key() == Qt::Key_PageUp || event.key() == Qt::Key_PageDown) {
        if (held != Qt::NoModifier) return false;
        zoom(event.key() == Qt::Key_PageUp ? key_zoom : 1.0 / key_zoom);
        return true;
    }
    int right = 0, up = 0;
    switch (event.key()) {
        case Qt::Key_Left:
            right = -1;
            break;
        case Qt::Key_Right:
            right = 1;
            break;
        case Qt::Key_Up:
            up = 1;
            break;
        case Qt::Key_Down:
            up = -1;
            break;
        default:
            return false;
    }
    parts_->flight.stop();
    const double step = key_step * devicePixelRatioF();
    // Turning follows the key; moving goes there, so what is seen comes the other way.
    if (is_flat() || held == Qt::ShiftModifier)
        camera_style()->pan_by(-right * step, -up * step);
    else
        camera_style()->turn_by(right * step, up * step);
    if (parts_->tool) parts_->tool->refresh();
    return true;
}

bool MeshView::event(QEvent* event) {
    // While something is in hand the keys are the tool's, whatever else they are shortcuts of.
    if (event->type() == QEvent::ShortcutOverride && parts_->tool_has_mouse) {
        event->accept();
        return true;
    }
    return QOpenGLWidget::event(event);
}

void MeshView::wheelEvent(QWheelEvent* event) {
    parts_->flight.stop();
    const double steps = event->angleDelta().y() / 120.0;
    if (parts_->tool && parts_->state.mesh &&
        parts_->tool->wheel({event->position(), event->modifiers()},
                            steps != 0.0 ? steps : event->angleDelta().x() / 120.0)) {
        event->accept();
        return;
    }
    // Touch pads send many small turns: a notch is 120 of them.
    int& turned = parts_->wheel_turned;
    if ((event->angleDelta().y() > 0) != (turned > 0)) turned = 0;
    for (turned += event->angleDelta().y(); std::abs(turned) >= 120; turned += turned > 0 ? -120 : 120)
        send(turned > 0 ? vtkCommand::MouseWheelForwardEvent : vtkCommand::MouseWheelBackwardEvent, event->position(),
             event->modifiers());
    event->accept();
    if (parts_->tool) {
        parts_->tool->refresh();
        hover(event->position(), event->modifiers());
    }
}

void MeshView::leaveEvent(QEvent*) {
    if (parts_->tool && !parts_->tool_has_mouse) parts_->tool->hover(std::nullopt);
    parts_->interactor->InvokeEvent(vtkCommand::LeaveEvent);
}

}  // namespace curvewright
