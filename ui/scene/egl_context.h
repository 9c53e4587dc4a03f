#pragma once

namespace curvewright {

/// An OpenGL 3.2 core context without a window or a display, current on the thread that made it.
class EglContext {
  public:
    /// Throws Unsupported that names what is missing.
    EglContext();
    ~EglContext();
    EglContext(const EglContext&) = delete;
    EglContext& operator=(const EglContext&) = delete;

    void make_current();
    bool is_current() const;

  private:
    // EGLDisplay, EGLSurface and EGLContext are pointers to void.
    void* display_ = nullptr;
    void* surface_ = nullptr;
    void* context_ = nullptr;
};

}  // namespace curvewright
