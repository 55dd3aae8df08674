#define EGL_NO_X11
#include <EGL/egl.h>
#include <EGL/eglext.h>

#include <array>

#include "pincer/devices/window/surface.h"

namespace pincer::devices {
namespace {

// Follows every message about EGL.
constexpr const char* kEglRemedy = " Install Mesa's software drivers: apt-get install libegl-mesa0 libgl1-mesa-dri.";

EGLDisplay surfacelessDisplay() {
  const auto get = reinterpret_cast<PFNEGLGETPLATFORMDISPLAYEXTPROC>(eglGetProcAddress("eglGetPlatformDisplayEXT"));
  const EGLDisplay display = get ? get(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr) : EGL_NO_DISPLAY;
  if (display == EGL_NO_DISPLAY || eglInitialize(display, nullptr, nullptr) != EGL_TRUE) {
    throw DisplayError(std::string("No EGL without a window system here.") + kEglRemedy);
  }
  return display;
}

EGLContext coreContext(EGLDisplay display) {
  // Keys and values up to EGL_NONE: OpenGL 3.3, core.
  constexpr std::array<EGLint, 7> kWanted = {
      EGL_CONTEXT_MAJOR_VERSION,           3,       EGL_CONTEXT_MINOR_VERSION, 3, EGL_CONTEXT_OPENGL_PROFILE_MASK,
      EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT, EGL_NONE};
  const bool has_gl = eglBindAPI(EGL_OPENGL_API) == EGL_TRUE;
  const EGLContext context =
      has_gl ? eglCreateContext(display, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, kWanted.data()) : EGL_NO_CONTEXT;
  if (context == EGL_NO_CONTEXT) throw DisplayError(std::string("EGL gives no OpenGL 3.3 core.") + kEglRemedy);
  return context;
}

// The display is the process's: EGL hands out one and the same, and ending it would end it for all.
class OffscreenSurface final : public Surface {
 public:
  explicit OffscreenSurface(const SurfaceSize& size)
      : size_(size), display_(surfacelessDisplay()), context_(coreContext(display_)) {
    OffscreenSurface::makeCurrent();
  }
  ~OffscreenSurface() override {
    if (eglGetCurrentContext() == context_) eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    eglDestroyContext(display_, context_);
  }
  OffscreenSurface(const OffscreenSurface&) = delete;
  OffscreenSurface& operator=(const OffscreenSurface&) = delete;

  std::string description() const override { return "memory"; }
  SurfaceSize size() const override { return size_; }
  void makeCurrent() override {
    if (eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, context_) == EGL_TRUE) return;
    throw DisplayError(std::string("EGL can't draw without a surface here.") + kEglRemedy);
  }
  GlFunction (*loader() const)(const char*) override {
    return [](const char* name) { return eglGetProcAddress(name); };
  }
  bool isWindow() const override { return false; }
  void present() override {}
  std::span<const InputEvent> poll() override { return {}; }
  bool closed() const override { return false; }
  void toggleFullScreen() override {}
  void showPointer(bool) override {}

 private:
  SurfaceSize size_;
  EGLDisplay display_;
  EGLContext context_;
};

}  // namespace

std::unique_ptr<Surface> openOffscreen(const SurfaceSize& size) { return std::make_unique<OffscreenSurface>(size); }

}  // namespace pincer::devices
