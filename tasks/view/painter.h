// painter: makes pictures of snapshots on a surface.
#pragma once
#include <memory>

#include "pincer/tasks/run/scene.h"
#include "pincer/tasks/view/renderer.h"
#include "pincer/tasks/view/scene_drawing.h"

namespace pincer::tasks {

class Painter {
 public:
  // `model` must outlive it.
  Painter(devices::Surface& surface, const grasp::GraspModel& model, const Snapshot& start);

  // `at_best`: with smooth borders, half shadows and dark corners.
  void draw(const Snapshot& snapshot, const ViewChoice& choice, bool at_best = true);
  // Puts the camera where most of each thing is seen (framing.h).
  void frame(const Snapshot& snapshot, const SceneCamera& given);
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
