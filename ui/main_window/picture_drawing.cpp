#include "ui/main_window/picture_drawing.h"

#include <algorithm>
#include <cmath>

#include <QCoreApplication>
#include <QOpenGLContext>
#include <QOpenGLFunctions>

#include <vtkCamera.h>
#include <vtkGenericOpenGLRenderWindow.h>
#include <vtkOpenGLState.h>
#include <vtkRenderer.h>
#include <vtkUnsignedCharArray.h>

#include "ui/document/number_format.h"
#include "ui/main_window/mesh_view.h"
#include "ui/main_window/offscreen_graphics.h"
#include "ui/scene/camera_control.h"
#include "ui/scene/picture_pixels.h"
#include "ui/scene/scene_preparation.h"

namespace curvewright {
namespace {

constexpr long long most_pixels = 100'000'000;        ///< of a picture
constexpr long long most_smooth_pixels = 40'000'000;  ///< that are drawn before they are averaged

long long area(QSize size) {
    return static_cast<long long>(size.width()) * size.height();
}

/// Where a camera has to be so that all of a view of one proportion is in a picture of another.
CameraState stepped_back(CameraState state, bool is_parallel, double shown_aspect, double aspect) {
    const double ratio = std::max(1.0, shown_aspect / aspect);
    if (is_parallel)
        state.scale *= ratio;
    else
        for (std::size_t i = 0; i < 3; ++i)
            state.position[i] = state.focus[i] + ratio * (state.position[i] - state.focus[i]);
    return state;
}

/// On a ground of this colour: 3 bytes per pixel, rows from the bottom; null if that fails.
vtkSmartPointer<vtkUnsignedCharArray> draw_on(const Color& ground, MeshScene& scene,
                                              vtkGenericOpenGLRenderWindow* window, QSize size) {
    scene.renderer()->SetBackground(ground[0], ground[1], ground[2]);
    vtkOpenGLState* state = window->GetState();
    state->Reset();
    state->Push();
    // Qt leaves GL_LESS, with which what VTK draws flat and in order (the legend) hides itself.
    state->vtkglDepthFunc(GL_LEQUAL);
    window->Render();
    state->Pop();
    auto pixels = vtkSmartPointer<vtkUnsignedCharArray>::New();
    const bool is_read = window->GetPixelData(0, 0, size.width() - 1, size.height() - 1, 0, pixels.Get(), 0) != 0;
    return is_read && pixels->GetNumberOfValues() == 3 * area(size) ? pixels : nullptr;
}

QImage to_image(const PicturePixels& pixels) {
    const auto format = pixels.channels == 4 ? QImage::Format_RGBA8888 : QImage::Format_RGB888;
    return QImage(pixels.bytes.data(), pixels.width, pixels.height, pixels.channels * pixels.width, format).mirrored();
}

}  // namespace

QString why_no_picture(QSize size, int largest_side) {
    if (size.width() >= 1 && size.height() >= 1 && std::max(size.width(), size.height()) <= largest_side &&
        area(size) <= most_pixels)
        return {};
    return QCoreApplication::translate(
               "Pictures",
               "A picture of %1 × %2 pixels cannot be drawn here: at most %3 pixels a side, and "
               "%4 million in all.")
        .arg(format_count(size.width()), format_count(size.height()), format_count(largest_side),
             format_count(most_pixels / 1'000'000));
}

int largest_picture_side() {
    QOpenGLFunctions* gl = QOpenGLContext::currentContext()->functions();
    GLint texture = 0, buffer = 0, viewport[2] = {0, 0};
    gl->glGetIntegerv(GL_MAX_TEXTURE_SIZE, &texture);
    gl->glGetIntegerv(GL_MAX_RENDERBUFFER_SIZE, &buffer);
    gl->glGetIntegerv(GL_MAX_VIEWPORT_DIMS, viewport);
    return std::min({texture, buffer, viewport[0], viewport[1], 16384});
}

int smoothing_factor(const PictureOptions& options, int largest_side) {
    const QSize twice = 2 * options.size;
    const bool is_doubled = options.is_smooth && std::max(twice.width(), twice.height()) <= largest_side &&
                            area(twice) <= most_smooth_pixels;
    return is_doubled ? 2 : 1;
}

void set_up_picture(MeshScene& scene, const SceneOptions& shown, QSize shown_size, const PictureOptions& options,
                    int factor) {
    const CameraState state = scene.camera_state();
    const double aspect = double(options.size.width()) / options.size.height();
    const double shown_aspect = double(shown_size.width()) / shown_size.height();
    // A picture of the view's own proportions is what the view shows.
    const bool fits_anew = state.keeps_fitted &&
                           (std::abs(aspect / shown_aspect - 1.0) > 0.01 || (shown.show_legend && !options.has_legend));
    if (!fits_anew) {
        CameraState moved = stepped_back(state, scene.renderer()->GetActiveCamera()->GetParallelProjection() != 0,
                                         shown_aspect, aspect);
        moved.keeps_fitted = false;
        scene.set_camera_state(moved);
    }
    const double growth = std::min(double(options.size.width()) / shown_size.width(),
                                   double(options.size.height()) / shown_size.height());
    SceneOptions drawn = shown;
    drawn.pixel_ratio *= growth * options.line_scale * factor;
    drawn.show_legend = shown.show_legend && options.has_legend;
    scene.set_options(drawn);
}

QImage draw_picture(MeshScene& scene, vtkGenericOpenGLRenderWindow* window, const SceneOptions& shown, QSize shown_size,
                    const PictureOptions& options, int largest_side) {
    const int factor = smoothing_factor(options, largest_side);
    const QSize size = factor * options.size;
    const QSize window_size(window->GetSize()[0], window->GetSize()[1]);
    const CameraState state = scene.camera_state();
    set_up_picture(scene, shown, shown_size, options, factor);
    window->SetSize(size.width(), size.height());
    QImage image;
    if (options.is_transparent) {
        const auto on_black = draw_on({0.0, 0.0, 0.0}, scene, window, size);
        const auto on_white = draw_on({1.0, 1.0, 1.0}, scene, window, size);
        if (on_black && on_white)
            image = to_image(
                without_ground(on_black->GetPointer(0), on_white->GetPointer(0), size.width(), size.height(), factor));
    } else if (const auto pixels = draw_on(shown.background, scene, window, size)) {
        image = to_image(average(pixels->GetPointer(0), size.width(), size.height(), factor));
    }
    scene.set_options(shown);
    window->SetSize(window_size.width(), window_size.height());
    scene.set_camera_state(state);
    return image;
}

struct PictureStudio::Parts {
    OffscreenGraphics graphics;
    MeshScene scene;
    SceneOptions options;
    QSize shown_size;
};

PictureStudio::PictureStudio(const MeshView& view) : parts_(std::make_unique<Parts>()) {
    Parts& parts = *parts_;
    if (!parts.graphics.make_current()) return;
    parts.graphics.window()->AddRenderer(parts.scene.renderer());
    parts.shown_size = view.device_size();
    parts.graphics.window()->SetSize(parts.shown_size.width(), parts.shown_size.height());
    parts.options = view.options();
    parts.scene.set_options(parts.options);
    const SceneContent content = view.content();
    parts.scene.set_mesh(content.mesh.get(), content.quality.get());
    // Numbers of the present state are of no other state.
    if (!content.coloring.is_of_one_state) parts.scene.set_coloring(content.coloring);
    parts.scene.copy_view(view.scene(), true);
    parts.graphics.done_current();
}

PictureStudio::~PictureStudio() = default;

QImage PictureStudio::draw(const CurvedMesh& mesh, const QualityReport* quality, const PictureOptions& options,
                           const std::vector<Index>& highlighted) {
    Parts& parts = *parts_;
    if (!parts.graphics.make_current()) return {};
    parts.scene.set_mesh(&mesh, quality);
    parts.scene.set_highlighted_elements(highlighted);
    const QImage image = draw_picture(parts.scene, parts.graphics.window(), parts.options, parts.shown_size, options,
                                      parts.graphics.largest_side());
    parts.graphics.done_current();
    return image;
}

}  // namespace curvewright
