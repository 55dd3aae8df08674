#include "pincer/tasks/view/framing.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "pincer/contact/elementary.h"

namespace pincer::tasks {
namespace {

constexpr devices::SurfaceSize kSize{160, 90};   // of the small pictures that are looked at
constexpr int kWays = 8;                         // around the scene
constexpr double kNearlyAsGood = 0.985;          // of the best score
constexpr double kWidth = 0.66, kHeight = 0.56;  // of the picture, that things fill
constexpr double kNearest = 0.25;                // of the plain distance

double score(const std::vector<int>& things) {
  std::map<int, int> pixels;
  for (const int thing : things) {
    if (thing > 0) ++pixels[thing];
  }
  double sum = 0;
  for (const auto& [thing, count] : pixels) sum += math::log(1.0 + count);
  return sum;
}

double bestYaw(const DrawList& list, const Camera& plain, Renderer& renderer) {
  Camera camera = plain;
  double best = 0, first = 0, yaw = plain.yaw;
  for (int way = 0; way < kWays; ++way) {
    camera.yaw = std::remainder(plain.yaw + way * 2 * std::numbers::pi / kWays, 2 * std::numbers::pi);
    const double seen = score(renderer.things(list, camera, kSize));
    if (way == 0) first = seen;
    if (seen <= best) continue;
    best = seen;
    yaw = camera.yaw;
  }
  return first >= kNearlyAsGood * best ? plain.yaw : yaw;
}

// Moves it so that the things' borders, as seen, lie in the middle and fill the picture.
void fill(const DrawList& list, double nearest, Renderer& renderer, Camera& camera) {
  const std::vector<int> things = renderer.things(list, camera, kSize);
  Eigen::AlignedBox2i box;
  for (int y = 0; y < kSize.height; ++y) {
    for (int x = 0; x < kSize.width; ++x) {
      if (things[static_cast<std::size_t>(y * kSize.width + x)] > 0) box.extend(Eigen::Vector2i(x, y));
    }
  }
  if (box.isEmpty()) return;
  const Vec2 low = box.min().cast<double>(), high = box.max().cast<double>() + Vec2::Ones();
  const Vec2 middle = 0.5 * (low + high) / kSize.height, size = (high - low) / kSize.height;
  const double aspect = static_cast<double>(kSize.width) / kSize.height;
  camera.pan(middle.x() - 0.5 * aspect, 0.5 - middle.y());
  camera.distance = std::max(nearest, camera.distance * std::max(size.x() / (kWidth * aspect), size.y() / kHeight));
}

}  // namespace

Camera withGiven(const SceneCamera& given, Camera camera) {
  camera.yaw = given.yaw.value_or(camera.yaw);
  camera.pitch = given.pitch.value_or(camera.pitch);
  camera.distance = given.distance.value_or(camera.distance);
  camera.target_W = given.target_W.value_or(camera.target_W);
  return camera;
}

Camera framed(const DrawList& list, const Camera& plain, const SceneCamera& given, Renderer& renderer) {
  Camera camera = plain;
  camera.pitch = given.pitch.value_or(plain.pitch);
  camera.yaw = given.yaw ? *given.yaw : bestYaw(list, camera, renderer);
  // nearer, perspective moves the borders
  for (int i = 0; i < 2; ++i) fill(list, kNearest * plain.distance, renderer, camera);
  return withGiven(given, camera);
}

}  // namespace pincer::tasks
