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

SimulatedDisplay::SimulatedDisplay(const FingerPlace& place) {
  if (!place.one_dof) {
    two_dof_.emplace();
    return;
  }
  devices::SimOneDofCldSettings settings;
  settings.serial = "index";
  settings.map.finger_diameter = 2 * place.finger_radius;
  one_dof_.emplace(settings);
}

void SimulatedDisplay::advance(double dt) { one_dof_ ? one_dof_->advance(dt) : two_dof_->advance(dt); }
devices::TactileSample SimulatedDisplay::sample() { return one_dof_ ? one_dof_->sample() : two_dof_->sample(); }
void SimulatedDisplay::command(const devices::TactileCommand& command) {
  one_dof_ ? one_dof_->command(command) : two_dof_->command(command);
}
void SimulatedDisplay::setTransmission(const devices::VirtualTransmission& transmission) {
  if (one_dof_) one_dof_->setTransmission(transmission);
}
const devices::TactileCapabilities& SimulatedDisplay::capabilities() const {
  return one_dof_ ? one_dof_->capabilities() : two_dof_->capabilities();
}
double SimulatedDisplay::truePlace() {
  if (one_dof_) return one_dof_->trueRoller();
  return two_dof_->sample().place_L.value_or(Vec2::Zero()).x();
}

SimulatedFinger::SimulatedFinger(const FingerPlace& place, OneFingerObserver& observer)
    : q_WD_(place.X_WD.q), observer_(observer), arm_(fingerArm(place)), display_(place) {
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
  tactor_place_ = display_.truePlace();
  if (action.q_WF) {
    arm_.setGimbal(q_WD_.conjugate() * *action.q_WF);
  } else if (action.pitch != 0) {
    arm_.setGimbal(q_WD_.conjugate() * quatFromRotationVector(action.pitch * Vec3::UnitX()));
  }
  return {action, 0};
}

}  // namespace pincer::tasks
