// surface: something to draw on with OpenGL 3.3 core: a window, or memory where there is no display.
//
// A thread makes a surface current and then draws; only the program's first thread may own a window.
#pragma once
#include <memory>
#include <span>
#include <stdexcept>
#include <string>

#include "pincer/devices/window/input.h"

namespace pincer::devices {

// No window or no OpenGL. The message says which and what helps.
class DisplayError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

struct SurfaceSize {
  int width = 1280, height = 720;  // [pixels]
};

class Surface {
 public:
  using GlFunction = void (*)();

  virtual ~Surface() = default;
  virtual std::string description() const = 0;  // what it is and who draws: "window, llvmpipe"
  virtual SurfaceSize size() const = 0;         // now
  virtual void makeCurrent() = 0;
  // Address of an OpenGL function; the surface must be current in some thread.
  virtual GlFunction (*loader() const)(const char* name) = 0;
  // True if framebuffer 0 is what a person sees. If not there is none.
  virtual bool isWindow() const = 0;
  // Shows what was drawn to framebuffer 0.
  virtual void present() = 0;
  // Events since the last call; valid until the next.
  virtual std::span<const InputEvent> poll() = 0;
  virtual bool closed() const = 0;  // the person has closed it
  virtual void toggleFullScreen() = 0;
  virtual void showPointer(bool shown) = 0;  // over the window; its events come all the same
};

struct WindowOptions {
  std::string title = "pincer";
  SurfaceSize size = {};
  bool synchronised = true;  // present() waits for the screen's next refresh
};

// Throws DisplayError: no display, or one that can't do OpenGL 3.3.
std::unique_ptr<Surface> openWindow(const WindowOptions& options);

// Memory, by EGL without any window system or server; needs no graphics card. Throws DisplayError.
std::unique_ptr<Surface> openOffscreen(const SurfaceSize& size);

}  // namespace pincer::devices
