#include "pincer/tasks/lab/experiments/shape_trial.h"

#include <algorithm>
#include <cmath>

#include "pincer/tasks/run/measure/timing.h"

namespace pincer::tasks {
namespace {

constexpr double kExploringMoves = 5e-3, kExploringTactor = 1e-3;  // slower, finger and tactor rest [m/s]
constexpr std::int64_t kExploringTicks = 20;                       // over which the tactor's speed is taken

constexpr double kWaitAbove = 1;  // until the tone [s]

// The solid stands where the arm reaches over it and to both ends: its middle 20 mm below the arm's reset place.
Pose shapeArmBase() {
  Mat3 R;
  R << 1, 0, 0, 0, 0, -1, 0, 1, 0;
  const Quat q_WD(R);
  return {q_WD, Vec3(0, 0, 0.02)};
}

ShapeCues shapeCues(const ShapeTrialSetup& setup) {
  const Pose X_WD = shapeArmBase();
  return {setup.seed, X_WD.q, X_WD.p, Vec3::Zero(), setup.finger_radius, setup.tactor_reach};
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

Vec3 homeOf(const ShapeLimits& limits) { return limits.distance * Vec3::UnitZ(); }

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

devices::SimOneDofCldSettings shapeDisplay(const ShapeTrialSetup& setup) {
  devices::SimOneDofCldSettings settings;
  settings.serial = "index";
  settings.map.finger_diameter = 2 * setup.finger_radius;
  return settings;
}

}  // namespace

// Places on the pad are azimuthal about its middle: the direction of the contact from the finger's centre, and that one's angle fore-aft.
devices::TactileCommand onRoller(const devices::TactileCommand& command, double r, double reach) {
  const double way = command.place_L.norm();
  if (command.parked || !(way > 0)) return {command.parked, Vec2::Zero()};
  const auto [sine, cosine] = math::sinCos(way / r);
  const double angle = math::atan2(sine * command.place_L.x() / way, cosine);
  return {false, {std::clamp(r * angle, -reach, reach), 0}};
}

ShapeTrial::ShapeTrial(const ShapeTrialSetup& setup, ShapeExplorer& explorer, StudySink& sink)
    : setup_(setup),
      explorer_(explorer),
      sink_(sink),
      model_(shapeModel(setup)),
      state_(shapeState(model_)),
      scratch_(model_),
      arm_(shapeArm()),
      display_(shapeDisplay(setup)),
      inputs_(1) {
  model_.mounts[0].gate = devices::within(model_.mounts[0].gate, arm_.capabilities());
  explorer_.begin(shapeCues(setup));
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
  const bool kept = ticks_ % setup_.stride == 0;
  const double start = kept ? steadySeconds() : 0;
  if (cut_) devices::trip(state_.mounts[0].gate, devices::Trip::kMissedDeadline);
  inputs_[0] = {arm_.sample(), display_.sample()};
  const engine::StepReport report = tasks::tick(model_, state_, scratch_, inputs_, now);
  arm_.commandForce(scratch_.outputs[0].f_D);
  display_.command(onRoller(scratch_.outputs[0].tactile, setup_.finger_radius, setup_.tactor_reach));
  const double took = kept ? steadySeconds() - start : 0;
  if (stage_ == Stage::kFeel || stage_ == Stage::kAnswer) count(dt);
  const ShapeAction action = explorer_.act({inputs_[0].arm, scratch_.outputs[0].f_D, inputs_[0].tactile}, now, cue_);
  arm_.setHand(action.finger.pull);
  arm_.setGimbal(model_.mounts[0].X_WD.q.conjugate() * action.q_WF);
  advance(action, now);
  ++ticks_;
  if (kept) record(now, took, report.status);
  return stage_ != Stage::kOver;
}

void ShapeTrial::advance(const ShapeAction& action, double now) {
  cue_ = Cue::kNone;
  const devices::GateState& gate = state_.mounts[0].gate;
  if (gate.trip != devices::Trip::kNone || now > setup_.timeout) {
    outcome_ = gate.trip != devices::Trip::kNone ? "fault" : "timeout";
    stage_ = Stage::kOver;
  } else if (stage_ == Stage::kPrepare && now >= std::max(kWaitAbove, model_.mounts[0].gate.ramp_time)) {
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
  has_touched_ = has_touched_ || scratch_.fingers[0].touching;
  if (!has_touched_) return;
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
  const double way = std::abs(tactile.place_L->x() - tactor_mark_.value_or(tactile.place_L->x()));
  if (way > kExploringTactor * time) {
    tactor_way_ += way;
    tactor_time_ += time;
  }
  tactor_mark_ = tactile.place_L->x();
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
  const devices::TactileCommand wanted = onRoller(scratch_.outputs[0].tactile, setup_.finger_radius, setup_.tactor_reach);
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
