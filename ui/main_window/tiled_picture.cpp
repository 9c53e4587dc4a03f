#include "ui/main_window/tiled_picture.h"

#include <algorithm>
#include <cmath>
#include <exception>
#include <optional>
#include <vector>

#include <QOpenGLExtraFunctions>
#include <QThreadPool>
#include <QTimer>

#include <vtkOpenGLState.h>
#include <vtkRenderer.h>
#include <vtkUnsignedCharArray.h>

#include "ui/jobs/own_turn.h"
#include "ui/main_window/mesh_view.h"
#include "ui/main_window/offscreen_graphics.h"
#include "ui/scene/camera_control.h"
#include "ui/scene/picture_pixels.h"
#include "ui/scene/scene_preparation.h"

namespace curvewright {
namespace {

/// Parts that a side is cut into: at least so many, of equal length if there is such a number near it.
int parts_of(int side, int least) {
    for (int count = least; count <= 2 * least; ++count)
        if (side % count == 0) return count;
    return least;
}

}  // namespace

struct TiledPicture::Parts {
    PictureOptions options;
    SceneOptions shown;
    QSize shown_size;
    CameraState camera;
    OffscreenGraphics graphics;
    MeshScene scene;
    std::optional<ScenePreparation> preparation;
    std::exception_ptr problem;
    // Whoever gives up the picture while it is being prepared leaves the rest to that.
    QObject relay;
    TiledPicture* owner = nullptr;
    bool is_preparing = false;

    int factor = 1;
    QSize tile, tiles;  ///< pixels of the picture; how many
    int next = 0;       ///< row by row
    bool is_on_white = false;
    std::vector<unsigned char> on_black;
    GLsync fence = nullptr;
    QTimer poll;
    QImage image;

    ~Parts() {
        if (!graphics.make_current()) return;
        if (fence) graphics.context().extraFunctions()->glDeleteSync(fence);
        preparation.reset();
        graphics.done_current();
    }
    int count() const { return tiles.width() * tiles.height(); }
    QPoint place() const { return {next % tiles.width(), next / tiles.width()}; }
};

TiledPicture::TiledPicture(const MeshView& view, const PictureOptions& options, QObject* parent)
    : QObject(parent), parts_(std::make_unique<Parts>()) {
    Parts& parts = *parts_;
    parts.options = options;
    parts.shown = view.options();
    parts.shown_size = view.device_size();
    parts.camera = view.scene().camera_state();
    SceneContent content = view.content();
    content.frame = view.scene().world_frame();
    connect(&parts.poll, &QTimer::timeout, this, &TiledPicture::poll_tile);
    if (!parts.graphics.is_ready() || !content.mesh) {
        QMetaObject::invokeMethod(
            this, [this] { end({}); }, Qt::QueuedConnection);
        return;
    }
    parts.graphics.make_current();
    parts.graphics.window()->AddRenderer(parts.scene.renderer());
    parts.graphics.done_current();
    parts.preparation.emplace(parts.scene.prepare(std::move(content)));
    parts.owner = this;
    parts.is_preparing = true;
    QThreadPool::globalInstance()->start([&parts] {
        try {
            parts.preparation->run();
        } catch (...) {
            parts.problem = std::current_exception();
        }
        const auto told = [&parts] {
            parts.is_preparing = false;
            if (parts.owner)
                parts.owner->take_drawing();
            else
                QTimer::singleShot(0, [&parts] { delete &parts; });
        };
        QMetaObject::invokeMethod(&parts.relay, told, Qt::QueuedConnection);
    });
}

TiledPicture::~TiledPicture() {
    if (!parts_->is_preparing) return;
    parts_->owner = nullptr;
    parts_.release();
}

void TiledPicture::take_drawing() {
    if (parts_->problem)
        end({});
    else
        upload();
}

void TiledPicture::upload() {
    Parts& parts = *parts_;
    parts.graphics.make_current();
    const bool is_more_to_come = parts.scene.upload_next(*parts.preparation);
    parts.graphics.done_current();
    call_in_own_turn(this, [this, is_more_to_come] { is_more_to_come ? upload() : begin(); });
}

void TiledPicture::begin() {
    Parts& parts = *parts_;
    parts.graphics.make_current();
    parts.scene.show(std::move(*parts.preparation));
    parts.preparation.reset();
    const QSize size = parts.options.size;
    parts.factor = smoothing_factor(parts.options, parts.graphics.largest_side());
    const double side = std::sqrt(double(tile_pixels)) / parts.factor;
    parts.tiles = {parts_of(size.width(), int(std::ceil(size.width() / side))),
                   parts_of(size.height(), int(std::ceil(size.height() / side)))};
    parts.tile = {(size.width() + parts.tiles.width() - 1) / parts.tiles.width(),
                  (size.height() + parts.tiles.height() - 1) / parts.tiles.height()};
    DeferringRenderWindow* window = parts.graphics.window();
    window->SetTileScale(parts.tiles.width(), parts.tiles.height());
    window->SetSize(parts.factor * parts.tile.width(), parts.factor * parts.tile.height());
    parts.scene.set_camera_state(parts.camera);
    set_up_picture(parts.scene, parts.shown, parts.shown_size, parts.options, parts.factor);
    parts.image = QImage(size, parts.options.is_transparent ? QImage::Format_RGBA8888 : QImage::Format_RGB888);
    parts.graphics.done_current();
    if (parts.image.isNull())
        end({});
    else
        call_in_own_turn(this, [this] { draw_tile(); });
}

void TiledPicture::draw_tile() {
    Parts& parts = *parts_;
    emit progress(double(2 * parts.next + (parts.is_on_white ? 1 : 0)) / (2 * parts.count()));
    parts.graphics.make_current();
    const QPoint place = parts.place();
    parts.scene.set_first_pixel(parts.factor * place.x() * parts.tile.width(),
                                parts.factor * place.y() * parts.tile.height());
    const Color black{0.0, 0.0, 0.0}, white{1.0, 1.0, 1.0};
    const Color ground = !parts.options.is_transparent ? parts.shown.background : parts.is_on_white ? white : black;
    parts.scene.renderer()->SetBackground(ground[0], ground[1], ground[2]);
    parts.graphics.done_current();
    parts.scene.begin_parts();
    draw_part();
}

void TiledPicture::draw_part() {
    Parts& parts = *parts_;
    parts.graphics.make_current();
    parts.graphics.window()->draw(false);
    QOpenGLExtraFunctions* gl = parts.graphics.context().extraFunctions();
    parts.fence = gl->glFenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0);
    gl->glFlush();
    parts.graphics.done_current();
    parts.poll.start(2);
}

void TiledPicture::poll_tile() {
    Parts& parts = *parts_;
    parts.graphics.make_current();
    QOpenGLExtraFunctions* gl = parts.graphics.context().extraFunctions();
    const GLenum answer = gl->glClientWaitSync(parts.fence, 0, 0);
    if (answer != GL_TIMEOUT_EXPIRED) {
        gl->glDeleteSync(parts.fence);
        parts.fence = nullptr;
    }
    parts.graphics.done_current();
    if (answer == GL_TIMEOUT_EXPIRED) return;
    parts.poll.stop();
    if (parts.scene.has_more_parts())
        call_in_own_turn(this, [this] { draw_part(); });
    else
        take_tile();
}

void TiledPicture::take_tile() {
    Parts& parts = *parts_;
    const QSize drawn = parts.factor * parts.tile;
    parts.graphics.make_current();
    DeferringRenderWindow* window = parts.graphics.window();
    vtkOpenGLState* state = window->GetState();
    state->Reset();
    state->Push();
    window->Frame();
    state->Pop();
    vtkNew<vtkUnsignedCharArray> bytes;
    const bool is_read = window->GetPixelData(0, 0, drawn.width() - 1, drawn.height() - 1, 0, bytes.Get(), 0) != 0;
    parts.graphics.done_current();
    if (!is_read || bytes->GetNumberOfValues() != 3LL * drawn.width() * drawn.height()) return end({});
    const unsigned char* pixels = bytes->GetPointer(0);
    if (parts.options.is_transparent && !parts.is_on_white) {
        parts.on_black.assign(pixels, pixels + bytes->GetNumberOfValues());
        parts.is_on_white = true;
        call_in_own_turn(this, [this] { draw_tile(); });
        return;
    }
    parts.is_on_white = false;
    const PicturePixels tile =
        parts.options.is_transparent
            ? without_ground(parts.on_black.data(), pixels, drawn.width(), drawn.height(), parts.factor)
            : average(pixels, drawn.width(), drawn.height(), parts.factor);
    // Rows of the tile go up, those of the picture down; tiles at the right and the top may reach beyond it.
    const QPoint place = parts.place();
    const int left = place.x() * parts.tile.width(), bottom = place.y() * parts.tile.height();
    const int columns = std::min(parts.tile.width(), parts.image.width() - left);
    for (int row = 0; row < tile.height && bottom + row < parts.image.height() && columns > 0; ++row)
        std::copy_n(tile.bytes.data() + std::ptrdiff_t(row) * tile.width * tile.channels, columns * tile.channels,
                    parts.image.scanLine(parts.image.height() - 1 - bottom - row) + left * tile.channels);
    if (++parts.next < parts.count())
        call_in_own_turn(this, [this] { draw_tile(); });
    else
        end(parts.image);
}

void TiledPicture::end(const QImage& image) {
    emit finished(image);
}

}  // namespace curvewright
