#include "pincer/tasks/lab/experiments/arc_trial.h"

#include <cmath>

#include "pincer/tasks/run/measure/timing.h"

namespace pincer::tasks {
namespace {

constexpr double kArcPause = 0.5;          // between the intervals [s]
constexpr double kFingerMoves = 5e-3;      // slower, it rests [m/s]
constexpr double kTactorMoves = 1e-3;      // likewise [m/s]
constexpr double kFreesTactor = 0.010;     // so far up the finger frees a frozen tactor [m]
constexpr std::int64_t kTactorTicks = 20;  // over which its speed is taken: one count of the encoder is then 0.04 mm/s

devices::SimArmSettings arcArm(const ArcTrialSetup& setup) {
  devices::SimArmSettings settings;
  settings.serial = "index";
  const Vec3 start_W = (setup.path_radius + 0.01) * Vec3(0, math::sin(setup.start_angle), math::cos(setup.start_angle));
  settings.start_D = arcArmBase(setup.path_radius).inverse() * start_W;
  return settings;
}

devices::SimOneDofCldSettings arcDisplay(const ArcTrialSetup& setup) {
  devices::SimOneDofCldSettings settings;
  settings.serial = "index";
  settings.map.finger_diameter = 2 * setup.finger_radius;
  return settings;
}

}  // namespace

// D: x right, y up, z towards the operator.
Pose arcArmBase(double path_radius) {
  Mat3 R;
  R << 1, 0, 0, 0, 0, -1, 0, 1, 0;
  return {Quat(R), Vec3(0, 0, path_radius)};
}

ArcTrial::ArcTrial(const ArcTrialSetup& setup, OneFingerObserver& observer, StudySink& sink)
    : setup_(setup), observer_(observer), sink_(sink), arm_(arcArm(setup)), display_(arcDisplay(setup)) {
  entered_places_.reserve(setup.intervals.size());
  model_.X_WD = arcArmBase(setup.path_radius);
  model_.finger_radius = setup.finger_radius;
  model_.stiffness = setup.stiffness;
  model_.gate = devices::within(model_.gate, arm_.capabilities());
  devices::arm(state_.gate);
  display_.setTransmission(interval().transmission);
  // The hand is on the arm before the first tick.
  arm_.setHand(observer_.act({arm_.sample(), Vec3::Zero(), display_.sample()}, 0, Cue::kNone).pull);
}

bool ArcTrial::tick(double now) {
  const double dt = now > now_ ? now - now_ : 1e-3;
  if (now > now_) {
    arm_.advance(dt);
    display_.advance(dt);
  }
  now_ = now;
  const bool kept = ticks_ % setup_.stride == 0;  // reading the clock takes as long as the display's tick
  const double start = kept ? steadySeconds() : 0;
  if (cut_) devices::trip(state_.gate, devices::Trip::kMissedDeadline);
  const devices::ArmSample arm = arm_.sample();
  const devices::TactileSample tactile = display_.sample();
  out_ = planarTick(model_, interval().shown, state_, arm, now, dt);
  freezeFrontEnd();
  arm_.commandForce(out_.f_D);
  display_.command(out_.tactile);
  const double took = kept ? steadySeconds() - start : 0;
  if (stage_ == Stage::kInterval) count(tactile, dt);
  const OneFingerAction action = observer_.act({arm, out_.f_D, tactile}, now, cue_);
  arm_.setHand(action.pull);
  if (action.enters && entered_places_.size() < setup_.intervals.size()) entered_places_.push_back(display_.trueRoller());
  if (action.pitch != 0) arm_.setGimbal(model_.X_WD.q.conjugate() * quatFromRotationVector(action.pitch * Vec3::UnitX()));
  advance(action, now);
  ++ticks_;
  if (kept) record(tactile, now, took);
  return stage_ != Stage::kOver;
}

void ArcTrial::advance(const OneFingerAction& action, double now) {
  cue_ = Cue::kNone;
  if (state_.gate.trip != devices::Trip::kNone) return end("fault");
  if (now > setup_.timeout) return end("timeout");
  if (stage_ == Stage::kPrepare ? now >= model_.gate.ramp_time : stage_ == Stage::kPause && now >= entered_ + kArcPause) {
    stage_ = Stage::kInterval;
    entered_ = now;
    cue_ = Cue::kStart;
  } else if (stage_ == Stage::kInterval && action.interval_over) {
    const bool last = shown_ + 1 == static_cast<int>(setup_.intervals.size());
    stage_ = last ? Stage::kAnswer : Stage::kPause;
    entered_ = now;
    if (last) return;
    ++shown_;
    display_.setTransmission(interval().transmission);
    state_.force_tracker = state_.tactile_tracker = {};
  } else if (stage_ == Stage::kAnswer && action.answered) {
    answered_ = true;
    answered_after_ = now - entered_;
    end("answered");
  }
}

// Holds the place wanted, which the display's FIFO delays: so the place displayed freezes at the same place, that much later.
void ArcTrial::freezeFrontEnd() {
  if (setup_.freeze_share >= 1) return;
  const double reach = interval().shown.largest_place, place = out_.tactile.place_L.x();
  if (out_.contact.phi > kFreesTactor) side_ = 0;
  if (side_ == 0) frozen_ = false;
  if (side_ == 0 && out_.contact.phi <= 0) side_ = place < 0 ? -1 : 1;
  const double held = side_ * reach * (1 - 2 * setup_.freeze_share);
  frozen_ = frozen_ || (side_ != 0 && side_ * (place - held) <= 0);
  if (frozen_) out_.tactile.place_L.x() = held;
}

void ArcTrial::end(const char* outcome) {
  outcome_ = outcome;
  stage_ = Stage::kOver;
}

void ArcTrial::count(const devices::TactileSample& tactile, double dt) {
  shown_time_ += dt;
  const double speed = state_.v_WF.norm();
  if (out_.contact.phi <= 0) {
    contact_time_ += dt;
    if (speed > kFingerMoves) {
      finger_way_ += speed * dt;
      finger_time_ += dt;
    }
  }
  if (ticks_ % kTactorTicks != 0 || !tactile.valid || !tactile.place_L) return;
  const double place = tactile.place_L->x(), time = static_cast<double>(kTactorTicks) * dt;
  const double way = std::abs(place - tactor_mark_.value_or(place));
  if (out_.contact.phi <= 0 && way > kTactorMoves * time) {
    tactor_way_ += way;
    tactor_time_ += time;
  }
  tactor_mark_ = place;
}

void ArcTrial::record(const devices::TactileSample& tactile, double now, double took) {
  SampleRecord sample;
  sample.trial = setup_.trial;
  sample.tick = ticks_ - 1;
  sample.time = now;
  sample.tick_us = 1e6 * took;
  sample.q_WB = {1, 0, 0, 0};
  FingerRecord& finger = sample.fingers[0];
  const Vec3 n_W(0, out_.contact.n_B.x(), out_.contact.n_B.y());
  const Vec3 p_WP(0, out_.contact.p_BS.x(), out_.contact.p_BS.y());
  finger.p_WF = {state_.p_WF.x(), state_.p_WF.y(), state_.p_WF.z()};
  const Vec3 proxy_W = p_WP + setup_.finger_radius * n_W;
  finger.p_WP = {proxy_W.x(), proxy_W.y(), proxy_W.z()};
  finger.f_contact_W = {out_.f_W.x(), out_.f_W.y(), out_.f_W.z()};
  finger.f_arm_D = {out_.f_D.x(), out_.f_D.y(), out_.f_D.z()};
  finger.normal_force = out_.normal_force;
  finger.gap = out_.contact.phi;
  finger.place_wanted_L = {out_.tactile.place_L.x(), out_.tactile.place_L.y()};
  finger.place_shown_L = {std::nan(""), std::nan("")};
  if (tactile.valid && tactile.place_L) finger.place_shown_L = {tactile.place_L->x(), tactile.place_L->y()};
  finger.flags = (out_.contact.phi <= 0 ? 1 : 0) | (state_.gate.trip != devices::Trip::kNone ? 4 : 0) | (out_.tactile.parked ? 8 : 0);
  sink_.sample(sample);
}

void ArcTrial::measure(ResponseRecord& r) const {
  r.outcome = outcome_;
  r.duration = shown_time_;
  r.response_time = answered_after_;
  r.contact_share = shown_time_ > 0 ? contact_time_ / shown_time_ : 0;
  r.finger_speed = finger_way_ / finger_time_;  // NaN of nothing
  r.tactor_speed = tactor_way_ / tactor_time_;
}

}  // namespace pincer::tasks
