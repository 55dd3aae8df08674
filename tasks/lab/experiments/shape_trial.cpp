#include "pincer/tasks/lab/experiments/shape_trial.h"

#include <algorithm>
#include <cmath>

#include "pincer/tasks/lab/finger/finger_records.h"

namespace pincer::tasks {
namespace {

// The solid stands where the arm reaches over it and to both ends: its middle 20 mm below the arm's reset place.
Pose shapeArmBase() {
  Mat3 R;
  R << 1, 0, 0, 0, 0, -1, 0, 1, 0;
  return {Quat(R), Vec3(0, 0, 0.02)};
}

TickModel shapeModel(const ShapeTrialSetup& setup, const FingerWear& wear) {
  engine::WorldBuilder builder{engine::WorldOptions{}};
  builder.addBody({"solid", contact::Mesh{setup.solid}, false, 0, {setup.friction, setup.friction, 0, 0}});
  grasp::FingerModel finger;
  finger.name = "index";
  finger.radius = setup.finger_radius;
  finger.coupling.stiffness.setConstant(setup.stiffness);
  finger.coupling.damping.setConstant(setup.damping);
  TickModel model;
  model.grasp = grasp::buildGrasp(std::move(builder), {finger});
  FingerMount mount;
  mount.X_WD = movedBase(shapeArmBase(), wear.base);
  mount.display_tactile = setup.display_tactile;
  mount.gate = devices::within(mount.gate, wear.arm);
  if (wear.oldest_sample) mount.gate.watchdog_time = *wear.oldest_sample;
  model.mounts.push_back(mount);
  model.passivity.on = wear.has_motors;
  model.passivity.arms = {{wear.arm.tip_mass.value_or(grasp::ArmPort{}.mass), wear.arm.tip_damping}};
  return model;
}

Vec3 homeOf(const ShapeLimits& limits) { return limits.distance * Vec3::UnitZ(); }

TickState shapeState(const TickModel& model) {
  TickState state;
  state.grasp = grasp::makeState(model.grasp, {{}}, {homeOf({})});
  state.mounts.resize(1);
  if (model.passivity.on) state.passivity = grasp::PassivityState(1);
  devices::arm(state.mounts[0].gate);
  return state;
}

std::array<double, 3> tripleIn(const Vec3& v) { return {v.x(), v.y(), v.z()}; }

}  // namespace

// Places on the pad are azimuthal about its middle: the direction of the contact from the
// finger's centre, and that one's angle fore-aft.
devices::TactileCommand onRoller(const devices::TactileCommand& command, double r, double reach) {
  const double way = command.place_L.norm();
  if (command.parked || !(way > 0)) return {command.parked, Vec2::Zero()};
  const auto [sine, cosine] = math::sinCos(way / r);
  const double angle = math::atan2(sine * command.place_L.x() / way, cosine);
  return {false, {std::clamp(r * angle, -reach, reach), 0}};
}

FingerPlace shapePlace(const ShapeTrialSetup& setup) {
  Mat3 R_WF;  // a person's finger points away, its pad down, where no gimbal tells more
  R_WF << 0, -1, 0, 1, 0, 0, 0, 0, 1;
  return {shapeArmBase(), homeOf({}), setup.finger_radius, Quat(R_WF)};
}

ShapeCues shapeCues(const ShapeTrialSetup& setup, std::uint64_t seed) {
  const Pose X_WD = shapeArmBase();
  return {seed, X_WD.q, X_WD.p, Vec3::Zero(), setup.finger_radius, setup.tactor_reach};
}

ShapeTrial::ShapeTrial(const ShapeTrialSetup& setup, WornFinger& finger, StudySink& sink)
    : FingerTrial(setup.asked, finger, sink),
      finger_radius_(setup.finger_radius),
      tactor_reach_(setup.tactor_reach),
      model_(shapeModel(setup, finger.wear())),
      state_(shapeState(model_)),
      scratch_(model_),
      samples_(1) {}

FingerOutputs ShapeTrial::step(const FingerInputs& inputs, double now, double) {
  samples_[0] = inputs;
  status_ = tasks::tick(model_, state_, scratch_, samples_, now).status;
  return {scratch_.outputs[0].f_D, onRoller(scratch_.outputs[0].tactile, finger_radius_, tactor_reach_)};
}

FingerTrial::Felt ShapeTrial::felt() const {
  const grasp::FingerReport& finger = scratch_.fingers[0];
  return {finger.touching, finger.gap, state_.mounts[0].v_WF.norm()};
}

void ShapeTrial::fill(SampleRecord& sample) const {
  const grasp::FingerReport& felt = scratch_.fingers[0];
  FingerRecord& finger = sample.fingers[0];
  finger.p_WF = tripleIn(state_.mounts[0].p_WF);
  finger.p_WP = tripleIn(state_.grasp.world.points[0].p_W);
  finger.f_contact_W = tripleIn(felt.f_contact_W);
  finger.normal_force = felt.normal_force;
  finger.tangential_force = felt.tangential_force;
  finger.gap = felt.gap;
  fillFinger(finger);
  if (felt.sliding) finger.flags |= kSliding;
  sample.status = status_;
}

void ShapeTrial::fill(Snapshot& snapshot) const {
  captureGrasp(model_.grasp, state_.grasp, *scratch_.grasp, {}, snapshot);
  snapshot.fingers[0].q_WF = scratch_.inputs[0].q_WF;
  fillMount(snapshot.fingers[0]);
}

}  // namespace pincer::tasks
