#include "app/desktop/start_up.h"

#include <cstring>

#include <QOffscreenSurface>
#include <QOpenGLContext>
#include <QSurfaceFormat>
#include <QtGlobal>

namespace curvewright {
namespace {

std::string requested_platform(int argc, char** argv) {
    for (int i = 1; i < argc; ++i) {
        const char* argument = argv[i];
        if (std::strncmp(argument, "--platform", 10) == 0) ++argument;
        if (std::strcmp(argument, "-platform") == 0 && i + 1 < argc) return argv[i + 1];
        if (std::strncmp(argument, "-platform=", 10) == 0) return argument + 10;
    }
    return qgetenv("QT_QPA_PLATFORM").toStdString();
}

}  // namespace

std::string prepare_display(int argc, char** argv) {
    const std::string platform = requested_platform(argc, argv);
    for (const char* refused : {"offscreen", "minimal", "vnc", "linuxfb"})
        if (platform.rfind(refused, 0) == 0)
            return "The platform '" + platform +
                   "' has no OpenGL for the view: use xcb (for example under xvfb-run), or curvewright-cli, which "
                   "needs no "
                   "display.";
    if (platform.empty()) {
        // The view's OpenGL needs GLX or EGL under X; on Wayland that is XWayland.
        if (qEnvironmentVariableIsEmpty("DISPLAY")) {
            if (qEnvironmentVariableIsEmpty("WAYLAND_DISPLAY"))
                return "There is no display (neither DISPLAY nor WAYLAND_DISPLAY is set): start the program on a "
                       "desktop or "
                       "under xvfb-run, or use curvewright-cli, which needs none.";
        } else {
            qputenv("QT_QPA_PLATFORM", "xcb");
        }
    }
    QSurfaceFormat format;
    format.setRenderableType(QSurfaceFormat::OpenGL);
    format.setVersion(3, 2);
    format.setProfile(QSurfaceFormat::CoreProfile);
    format.setSwapBehavior(QSurfaceFormat::DoubleBuffer);
    format.setRedBufferSize(8);
    format.setGreenBufferSize(8);
    format.setBlueBufferSize(8);
    format.setAlphaBufferSize(8);
    format.setDepthBufferSize(24);
    format.setStencilBufferSize(0);
    format.setSamples(0);
    QSurfaceFormat::setDefaultFormat(format);
    return {};
}

std::string probe_opengl() {
    QOpenGLContext context;
    context.setFormat(QSurfaceFormat::defaultFormat());
    if (!context.create()) return "No OpenGL context could be made on this display: the view needs OpenGL 3.2.";
    if (context.isOpenGLES()) return "This display offers OpenGL ES only: the view needs desktop OpenGL 3.2.";
    QOffscreenSurface surface;
    surface.setFormat(context.format());
    surface.create();
    if (!context.makeCurrent(&surface)) return "The OpenGL context of this display cannot be used.";
    const auto version = context.format().version();
    context.doneCurrent();
    if (version < std::pair(3, 2))
        return "This display offers OpenGL " + std::to_string(version.first) + "." + std::to_string(version.second) +
               " only: the view needs 3.2.";
    return {};
}

}  // namespace curvewright
