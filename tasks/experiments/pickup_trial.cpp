#include "tasks/experiments/pickup_trial.h"

#include <algorithm>
#include <chrono>

#include "engine/world/state.h"
#include "tasks/experiments/pickup_records.h"

namespace pincer::tasks {
namespace {

constexpr double kAtRest = 1e-3;       // the object lies still under this speed [m/s]
constexpr double kPrepareLimit = 10;   // the start tone comes then at the latest [s]
constexpr double kGoHomeTime = 2;      // [s]
constexpr std::size_t kEvents = 4096;  // more than any trial of 60 s has; further ones are dropped rather than allocated in the tick

PickupRules rulesOf(const SpherePickupOptions& options) {
  PickupRules rules;
  rules.success_height = options.success_height;
  rules.hold_time = options.hold_time;
  rules.timeout = options.timeout;
  return rules;
}

}  // namespace

PickupTrial::PickupTrial(const SpherePickupOptions& options, const PickupObject& object, const PickupTrialSpec& spec, RecordSink& sink)
    : spec_(spec),
      smallest_grip_(options.mass * 9.81 / (2 * spec.mu_s)),
      sink_(sink),
      scene_(makePickupScene(options, object, spec)),
      state_(makePickupState(scene_)),
      scratch_(scene_.model),
      judge_(rulesOf(options)) {
  events_.reserve(kEvents);
}

bool PickupTrial::step(const std::vector<FingerInputs>& samples, PickupPhase phase, bool wants_lift, double now) {
  cue_ = Cue::kNone;
  if (phase != phase_) note(now, "phase", nameOf(phase));
  phase_ = phase;
  const engine::StepReport report = timedTick(samples, now);
  if (stage_ != Stage::kOver && !faulted(now, report.status)) {
    if (stage_ == Stage::kPrepare)
      prepare(now);
    else if (stage_ == Stage::kRun)
      run(wants_lift, now);
    else if (now >= stop_ + kGoHomeTime)
      stage_ = Stage::kOver;
  }
  record(samples, now, report.status);
  ++tick_;
  return stage_ != Stage::kOver;
}

engine::StepReport PickupTrial::timedTick(const std::vector<FingerInputs>& samples, double now) {
  using Clock = std::chrono::steady_clock;
  const auto begin = Clock::now();
  const engine::StepReport report = tick(scene_.model, state_, scratch_, samples, now);
  tick_seconds_ = std::chrono::duration<double>(Clock::now() - begin).count();
  tick_times_.add(tick_seconds_);
  return report;
}

void PickupTrial::prepare(double now) {
  double ramp = 0;
  for (const FingerMount& mount : scene_.model.mounts) ramp = std::max(ramp, mount.gate.ramp_time);
  const bool at_rest = state_.grasp.world.bodies[kObjectBody].v_W.norm() < kAtRest;
  if (now < ramp || (!at_rest && now < kPrepareLimit)) return;
  stage_ = Stage::kRun;
  start_ = stop_ = now;
  cue_ = Cue::kStart;
  note(now, "tone", "start");
}

void PickupTrial::run(bool wants_lift, double now) {
  const PickupCounts before = judge_.counts();
  const PickupVerdict verdict = judge_.observe(view(wants_lift, now));
  noteCounts(before, now);
  stop_ = now;
  if (verdict == PickupVerdict::kSuccess) end("success", Cue::kSuccess, now);
  if (verdict == PickupVerdict::kTimeout) end("timeout", Cue::kEnd, now);
}

bool PickupTrial::faulted(double now, std::uint32_t status) {
  for (const MountState& mount : state_.mounts) {
    if (mount.gate.trip != devices::Trip::kNone) trip_ = mount.gate.trip;
  }
  if (trip_ == devices::Trip::kNone && (status & engine::kStateNotFinite) == 0) return false;
  cutForces(trip_ == devices::Trip::kNone ? devices::Trip::kNotFinite : trip_);
  if (stage_ == Stage::kRun || stage_ == Stage::kPrepare) end("fault", Cue::kEnd, now);
  note(now, "gate_trip");
  stage_ = Stage::kOver;
  return true;
}

void PickupTrial::end(const char* outcome, Cue cue, double now) {
  outcome_ = outcome;
  cue_ = cue;
  note(now, outcome);
  note(now, "tone", cue == Cue::kSuccess ? "success" : "end");
  stage_ = Stage::kGoHome;
}

void PickupTrial::note(double time, const char* kind, const char* detail) {
  if (events_.size() < events_.capacity()) events_.push_back({time, kind, detail});
}

void PickupTrial::noteCounts(const PickupCounts& before, double now) {
  const PickupCounts& after = judge_.counts();
  if (after.squeezes > before.squeezes) note(now, "squeeze");
  if (after.lifts > before.lifts) note(now, "lift");
  if (after.tries_5mm > before.tries_5mm) note(now, "try_5mm");
  if (after.slips > before.slips) note(now, "slip");
  if (after.drops > before.drops) note(now, "drop");
}

PickupView PickupTrial::view(bool wants_lift, double now) {
  PickupView view;
  view.time = now - start_;
  view.wants_lift = wants_lift;
  const engine::WorldState& world = state_.grasp.world;
  const engine::BodyState& object = world.bodies[kObjectBody];
  const Vec3 w_WB = engine::bodyAngularVelocity(scene_.model.grasp.world, world, kObjectBody);
  for (std::size_t i = 0; i < view.fingers.size(); ++i) {
    const grasp::FingerReport& finger = scratch_.grasp.fingers[i];
    const bool on_object = finger.touching && finger.body == kObjectBody;
    const Vec3 v_W = world.points[i].v_W - object.v_W - w_WB.cross(finger.p_WC - object.X_WI.p);
    const double slide_speed = (v_W - v_W.dot(finger.n_W) * finger.n_W).norm();
    view.fingers[i] = {on_object, finger.sliding, on_object ? finger.normal_force : 0, slide_speed, finger.p_WC};
  }
  view.p_WBcm = object.X_WI.p;
  view.clearance = clearanceOverDish(scene_, engine::bodyPose(scene_.model.grasp.world, world, kObjectBody), scratch_.grasp.world.patches);
  return view;
}

void PickupTrial::record(const std::vector<FingerInputs>& samples, double now, std::uint32_t status) {
  SampleRecord sample = sampleRecord(scene_, state_, scratch_, samples);
  sample.trial = spec_.trial;
  sample.tick = tick_;
  sample.time = now;
  sample.tick_us = 1e6 * tick_seconds_;
  sample.status = status;
  sink_.sample(sample);
}

void PickupTrial::cutForces(devices::Trip cause) {
  for (MountState& mount : state_.mounts) devices::trip(mount.gate, cause);
  for (FingerOutputs& output : scratch_.outputs) output.f_D.setZero();
}

void PickupTrial::finish() {
  for (const Event& event : events_) {
    const bool tripped = trip_ != devices::Trip::kNone && std::string(event.kind) == "gate_trip";
    sink_.event({spec_.trial, event.time, event.kind, tripped ? devices::describe(trip_) : event.detail});
  }
  sink_.trial(row());
}

TrialRecord PickupTrial::row() const {
  const PickupCounts& counts = judge_.counts();
  TrialRecord row;
  row.trial = spec_.trial;
  row.participant = spec_.participant;
  row.condition = nameOf(spec_.condition);
  row.index = spec_.index;
  row.mu_s = spec_.mu_s;
  row.mu_d = spec_.mu_d;
  row.outcome = outcome_;
  row.duration = stop_ - start_;
  row.squeezes = counts.squeezes;
  row.lifts = counts.lifts;
  row.tries_5mm = counts.tries_5mm;
  row.slips = counts.slips;
  row.drops = counts.drops;
  row.peak_grip = counts.peak_grip;
  row.grip_ratio = counts.held_grip / smallest_grip_;
  row.offset_at_squeeze = counts.offset_at_squeeze;
  row.tick_us_median = 1e6 * tick_times_.quantile(0.5);
  row.tick_us_p999 = 1e6 * tick_times_.quantile(0.999);
  return row;
}

}  // namespace pincer::tasks
