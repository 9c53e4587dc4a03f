// How the view's frames come about: at once in a repaint of the window, or behind it while the event loop goes on.

#include <QCoreApplication>
#include <QEvent>
#include <QOpenGLContext>
#include <QOpenGLVersionFunctionsFactory>

#include <vtkOpenGLState.h>
#include <vtkRenderer.h>

#include "ui/jobs/own_turn.h"
#include "ui/main_window/mesh_view_parts.h"
#include "ui/main_window/picture_drawing.h"

namespace curvewright {

void MeshView::initializeGL() {
    Parts& parts = *parts_;
    parts.gl = QOpenGLVersionFunctionsFactory::get<QOpenGLFunctions_3_2_Core>(context());
    if (!parts.gl) qFatal("The OpenGL context of the view lacks OpenGL 3.2.");
    connect(context(), &QOpenGLContext::aboutToBeDestroyed, this, &MeshView::release_graphics, Qt::UniqueConnection);
    parts.window->SetForceMaximumHardwareLineWidth(1);
    parts.window->SetReadyForRendering(true);
    parts.window->SetMapped(1);
    parts.window->OpenGLInitContext();
    parts.largest_picture_side = curvewright::largest_picture_side();
    parts.is_stale = true;
}

void MeshView::release_graphics() {
    Parts& parts = *parts_;
    if (!parts.window->GetReadyForRendering()) return;
    makeCurrent();
    if (parts.behind.fence) parts.gl->glDeleteSync(parts.behind.fence);
    parts.behind.fence = nullptr;
    parts.behind.poll.stop();
    parts.behind.is_pending = parts.behind.is_finished = false;
    parts.scene.end_parts();
    parts.behind.drawn_size = {};
    hold_repaints(false);
    parts.window->Finalize();
    parts.window->SetReadyForRendering(false);
    doneCurrent();
}

void MeshView::resizeEvent(QResizeEvent* event) {
    // Qt would have it painted here as well, once for every size that a layout tries.
    parts_->is_being_resized = true;
    QOpenGLWidget::resizeEvent(event);
    parts_->is_being_resized = false;
    update();
}

void MeshView::resizeGL(int, int) {
    abandon_frame_behind();
    // The framebuffer's own size: rounding of fractional ratios is Qt's.
    const QSize size = (QSizeF(this->size()) * devicePixelRatioF()).toSize();
    parts_->window->SetSize(size.width(), size.height());
    parts_->interactor->SetSize(size.width(), size.height());
    if (parts_->options.pixel_ratio != devicePixelRatioF()) scale_to_device();
    parts_->is_stale = true;
}

void MeshView::paintGL() {
    Parts& parts = *parts_;
    if (parts.is_being_resized) return;
    FrameBehind& behind = parts.behind;
    // Whatever else has the window repainted now cannot be drawn before the frame.
    if (behind.is_pending || behind.is_finished) {
        finish_frame_behind();
    } else if (parts.is_stale && !behind.is_on()) {
        behind.clock.start();
        parts.is_stale = false;
        parts.window->draw(true);
        tell_drawn();
    }
    vtkOpenGLState* state = parts.window->GetState();
    state->Reset();
    state->Push();
    parts.gl->glBindFramebuffer(GL_DRAW_FRAMEBUFFER, defaultFramebufferObject());
    parts.gl->glDrawBuffer(GL_COLOR_ATTACHMENT0);
    state->vtkglDisable(GL_SCISSOR_TEST);
    state->vtkglDisable(GL_BLEND);
    // Until there is a picture of the view's size, what there is of the last one, in the middle.
    const QSize drawn = behind.drawn_size, gap = device_size() - drawn;
    if (!gap.isNull()) {
        const Color& ground = parts.options.background;
        state->vtkglClearColor(float(ground[0]), float(ground[1]), float(ground[2]), 1.0f);
        parts.gl->glClear(GL_COLOR_BUFFER_BIT);
    }
    // What is seen of it: pixels that would fall beside the view make a drawing of what could be a copy.
    const QSize seen = drawn.boundedTo(device_size());
    const QSize cut = (drawn - seen) / 2, margin = (device_size() - seen) / 2;
    if (!seen.isEmpty())
        parts.window->BlitDisplayFramebuffer(0, cut.width(), cut.height(), seen.width(), seen.height(), margin.width(),
                                             margin.height(), seen.width(), seen.height(), GL_COLOR_BUFFER_BIT,
                                             GL_NEAREST);
    state->Pop();
    parts.gl->glBindFramebuffer(GL_FRAMEBUFFER, defaultFramebufferObject());
    if (parts.is_stale) request_other_view();
}

void MeshView::tell_drawn() {
    Parts& parts = *parts_;
    // Both ends of the range apart, so that the mode does not change with every frame.
    constexpr qint64 slow = 45, quick = 20;  // milliseconds
    const qint64 took = parts.behind.clock.elapsed();
    parts.behind.is_slow = took > slow || (parts.behind.is_slow && took > quick);
    parts.behind.drawn_size = device_size();
    if (!parts.is_stale) parts.behind.is_restless = false;
    emit frame_drawn();
    const CameraPose pose = CameraPose::of(parts.scene.renderer()->GetActiveCamera());
    if (!(pose == parts.told_pose)) {
        parts.told_pose = pose;
        emit camera_moved();
    }
}

void MeshView::request_frame() {
    parts_->behind.is_mixed = true;
    request_other_view();
}

void MeshView::request_other_view() {
    parts_->is_stale = true;
    const FrameBehind& behind = parts_->behind;
    if (!behind.is_on() || !isVisible() || !parts_->window->GetReadyForRendering())
        update();
    else if (!behind.is_pending && !behind.is_finished)
        schedule_frame_behind();
}

void MeshView::set_drawing_mode(DrawingMode mode) {
    parts_->behind.mode = mode;
    request_frame();
}

bool MeshView::has_frame_under_way() const {
    return is_preparing() || parts_->is_stale || parts_->behind.is_pending || parts_->behind.is_finished;
}

void MeshView::schedule_frame_behind() {
    FrameBehind& behind = parts_->behind;
    if (behind.is_scheduled) return;
    behind.is_scheduled = true;
    // A repaint now would have to be done again when the frame is there.
    hold_repaints(true);
    call_in_own_turn(this, [this] { begin_frame_behind(); });
}

void MeshView::begin_frame_behind() {
    Parts& parts = *parts_;
    FrameBehind& behind = parts.behind;
    behind.is_scheduled = false;
    if (behind.is_pending || behind.is_finished) return;
    if (!parts.is_stale) return hold_repaints(false);
    if (!behind.is_on() || !isVisible() || !parts.window->GetReadyForRendering()) {
        hold_repaints(false);
        update();
        return;
    }
    begin_frame();
}

void MeshView::begin_frame() {
    FrameBehind& behind = parts_->behind;
    behind.clock.start();
    behind.is_mixed = parts_->is_stale = false;
    if (is_large() && !behind.is_restless) parts_->scene.begin_parts();
    draw_behind();
    emit frame_begun();
}

/// All of a frame, or the next part of it.
void MeshView::draw_behind() {
    Parts& parts = *parts_;
    FrameBehind& behind = parts.behind;
    makeCurrent();
    if (behind.fence) parts.gl->glDeleteSync(behind.fence);
    parts.window->draw(false);
    behind.fence = parts.gl->glFenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0);
    parts.gl->glFlush();
    doneCurrent();
    behind.is_pending = true;
    constexpr int interval = 3;  // milliseconds
    behind.poll.start(interval);
}

void MeshView::poll_frame_behind() {
    Parts& parts = *parts_;
    FrameBehind& behind = parts.behind;
    if (behind.is_pending && behind.fence) {
        makeCurrent();
        const GLenum state = parts.gl->glClientWaitSync(behind.fence, 0, 0);
        doneCurrent();
        if (state == GL_TIMEOUT_EXPIRED) return;
    }
    behind.poll.stop();
    if (behind.is_pending && parts.scene.has_more_parts()) {
        call_in_own_turn(this, [this] { continue_frame_behind(); });
        return;
    }
    behind.is_finished = behind.is_pending;
    behind.is_pending = false;
    hold_repaints(false);
    update();
}

void MeshView::continue_frame_behind() {
    Parts& parts = *parts_;
    if (!parts.behind.is_pending || !parts.scene.has_more_parts()) return;
    if (parts.behind.is_mixed) {
        // What has changed meanwhile would be in some of its parts only.
        parts.scene.end_parts();
        return begin_frame();
    }
    draw_behind();
}

void MeshView::finish_frame_behind() {
    Parts& parts = *parts_;
    FrameBehind& behind = parts.behind;
    hold_repaints(false);
    if (!behind.is_pending && !behind.is_finished) return;
    behind.poll.stop();
    behind.is_pending = behind.is_finished = false;
    if (behind.fence) parts.gl->glDeleteSync(behind.fence);
    behind.fence = nullptr;
    if (parts.scene.has_more_parts()) {
        parts.scene.end_parts();
        parts.is_stale = false;
        parts.window->draw(true);
        return tell_drawn();
    }
    vtkOpenGLState* state = parts.window->GetState();
    state->Reset();
    state->Push();
    parts.window->Frame();
    state->Pop();
    tell_drawn();
}

void MeshView::abandon_frame_behind() {
    FrameBehind& behind = parts_->behind;
    parts_->scene.end_parts();
    hold_repaints(false);
    behind.poll.stop();
    behind.is_pending = behind.is_finished = false;
    if (behind.fence) parts_->gl->glDeleteSync(behind.fence);
    behind.fence = nullptr;
}

void MeshView::hold_repaints(bool is_held) {
    FrameBehind& behind = parts_->behind;
    if (is_held) {
        if (behind.held_window) return;
        behind.held_window = window();
        behind.held_window->installEventFilter(this);
        return;
    }
    if (!behind.held_window) return;
    behind.held_window->removeEventFilter(this);
    if (behind.has_held) QCoreApplication::postEvent(behind.held_window, new QEvent(QEvent::UpdateRequest));
    behind.has_held = false;
    behind.held_window = nullptr;
}

bool MeshView::eventFilter(QObject* watched, QEvent* event) {
    FrameBehind& behind = parts_->behind;
    if (watched == behind.held_window && event->type() == QEvent::UpdateRequest) {
        behind.has_held = true;
        return true;
    }
    return QOpenGLWidget::eventFilter(watched, event);
}

}  // namespace curvewright
