// scene_picture: pictures of states of one model, drawn in memory one after the other: for scripts and videos.
#pragma once
#include <memory>
#include <optional>
#include <utility>

#include "pincer/tasks/view/image.h"
#include "pincer/tasks/view/painter.h"

namespace pincer::tasks {

// From where to look; what isn't said is as in the window: all that moves is in the picture.
struct CameraChoice {
  std::optional<Vec3> target_W;                // that it looks at [m]
  std::optional<double> distance, yaw, pitch;  // camera.h
};

// One thread makes and uses it. Throws devices::DisplayError where there is no OpenGL,
// InputError for a size or camera out of range.
class ScenePicture {
 public:
  // `model` must outlive it. Looks from where `start` is seen whole. Sides of 16 .. 8192 pixels.
  ScenePicture(const grasp::GraspModel& model, const grasp::GraspState& start, int width, int height);

  // `scratch`: of the state's last step, for forces and contacts; null: none are drawn.
  Image draw(const grasp::GraspState& state, const grasp::GraspScratch* scratch, const CameraChoice& camera,
             bool forces);

 private:
  const grasp::GraspModel& model_;
  grasp::ScratchHandle untouched_;  // stands for that of a state that wasn't stepped
  Snapshot snapshot_;
  std::unique_ptr<devices::Surface> surface_;
  std::optional<Painter> painter_;
};

}  // namespace pincer::tasks
