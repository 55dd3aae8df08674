#include "pincer/tasks/view/painter.h"

namespace pincer::tasks {

Painter::Painter(devices::Surface& surface, const grasp::GraspModel& model, const Snapshot& start)
    : renderer_(surface), scene_(model, start, renderer_), camera_(scene_.camera(start)) {}

void Painter::draw(const Snapshot& snapshot, const ViewChoice& choice, bool smooth_borders) {
  RenderOptions options;
  options.shadows = choice.shadows;
  options.smooth_borders = smooth_borders;
  options.centre_W = camera_.target_W;
  options.radius = 1.3 * scene_.radius(snapshot) + (scene_.centre_W(snapshot) - camera_.target_W).norm();
  renderer_.draw(scene_.compose(snapshot, choice), camera_, options);
}

}  // namespace pincer::tasks
