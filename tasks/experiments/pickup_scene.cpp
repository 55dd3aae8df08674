#include "tasks/experiments/pickup_scene.h"

#include <algorithm>

#include "contact/shape/pair_query.h"
#include "engine/world/state.h"

namespace pincer::tasks {
namespace {

constexpr double kHomeBeside = 0.045;  // a waiting fingertip is so far beside the object [m]
constexpr double kHomeAbove = 0.040;   // and above the pinch place [m]
constexpr double kFarthest = 0.3;      // [m]

Quat fromAxes(const Vec3& x, const Vec3& y, const Vec3& z) {
  Mat3 R;
  R << x, y, z;
  return Quat(R);
}

struct Side {
  double sign;  // of x where the finger waits
  Quat q_WD, q_DF;
};

// D: z towards the object, y up. F: -z towards the object, x towards +y of W.
Side sideOf(int finger) {
  const double sign = finger == 0 ? -1 : 1;
  const Vec3 inwards = -sign * Vec3::UnitX();
  const Quat q_WD = fromAxes(Vec3::UnitZ().cross(inwards), Vec3::UnitZ(), inwards);
  const Quat q_WF = fromAxes(Vec3::UnitY(), (-inwards).cross(Vec3::UnitY()), -inwards);
  return {sign, q_WD, q_WD.conjugate() * q_WF};
}

grasp::FingerModel fingerModel(const SpherePickupOptions& options, int finger) {
  grasp::FingerModel model;
  model.name = finger == 0 ? "index" : "thumb";
  model.radius = options.finger_radius;
  model.coupling.stiffness.setConstant(options.coupling_stiffness);
  model.coupling.damping.setConstant(options.coupling_damping);
  return model;
}

TrialCues cuesOf(const SpherePickupOptions& options, const PickupObject& object, const PickupScene& scene, std::uint64_t seed) {
  TrialCues cues;
  cues.seed = seed;
  cues.place_W = object.place_W;
  cues.half_width = object.half_width;
  cues.mass = options.mass;
  cues.lift_height = options.success_height;
  cues.dish_radius = options.dish_radius;
  for (std::size_t i = 0; i < cues.fingers.size(); ++i) {
    const grasp::FingerModel& finger = scene.model.grasp.fingers[i];
    const Pose& X_WD = scene.model.mounts[i].X_WD;
    cues.fingers[i] = {
        X_WD.q, X_WD.p, scene.homes_W[i], finger.radius, finger.pad_normal_F, finger.distal_F, finger.pad_normal_F.cross(finger.distal_F)};
  }
  return cues;
}

}  // namespace

PickupScene makePickupScene(const SpherePickupOptions& options, const PickupObject& object, const PickupTrialSpec& spec) {
  PickupScene scene;
  std::vector<grasp::FingerModel> fingers;
  const double beside = object.half_width + options.finger_radius + kHomeBeside;
  for (int i = 0; i < kHandFingers; ++i) {
    const Side side = sideOf(i);
    const Vec3 home_W = object.place_W + Vec3(side.sign * beside, 0, kHomeAbove);
    scene.homes_W[static_cast<std::size_t>(i)] = home_W;
    scene.q_DF[static_cast<std::size_t>(i)] = side.q_DF;
    FingerMount mount;
    mount.X_WD = {side.q_WD, home_W};
    mount.display_tactile = spec.condition == PickupCondition::kCldForce;
    scene.model.mounts.push_back(mount);
    fingers.push_back(fingerModel(options, i));
  }
  scene.model.grasp = grasp::buildGrasp(pickupWorld(options, object.shape, spec.mu_s, spec.mu_d), fingers);
  scene.starts = {{}, {object.rest_X_WB, Vec3::Zero(), Vec3::Zero()}};
  scene.cues = cuesOf(options, object, scene, spec.seed);
  return scene;
}

TickState makePickupState(const PickupScene& scene) {
  TickState state;
  state.grasp = grasp::makeState(scene.model.grasp, scene.starts, {scene.homes_W.begin(), scene.homes_W.end()});
  state.mounts.resize(scene.model.mounts.size());
  if (scene.model.passivity.on) state.passivity = grasp::PassivityState(scene.model.mounts.size());
  for (MountState& mount : state.mounts) devices::arm(mount.gate);
  return state;
}

double clearanceOverDish(const PickupScene& scene, const Pose& X_WB, contact::PatchCache& patches) {
  const auto& bodies = scene.model.grasp.world.bodies;
  contact::PairPoints points;
  contact::collideShapes(bodies[kObjectBody].shape, X_WB, bodies[kDishBody].shape, Pose(), kFarthest, patches, points);
  double clearance = kFarthest;
  for (int i = 0; i < points.count; ++i) clearance = std::min(clearance, points.points[static_cast<std::size_t>(i)].phi);
  return clearance;
}

}  // namespace pincer::tasks
