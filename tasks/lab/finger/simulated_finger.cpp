#include "pincer/tasks/lab/finger/simulated_finger.h"

namespace pincer::tasks {
namespace {

devices::SimArmSettings fingerArm(const FingerPlace& place) {
  devices::SimArmSettings settings;
  settings.serial = "index";
  settings.start_D = place.X_WD.inverse() * place.start_W;
  return settings;
}

}  // namespace

devices::SimOneDofCld simulatedDisplay(double finger_radius) {
  devices::SimOneDofCldSettings settings;
  settings.serial = "index";
  settings.map.finger_diameter = 2 * finger_radius;
  return devices::SimOneDofCld(settings);
}

SimulatedFinger::SimulatedFinger(const FingerPlace& place, OneFingerObserver& observer)
    : q_WD_(place.X_WD.q),
      observer_(observer),
      arm_(fingerArm(place)),
      display_(simulatedDisplay(place.finger_radius)) {
  wear_.arm = arm_.capabilities();
  // The hand is on the arm before the first tick.
  const OneFingerAction action = observer_.act({arm_.sample(), Vec3::Zero(), display_.sample()}, 0, Cue::kNone);
  arm_.setHand(action.pull);
  if (action.q_WF) arm_.setGimbal(q_WD_.conjugate() * *action.q_WF);
}

void SimulatedFinger::advanceTo(double now) {
  const double dt = now - now_;
  if (!(dt > 0)) return;
  now_ = now;
  arm_.advance(dt);
  display_.advance(dt);
}

const FingerInputs& SimulatedFinger::sample() {
  inputs_ = {arm_.sample(), display_.sample()};
  return inputs_;
}

FingerDeed SimulatedFinger::apply(const FingerOutputs& outputs, Cue cue, double now) {
  arm_.commandForce(outputs.f_D);
  display_.command(outputs.tactile);
  const OneFingerAction action = observer_.act({inputs_.arm, outputs.f_D, inputs_.tactile}, now, cue);
  arm_.setHand(action.pull);
  tactor_place_ = display_.trueRoller();
  if (action.q_WF) {
    arm_.setGimbal(q_WD_.conjugate() * *action.q_WF);
  } else if (action.pitch != 0) {
    arm_.setGimbal(q_WD_.conjugate() * quatFromRotationVector(action.pitch * Vec3::UnitX()));
  }
  return {action, 0};
}

}  // namespace pincer::tasks
