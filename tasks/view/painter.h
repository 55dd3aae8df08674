// painter: makes pictures of snapshots on a surface.
#pragma once
#include <memory>

#include "pincer/tasks/view/renderer.h"
#include "pincer/tasks/view/scene_drawing.h"

namespace pincer::tasks {

class Painter {
 public:
  // `model` must outlive it.
  Painter(devices::Surface& surface, const grasp::GraspModel& model, const Snapshot& start);

  void draw(const Snapshot& snapshot, const ViewChoice& choice, bool smooth_borders = true);
  Image picture() { return renderer_.picture(); }
  void show() { renderer_.show(); }

  Camera& camera() { return camera_; }
  const Camera& camera() const { return camera_; }
  const SceneDrawing& scene() const { return scene_; }
  Renderer& renderer() { return renderer_; }

 private:
  Renderer renderer_;
  SceneDrawing scene_;
  Camera camera_;
};

}  // namespace pincer::tasks
