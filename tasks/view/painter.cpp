#include "pincer/tasks/view/painter.h"

#include "pincer/tasks/view/framing.h"

namespace pincer::tasks {

Painter::Painter(devices::Surface& surface, const grasp::GraspModel& model, const Snapshot& start)
    : renderer_(surface), scene_(model, start, renderer_), camera_(scene_.camera(start)) {}

void Painter::draw(const Snapshot& snapshot, const ViewChoice& choice, bool at_best) {
  RenderOptions options;
  options.shadows = choice.shadows;
  options.smooth_borders = options.soft = at_best;
  options.centre_W = camera_.target_W;
  options.radius = 1.3 * scene_.radius(snapshot) + (scene_.centre_W(snapshot) - camera_.target_W).norm();
  renderer_.draw(scene_.compose(snapshot, choice), camera_, options);
}

void Painter::frame(const Snapshot& snapshot, const SceneCamera& given) {
  camera_ = framed(scene_.compose(snapshot, {}), scene_.camera(snapshot), given, renderer_);
}

}  // namespace pincer::tasks
