#include "pincer/tasks/lab/experiments/shape_trial.h"

#include <cmath>

#include "pincer/tasks/run/measure/timing.h"

namespace pincer::tasks {
namespace {

constexpr double kExploringMoves = 5e-3, kExploringTactor = 1e-3;  // slower, finger and tactor rest [m/s]
constexpr std::int64_t kExploringTicks = 20;                       // over which the tactor's speed is taken

// The solid stands where the arm reaches all round it: its middle 20 mm up and 20 mm towards the operator of the arm's reset place.
Pose shapeArmBase() {
  Mat3 R;
  R << 1, 0, 0, 0, 0, -1, 0, 1, 0;
  const Quat q_WD(R);
  return {q_WD, -(q_WD * Vec3(0, 0.02, 0.02))};
}

ShapeCues shapeCues(const ShapeTrialSetup& setup, const devices::TactileDisplay& display) {
  const Pose X_WD = shapeArmBase();
  return {setup.seed, X_WD.q, X_WD.p, Vec3::Zero(), setup.finger_radius, display.capabilities().reach.minCoeff()};
}

TickModel shapeModel(const ShapeTrialSetup& setup) {
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
  mount.X_WD = shapeArmBase();
  mount.display_tactile = setup.display_tactile;
  model.mounts.push_back(mount);
  return model;
}

Vec3 homeOf(const ShapeLimits& limits) { return limits.distance * Vec3::UnitX(); }

TickState shapeState(const TickModel& model) {
  TickState state;
  state.grasp = grasp::makeState(model.grasp, {{}}, {homeOf({})});
  state.mounts.resize(1);
  devices::arm(state.mounts[0].gate);
  return state;
}

devices::SimArmSettings shapeArm() {
  devices::SimArmSettings settings;
  settings.serial = "index";
  settings.start_D = shapeArmBase().inverse() * homeOf({});
  return settings;
}

}  // namespace

ShapeTrial::ShapeTrial(const ShapeTrialSetup& setup, ShapeExplorer& explorer, StudySink& sink)
    : setup_(setup),
      explorer_(explorer),
      sink_(sink),
      model_(shapeModel(setup)),
      state_(shapeState(model_)),
      scratch_(model_),
      arm_(shapeArm()),
      inputs_(1) {
  model_.mounts[0].gate = devices::within(model_.mounts[0].gate, arm_.capabilities());
  explorer_.begin(shapeCues(setup, display_));
  const ShapeAction action = explorer_.act({arm_.sample(), Vec3::Zero(), display_.sample()}, 0, Cue::kNone);
  arm_.setHand(action.finger.pull);
  arm_.setGimbal(model_.mounts[0].X_WD.q.conjugate() * action.q_WF);
}

bool ShapeTrial::tick(double now) {
  const double dt = now > now_ ? now - now_ : 1e-3;
  if (now > now_) {
    arm_.advance(dt);
    display_.advance(dt);
  }
  now_ = now;
  const double start = steadySeconds();
  if (cut_) devices::trip(state_.mounts[0].gate, devices::Trip::kMissedDeadline);
  inputs_[0] = {arm_.sample(), display_.sample()};
  const engine::StepReport report = tasks::tick(model_, state_, scratch_, inputs_, now);
  arm_.commandForce(scratch_.outputs[0].f_D);
  display_.command(scratch_.outputs[0].tactile);
  const double took = steadySeconds() - start;
  if (stage_ == Stage::kFeel) count(dt);
  const ShapeAction action = explorer_.act({inputs_[0].arm, scratch_.outputs[0].f_D, inputs_[0].tactile}, now, cue_);
  arm_.setHand(action.finger.pull);
  arm_.setGimbal(model_.mounts[0].X_WD.q.conjugate() * action.q_WF);
  advance(action, now);
  if (ticks_++ % setup_.stride == 0) record(now, took, report.status);
  return stage_ != Stage::kOver;
}

void ShapeTrial::advance(const ShapeAction& action, double now) {
  cue_ = Cue::kNone;
  const devices::GateState& gate = state_.mounts[0].gate;
  if (gate.trip != devices::Trip::kNone || now > setup_.timeout) {
    outcome_ = gate.trip != devices::Trip::kNone ? "fault" : "timeout";
    stage_ = Stage::kOver;
  } else if (stage_ == Stage::kPrepare && now >= model_.mounts[0].gate.ramp_time) {
    stage_ = Stage::kFeel;
    cue_ = Cue::kStart;
  } else if (stage_ == Stage::kFeel && action.finger.interval_over) {
    stage_ = Stage::kAnswer;
    entered_ = now;
  } else if (stage_ == Stage::kAnswer && action.finger.answered) {
    answered_ = true;
    answered_after_ = now - entered_;
    outcome_ = "answered";
    stage_ = Stage::kOver;
  }
}

void ShapeTrial::count(double dt) {
  shown_time_ += dt;
  if (!scratch_.fingers[0].touching) return;
  contact_time_ += dt;
  const double speed = state_.mounts[0].v_WF.norm();
  if (speed > kExploringMoves) {
    finger_way_ += speed * dt;
    finger_time_ += dt;
  }
  const devices::TactileSample& tactile = inputs_[0].tactile;
  if (ticks_ % kExploringTicks != 0 || !tactile.valid || !tactile.place_L) return;
  const double time = static_cast<double>(kExploringTicks) * dt;
  const double way = (*tactile.place_L - tactor_mark_.value_or(*tactile.place_L)).norm();
  if (way > kExploringTactor * time) {
    tactor_way_ += way;
    tactor_time_ += time;
  }
  tactor_mark_ = *tactile.place_L;
}

void ShapeTrial::record(double now, double took, std::uint32_t status) {
  const auto array = [](const Vec3& v) { return std::array<double, 3>{v.x(), v.y(), v.z()}; };
  const grasp::FingerReport& felt = scratch_.fingers[0];
  SampleRecord sample;
  sample.trial = setup_.trial;
  sample.tick = ticks_ - 1;
  sample.time = now;
  sample.tick_us = 1e6 * took;
  sample.q_WB = {1, 0, 0, 0};
  sample.status = status;
  FingerRecord& finger = sample.fingers[0];
  finger.p_WF = array(state_.mounts[0].p_WF);
  finger.p_WP = array(state_.grasp.world.points[0].p_W);
  finger.f_contact_W = array(felt.f_contact_W);
  finger.f_arm_D = array(scratch_.outputs[0].f_D);
  finger.normal_force = felt.normal_force;
  finger.tangential_force = felt.tangential_force;
  finger.gap = felt.gap;
  const devices::TactileCommand& wanted = scratch_.outputs[0].tactile;
  finger.place_wanted_L = {wanted.place_L.x(), wanted.place_L.y()};
  finger.place_shown_L = {std::nan(""), std::nan("")};
  const devices::TactileSample& tactile = inputs_[0].tactile;
  if (tactile.valid && tactile.place_L) finger.place_shown_L = {tactile.place_L->x(), tactile.place_L->y()};
  finger.flags = (felt.touching ? 1 : 0) | (felt.sliding ? 2 : 0) | (state_.mounts[0].gate.trip != devices::Trip::kNone ? 4 : 0) |
                 (wanted.parked ? 8 : 0);
  sink_.sample(sample);
}

void ShapeTrial::measure(ResponseRecord& r) const {
  r.outcome = outcome_;
  r.duration = shown_time_;
  r.response_time = answered_after_;
  r.contact_share = shown_time_ > 0 ? contact_time_ / shown_time_ : 0;
  r.finger_speed = finger_way_ / finger_time_;  // NaN of nothing
  r.tactor_speed = tactor_way_ / tactor_time_;
}

}  // namespace pincer::tasks
