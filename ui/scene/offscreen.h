#pragma once

#include <filesystem>
#include <string>

#include "ui/scene/mesh_scene.h"
#include "ui/scene/picture_pixels.h"

namespace curvewright {

/// What a picture has where nothing is drawn.
enum class PictureGround {
    background,   ///< the scene's background colour
    transparent,  ///< nothing: borders of what is drawn are see-through in part, without the background in them
};

/// Renders a scene without a window or a display (EGL surfaceless): twice as large and averaged, for smooth borders.
/// The scene must not be part of a window; to export what a window shows, give a scene of its own the same mesh,
/// options and view (MeshScene::copy_view). Throws Unsupported if the scene is in a window, or no OpenGL 3.2 context
/// can be made (what is missing is named).
PicturePixels render_pixels(MeshScene& scene, int width, int height, PictureGround ground = PictureGround::background);

/// The same as a PNG file, written atomically. Throws InvalidInput if the file cannot be written.
void render_png(MeshScene& scene, int width, int height, const std::filesystem::path& file,
                PictureGround ground = PictureGround::background);

/// The same picture as the bytes of a PNG file.
std::string draw_png(MeshScene& scene, int width, int height, PictureGround ground = PictureGround::background);

}  // namespace curvewright
