#include "pincer/tasks/lab/experiments/hand_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "pincer/contact/error.h"

namespace pincer::tasks {
namespace {

constexpr double kHomeBeside = 0.045;             // a waiting fingertip is so far beside the object [m]
constexpr double kFacing = std::numbers::pi / 6;  // so far may an arm look past the other [rad]
constexpr double kHomeAbove = 0.040;              // and above the pinch place [m]

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

grasp::FingerModel fingerModel(const HandSetup& setup, int finger) {
  grasp::FingerModel model;
  model.name = finger == 0 ? "index" : "thumb";
  model.radius = setup.finger_radius;
  model.coupling.stiffness.setConstant(setup.coupling_stiffness);
  model.coupling.damping.setConstant(setup.coupling_damping);
  model.coupling.twist_stiffness = setup.twist_stiffness;
  model.coupling.twist_damping = setup.twist_damping;
  return model;
}

FingerCue fingerCue(const grasp::FingerModel& finger, const Pose& X_WD, const Vec3& home_W) {
  return {X_WD.q,
          X_WD.p,
          home_W,
          finger.radius,
          finger.pad_normal_F,
          finger.distal_F,
          finger.pad_normal_F.cross(finger.distal_F)};
}

void requireFacing(const HandScene& scene, std::size_t i, const ArmBase& base) {
  const Pose &own = scene.model.mounts[i].X_WD, &other = scene.model.mounts[1 - i].X_WD;
  const Vec3 there_W = (other.p - own.p).normalized(), ahead_W = own.q * Vec3::UnitZ();
  const double off = math::acos(std::clamp(ahead_W.dot(there_W), -1.0, 1.0));
  if (off <= kFacing) return;
  throw InputError(
      fmt::format("calibration: the {} finger's arm doesn't face the other: with base_x, base_y, base_z = {:g}, {:g}, "
                  "{:g} m and base_turn "
                  "= {:g} rad it "
                  "looks {:.0f} degrees past it. At most {:.0f}: measure the bases again (docs/devices/setup.md).",
                  i == 0 ? "index" : "thumb", base.offset_W.x(), base.offset_W.y(), base.offset_W.z(), base.turn,
                  off * 180 / std::numbers::pi, kFacing * 180 / std::numbers::pi));
}

}  // namespace

HandScene makeHandScene(const HandSetup& setup, engine::WorldBuilder world, std::vector<engine::BodyStart> starts,
                        const Vec3& place_W, double half_width, bool display_tactile) {
  HandScene scene;
  std::vector<grasp::FingerModel> fingers;
  const double beside = half_width + setup.finger_radius + kHomeBeside;
  for (int i = 0; i < kHandFingers; ++i) {
    const Side side = sideOf(i);
    const Vec3 home_W = place_W + Vec3(side.sign * beside, 0, kHomeAbove);
    scene.homes_W[static_cast<std::size_t>(i)] = home_W;
    scene.q_DF[static_cast<std::size_t>(i)] = side.q_DF;
    FingerMount mount;
    mount.X_WD = {side.q_WD, home_W};
    mount.display_tactile = display_tactile;
    scene.model.mounts.push_back(mount);
    fingers.push_back(fingerModel(setup, i));
    scene.cues.fingers[static_cast<std::size_t>(i)] = fingerCue(fingers.back(), mount.X_WD, home_W);
  }
  scene.model.grasp = grasp::buildGrasp(std::move(world), fingers);
  scene.starts = std::move(starts);
  scene.cues.place_W = place_W;
  scene.cues.surface_stiffness = setup.coupling_stiffness;
  scene.cues.half_width = half_width;
  return scene;
}

void standArms(HandScene& scene, const std::array<ArmBase, kHandFingers>& bases) {
  for (std::size_t i = 0; i < bases.size(); ++i) {
    Pose& X_WD = scene.model.mounts[i].X_WD;
    const Quat turned = quatFromRotationVector({0, 0, bases[i].turn}) * X_WD.q;
    scene.q_DF[i] = turned.conjugate() * X_WD.q * scene.q_DF[i];
    X_WD = {turned, X_WD.p + bases[i].offset_W};
  }
  for (std::size_t i = 0; i < bases.size(); ++i) requireFacing(scene, i, bases[i]);
}

TickState makeHandState(const HandScene& scene) {
  TickState state;
  state.grasp = grasp::makeState(scene.model.grasp, scene.starts, {scene.homes_W.begin(), scene.homes_W.end()});
  state.mounts.resize(scene.model.mounts.size());
  if (scene.model.passivity.on) state.passivity = grasp::PassivityState(scene.model.mounts.size());
  for (MountState& mount : state.mounts) devices::arm(mount.gate);
  return state;
}

}  // namespace pincer::tasks
