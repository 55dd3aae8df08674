#include "pincer/tasks/view/scene_picture.h"

#include <fmt/format.h>

#include "pincer/contact/error.h"

namespace pincer::tasks {
namespace {

// [pixels]; the upper one is what OpenGL 3.3 promises of textures on any driver of today
constexpr int kLeastSide = 16, kMostSide = 8192;

void checkSide(const char* name, int pixels) {
  if (pixels >= kLeastSide && pixels <= kMostSide) return;
  throw InputError(
      fmt::format("picture: {} = {} is out of range [{}, {}] pixels.", name, pixels, kLeastSide, kMostSide));
}

void set(const char* name, const std::optional<double>& said, double least, double most, double& value) {
  if (!said) return;
  if (!(*said >= least && *said <= most)) {
    throw InputError(fmt::format("camera: {} = {} is out of range [{}, {}].", name, *said, least, most));
  }
  value = *said;
}

Camera chosen(Camera camera, const CameraChoice& choice) {
  if (choice.target_W) camera.target_W = *choice.target_W;
  if (!camera.target_W.allFinite()) throw InputError("camera: the target isn't finite. Give a place [m].");
  set("distance", choice.distance, 1e-3, 1e3, camera.distance);
  set("yaw", choice.yaw, -1e3, 1e3, camera.yaw);
  set("pitch", choice.pitch, -1.5, 1.5, camera.pitch);
  return camera;
}

}  // namespace

ScenePicture::ScenePicture(const grasp::GraspModel& model, const grasp::GraspState& start, int width, int height)
    : model_(model), untouched_(grasp::makeScratch(model)), snapshot_(Snapshot::sizedFor(model)) {
  checkSide("width", width);
  checkSide("height", height);
  surface_ = devices::openOffscreen({width, height});
  surface_->makeCurrent();
  captureGrasp(model_, start, *untouched_, {}, snapshot_);
  painter_.emplace(*surface_, model_, snapshot_);
}

Image ScenePicture::draw(const grasp::GraspState& state, const grasp::GraspScratch* scratch, const CameraChoice& camera,
                         bool forces) {
  surface_->makeCurrent();
  captureGrasp(model_, state, scratch ? *scratch : std::as_const(*untouched_), {}, snapshot_);
  ViewChoice choice;
  choice.contacts = choice.forces = choice.cones = forces;
  const Camera usual = painter_->camera();
  painter_->camera() = chosen(usual, camera);
  painter_->draw(snapshot_, choice);
  painter_->camera() = usual;
  return painter_->picture();
}

}  // namespace pincer::tasks
