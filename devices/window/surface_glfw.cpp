#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <algorithm>
#include <vector>

#include "pincer/devices/window/surface.h"

namespace pincer::devices {
namespace {

static_assert(kKeyEscape == GLFW_KEY_ESCAPE && kKeyTab == GLFW_KEY_TAB && kKeyRight == GLFW_KEY_RIGHT &&
              kKeyPageUp == GLFW_KEY_PAGE_UP && kKeyEnd == GLFW_KEY_END && kKeyF1 == GLFW_KEY_F1 &&
              kKeyF5 == GLFW_KEY_F5 && kKeyShift == GLFW_KEY_LEFT_SHIFT && kKeyControl == GLFW_KEY_LEFT_CONTROL);
static_assert(kButtonLeft == GLFW_MOUSE_BUTTON_LEFT && kButtonRight == GLFW_MOUSE_BUTTON_RIGHT);

[[noreturn]] void throwNoWindow(const std::string& what) {
  const char* why = nullptr;
  glfwGetError(&why);
  throw DisplayError(what + (why ? std::string(" (") + why + ")" : "") +
                     ". Run it in a graphical session or under `xvfb-run`; pictures need none: --screenshot FILE.png.");
}

// GLFW is one per process; the last window ends it.
class GlfwLibrary {
 public:
  GlfwLibrary() {
    if (glfwInit() != GLFW_TRUE) throwNoWindow("There is no display to open a window on");
  }
  ~GlfwLibrary() { glfwTerminate(); }
  GlfwLibrary(const GlfwLibrary&) = delete;
  GlfwLibrary& operator=(const GlfwLibrary&) = delete;
};

class WindowSurface final : public Surface {
 public:
  explicit WindowSurface(const WindowOptions& options) {
    glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 3);
    glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 3);
    glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
    glfwWindowHint(GLFW_OPENGL_FORWARD_COMPAT, GLFW_TRUE);
    window_ = glfwCreateWindow(options.size.width, options.size.height, options.title.c_str(), nullptr, nullptr);
    if (!window_) throwNoWindow("The display can't open a window with OpenGL 3.3");
    events_.reserve(kMostEvents);
    glfwSetWindowUserPointer(window_, this);
    listen();
    WindowSurface::makeCurrent();
    glfwSwapInterval(options.synchronised ? 1 : 0);
  }
  ~WindowSurface() override { glfwDestroyWindow(window_); }
  WindowSurface(const WindowSurface&) = delete;
  WindowSurface& operator=(const WindowSurface&) = delete;

  std::string description() const override { return "window"; }
  SurfaceSize size() const override {
    SurfaceSize size;
    glfwGetFramebufferSize(window_, &size.width, &size.height);
    return {std::max(size.width, 1), std::max(size.height, 1)};
  }
  void makeCurrent() override { glfwMakeContextCurrent(window_); }
  GlFunction (*loader() const)(const char*) override {
    return [](const char* name) { return glfwGetProcAddress(name); };
  }
  bool isWindow() const override { return true; }
  void present() override { glfwSwapBuffers(window_); }
  std::span<const InputEvent> poll() override {
    events_.clear();
    glfwPollEvents();
    return events_;
  }
  bool closed() const override { return glfwWindowShouldClose(window_) == GLFW_TRUE; }
  void toggleFullScreen() override;
  void showPointer(bool shown) override {
    glfwSetInputMode(window_, GLFW_CURSOR, shown ? GLFW_CURSOR_NORMAL : GLFW_CURSOR_HIDDEN);
  }

 private:
  struct Place {
    int x = 0, y = 0, width = 0, height = 0;
  };
  static WindowSurface& of(GLFWwindow* window) {
    return *static_cast<WindowSurface*>(glfwGetWindowUserPointer(window));
  }
  static Modifiers modifiers(int mods) { return {(mods & GLFW_MOD_SHIFT) != 0, (mods & GLFW_MOD_CONTROL) != 0}; }
  // Events are in pixels of what is drawn, which on some displays are finer than the window's own unit.
  InputEvent at(InputKind kind, double x, double y) const {
    int width = 1, height = 1;
    glfwGetWindowSize(window_, &width, &height);
    const SurfaceSize drawn = size();
    return {kind, 0, false, x * drawn.width / std::max(width, 1), y * drawn.height / std::max(height, 1), {}};
  }
  void listen();
  // From GLFW, which is C: nothing may be thrown through it. Nobody makes so many events between two pictures.
  void note(const InputEvent& event) noexcept {
    if (events_.size() < kMostEvents) events_.push_back(event);
  }

  static constexpr std::size_t kMostEvents = 4096;  // between two pictures
  GlfwLibrary library_;
  GLFWwindow* window_ = nullptr;
  std::vector<InputEvent> events_;
  Place windowed_;  // where to go back to from the full screen
};

void WindowSurface::listen() {
  glfwSetKeyCallback(window_, [](GLFWwindow* window, int key, int, int action, int mods) {
    if (key == GLFW_KEY_RIGHT_SHIFT) key = GLFW_KEY_LEFT_SHIFT;
    if (key == GLFW_KEY_RIGHT_CONTROL) key = GLFW_KEY_LEFT_CONTROL;
    of(window).note({InputKind::kKey, key, action != GLFW_RELEASE, 0, 0, modifiers(mods)});
  });
  glfwSetMouseButtonCallback(window_, [](GLFWwindow* window, int button, int action, int mods) {
    double x = 0, y = 0;
    glfwGetCursorPos(window, &x, &y);
    InputEvent event = of(window).at(InputKind::kButton, x, y);
    event.code = button;
    event.down = action == GLFW_PRESS;
    event.modifiers = modifiers(mods);
    of(window).note(event);
  });
  glfwSetCursorPosCallback(
      window_, [](GLFWwindow* window, double x, double y) { of(window).note(of(window).at(InputKind::kMove, x, y)); });
  glfwSetScrollCallback(window_, [](GLFWwindow* window, double x, double y) {
    of(window).note({InputKind::kWheel, 0, false, x, y, {}});
  });
}

void WindowSurface::toggleFullScreen() {
  if (glfwGetWindowMonitor(window_)) {
    glfwSetWindowMonitor(window_, nullptr, windowed_.x, windowed_.y, windowed_.width, windowed_.height, 0);
    return;
  }
  GLFWmonitor* monitor = glfwGetPrimaryMonitor();
  const GLFWvidmode* mode = monitor ? glfwGetVideoMode(monitor) : nullptr;
  if (!mode) return;
  glfwGetWindowPos(window_, &windowed_.x, &windowed_.y);
  glfwGetWindowSize(window_, &windowed_.width, &windowed_.height);
  glfwSetWindowMonitor(window_, monitor, 0, 0, mode->width, mode->height, mode->refreshRate);
}

}  // namespace

std::unique_ptr<Surface> openWindow(const WindowOptions& options) { return std::make_unique<WindowSurface>(options); }

}  // namespace pincer::devices
