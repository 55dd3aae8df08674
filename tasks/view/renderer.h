// renderer: draws a list of things with OpenGL 3.3 core: shaded, with shadows, smooth
// borders; the same for a window and for memory.
//
// Light: a sun with a shadow map, a sky whose light comes from above and a ground that gives some back; colours are
// linear and end in sRGB. Everything is drawn to an own multisampled picture, which then goes to the window, if there
// is one. Calls need the surface to be current.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "pincer/devices/window/surface.h"
#include "pincer/tasks/view/camera.h"
#include "pincer/tasks/view/draw_list.h"
#include "pincer/tasks/view/image.h"

namespace pincer::tasks {

struct RenderOptions {
  bool shadows = true;
  Vec3 centre_W = Vec3::Zero();  // of what has sharp shadows [m]
  double radius = 0.15;          // of it [m]
  bool smooth_borders = true;    // several samples per pixel there: twice the time without a graphics card
  // half shadows, and less light in corners and near contacts: ten times the time without a graphics card
  bool soft = true;
};

class Renderer final : public MeshSink {
 public:
  // Throws devices::DisplayError when the surface can't do what is needed.
  explicit Renderer(devices::Surface& surface);
  ~Renderer() override;
  Renderer(const Renderer&) = delete;
  Renderer& operator=(const Renderer&) = delete;

  int add(const ViewMesh& mesh) override;
  std::string graphics() const;  // who draws: "llvmpipe (LLVM 15, 256 bits)"
  bool isSoftware() const;       // no graphics card does
  void draw(const DrawList& list, const Camera& camera, const RenderOptions& options);
  // Whose each pixel is in a picture of this size, row by row from the upper left: DrawItem::thing of what is in front,
  // 0 where nothing is. Marks and the ground are left out.
  std::vector<int> things(const DrawList& list, const Camera& camera, devices::SurfaceSize size);
  // The picture drawn since, overlays included.
  Image picture();
  // To the surface's window, if it is one.
  void show();

 private:
  struct Gl;
  std::unique_ptr<Gl> gl_;
};

}  // namespace pincer::tasks
