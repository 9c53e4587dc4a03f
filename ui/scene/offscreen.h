#pragma once

#include <filesystem>

#include "ui/scene/mesh_scene.h"

namespace curvewright {

/// Renders a scene without a window or a display (EGL surfaceless) and writes a PNG, atomically.
/// Throws Unsupported if no OpenGL 3.2 context can be made (what is missing is named), InvalidInput if the file cannot be
/// written.
void render_png(MeshScene& scene, int width, int height, const std::filesystem::path& file);

}  // namespace curvewright
