#pragma once

#include <memory>

#include <QImage>
#include <QObject>

#include "ui/main_window/picture_drawing.h"

namespace curvewright {

/// Draws a picture of what a view shows while the event loop goes on: the drawing is prepared on another thread, handed
/// to graphics of its own piece by piece, and drawn in tiles. The view goes on undisturbed; what it shows when the
/// picture is begun is what is drawn. Destroying it stops it.
class TiledPicture : public QObject {
    Q_OBJECT

  public:
    /// pre: why_no_picture(options.size, ...) is empty.
    TiledPicture(const MeshView& view, const PictureOptions& options, QObject* parent = nullptr);
    ~TiledPicture() override;

    /// Tiles that are drawn at a time have about so many pixels, before they are averaged.
    static inline long long tile_pixels = 1'500'000;

  signals:
    void progress(double fraction);
    /// Null if the graphics fail.
    void finished(const QImage& image);

  private:
    struct Parts;

    void take_drawing();
    void upload();
    void begin();
    void draw_tile();
    void draw_part();
    void poll_tile();
    void take_tile();
    void end(const QImage& image);

    std::unique_ptr<Parts> parts_;
};

}  // namespace curvewright
