#include "pincer/tasks/lab/experiments/pickup_scene.h"

#include <algorithm>

#include "pincer/contact/pair_query.h"

namespace pincer::tasks {
namespace {

constexpr double kFarthest = 0.3;  // [m]

}  // namespace

HandScene makePickupScene(const SpherePickupOptions& options, const PickupObject& object, const PickupTrialSpec& spec) {
  HandScene scene = makeHandScene(options.hand, pickupWorld(options, object.shape, spec.mu_s, spec.mu_d),
                                  {{}, {object.rest_X_WB, Vec3::Zero(), Vec3::Zero()}}, object.place_W,
                                  object.half_width, spec.condition.display_tactile);
  if (object.felt) grasp::feelAs(scene.model.grasp, kObjectBody, *object.felt);
  scene.object = kObjectBody;
  scene.cues.seed = spec.seed;
  scene.cues.mass = options.mass;
  scene.cues.lift_height = options.success_height;
  scene.cues.dish_radius = options.dish_radius;
  return scene;
}

double clearanceOverDish(const HandScene& scene, const Pose& X_WB, contact::PatchCache& patches) {
  const auto& shapes = scene.model.grasp.world.colliders;  // one per body
  contact::PairPoints points;
  contact::collideShapes(shapes[kObjectBody].shape, X_WB, shapes[kDishBody].shape, Pose(), kFarthest, patches, points);
  double clearance = kFarthest;
  for (int i = 0; i < points.count; ++i)
    clearance = std::min(clearance, points.points[static_cast<std::size_t>(i)].phi);
  return clearance;
}

}  // namespace pincer::tasks
