#include "ui/scene/egl_context.h"

#include <array>
#include <string_view>

#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <fmt/format.h>

#include "core/base/error.h"

#ifndef EGL_PLATFORM_SURFACELESS_MESA
#define EGL_PLATFORM_SURFACELESS_MESA 0x31DD
#endif

namespace curvewright {
namespace {

[[noreturn]] void fail(std::string_view what) {
    throw Unsupported(
        fmt::format("A picture cannot be drawn without a display: {} (EGL error 0x{:x}). Software "
                    "rendering (package libgl1-mesa-dri) provides it.",
                    what, eglGetError()));
}

EGLDisplay find_display() {
    const char* extensions = eglQueryString(EGL_NO_DISPLAY, EGL_EXTENSIONS);
    const std::string_view known = extensions ? extensions : "";
    const auto get_platform_display =
        reinterpret_cast<PFNEGLGETPLATFORMDISPLAYEXTPROC>(eglGetProcAddress("eglGetPlatformDisplayEXT"));
    if (get_platform_display && known.find("EGL_MESA_platform_surfaceless") != std::string_view::npos) {
        const EGLDisplay display = get_platform_display(EGL_PLATFORM_SURFACELESS_MESA, nullptr, nullptr);
        if (display != EGL_NO_DISPLAY && eglInitialize(display, nullptr, nullptr)) return display;
    }
    // Drivers without Mesa's platform: a graphics device by itself.
    const auto query_devices = reinterpret_cast<PFNEGLQUERYDEVICESEXTPROC>(eglGetProcAddress("eglQueryDevicesEXT"));
    std::array<EGLDeviceEXT, 8> devices{};
    EGLint count = 0;
    if (get_platform_display && query_devices &&
        query_devices(static_cast<EGLint>(devices.size()), devices.data(), &count))
        for (EGLint i = 0; i < count; ++i) {
            const EGLDisplay display = get_platform_display(EGL_PLATFORM_DEVICE_EXT, devices[i], nullptr);
            if (display != EGL_NO_DISPLAY && eglInitialize(display, nullptr, nullptr)) return display;
        }
    const EGLDisplay display = eglGetDisplay(EGL_DEFAULT_DISPLAY);
    if (display != EGL_NO_DISPLAY && eglInitialize(display, nullptr, nullptr)) return display;
    fail("no EGL display could be opened");
}

}  // namespace

EglContext::EglContext() {
    display_ = find_display();
    if (!eglBindAPI(EGL_OPENGL_API)) fail("the EGL library has no desktop OpenGL");
    const std::array<EGLint, 13> wanted{EGL_SURFACE_TYPE,
                                        EGL_PBUFFER_BIT,
                                        EGL_RENDERABLE_TYPE,
                                        EGL_OPENGL_BIT,
                                        EGL_RED_SIZE,
                                        8,
                                        EGL_GREEN_SIZE,
                                        8,
                                        EGL_BLUE_SIZE,
                                        8,
                                        EGL_DEPTH_SIZE,
                                        24,
                                        EGL_NONE};
    EGLConfig config = nullptr;
    EGLint count = 0;
    if (!eglChooseConfig(display_, wanted.data(), &config, 1, &count) || count == 0)
        fail("no pixel format with 24 bits of colour and depth was found");
    const std::array<EGLint, 7> version{
        EGL_CONTEXT_MAJOR_VERSION,           3,       EGL_CONTEXT_MINOR_VERSION, 2, EGL_CONTEXT_OPENGL_PROFILE_MASK,
        EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT, EGL_NONE};
    context_ = eglCreateContext(display_, config, EGL_NO_CONTEXT, version.data());
    if (context_ == EGL_NO_CONTEXT) fail("no OpenGL 3.2 core context could be made");
    // VTK draws into framebuffers of its own; the surface only has to exist.
    const std::array<EGLint, 5> extent{EGL_WIDTH, 16, EGL_HEIGHT, 16, EGL_NONE};
    surface_ = eglCreatePbufferSurface(display_, config, extent.data());
    if (!eglMakeCurrent(display_, surface_, surface_, context_)) {
        eglDestroyContext(display_, context_);
        fail("the OpenGL context could not be made current");
    }
}

EglContext::~EglContext() {
    eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    if (surface_ != EGL_NO_SURFACE) eglDestroySurface(display_, surface_);
    eglDestroyContext(display_, context_);
    // The display stays: it is one per process, and others may use it.
    eglReleaseThread();
}

void EglContext::make_current() {
    eglMakeCurrent(display_, surface_, surface_, context_);
}

bool EglContext::is_current() const {
    return eglGetCurrentContext() == context_;
}

}  // namespace curvewright
