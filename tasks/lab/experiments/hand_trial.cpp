#include "pincer/tasks/lab/experiments/hand_trial.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>

#include "pincer/engine/state.h"
#include "pincer/tasks/lab/experiments/hand_records.h"

namespace pincer::tasks {
namespace {

constexpr double kAtRest = 1e-3;       // the object lies still under this speed [m/s]
constexpr double kPrepareLimit = 10;   // the start tone comes then at the latest [s]
constexpr double kGoHomeLimit = 5;     // [s]
constexpr double kHomeRadius = 0.015;  // a fingertip this near to its start is there [m]
constexpr double kLeadStiffness = 20;  // of the spring that leads home [N/m]
constexpr double kLeadForce = 0.5;     // its strongest pull [N]
constexpr double kLeadRise = 0.5;      // in which it comes [s]
// more than any trial of 60 s has; further ones are dropped rather than allocated in the tick
constexpr std::size_t kEvents = 4096;
constexpr std::size_t kReadings = 1024;  // likewise

}  // namespace

HandTrial::HandTrial(HandScene scene, TrialHead head, RecordSink& sink)
    : head_(std::move(head)),
      sink_(sink),
      scene_(std::move(scene)),
      state_(makeHandState(scene_)),
      scratch_(scene_.model) {
  events_.reserve(kEvents);
  readings_.reserve(kReadings);
}

bool HandTrial::step(const std::vector<FingerInputs>& samples, const HandIntent& intent, double now) {
  cue_ = Cue::kNone;
  if (stage_ == Stage::kRun) phase_times_[static_cast<std::size_t>(phase_)] += now - last_;
  last_ = now;
  hear(intent);
  const engine::StepReport report = timedTick(samples, now);
  if (stage_ != Stage::kOver && !faulted(report.status)) {
    if (stage_ == Stage::kPrepare)
      prepare(now);
    else if (stage_ == Stage::kRun)
      run(intent, now);
    else if (handIsHome() || now >= stop_ + kGoHomeLimit)
      stage_ = Stage::kOver;
  }
  leadHome();
  record(samples, intent, now, report.status);
  cut_ = devices::Trip::kNone;
  ++tick_;
  return stage_ != Stage::kOver;
}

void HandTrial::hear(const HandIntent& intent) {
  if (intent.phase != phase_) note("phase", nameOf(intent.phase));
  phase_ = intent.phase;
  if (intent.reading && readings_.size() < readings_.capacity())
    readings_.push_back({last_, *intent.reading, truthOf(*intent.reading)});
}

engine::StepReport HandTrial::timedTick(const std::vector<FingerInputs>& samples, double now) {
  using Clock = std::chrono::steady_clock;
  const auto begin = Clock::now();
  const engine::StepReport report = tick(scene_.model, state_, scratch_, samples, now);
  tick_seconds_ = std::chrono::duration<double>(Clock::now() - begin).count();
  tick_times_.add(tick_seconds_);
  return report;
}

void HandTrial::prepare(double now) {
  double ramp = 0;
  for (const FingerMount& mount : scene_.model.mounts) ramp = std::max(ramp, mount.gate.ramp_time);
  const bool at_rest = state_.grasp.world.bodies[static_cast<std::size_t>(scene_.object)].v_W.norm() < kAtRest;
  if (now < ramp || (!at_rest && now < kPrepareLimit)) return;
  stage_ = Stage::kRun;
  start_ = stop_ = now;
  cue_ = Cue::kStart;
  note("tone", "start");
}

void HandTrial::run(const HandIntent& intent, double now) {
  const TrialVerdict verdict = judge(intent, now - start_);
  stop_ = now;
  if (verdict == TrialVerdict::kSuccess) end("success", Cue::kSuccess);
  if (verdict == TrialVerdict::kTimeout) end("timeout", Cue::kEnd);
}

HandGuide HandTrial::guide() const {
  if (stage_ != Stage::kRun) return {};
  HandGuide guide = taskGuide();
  guide.time_left = std::max(0.0, timeout() - (last_ - start_));
  return guide;
}

bool HandTrial::touchesObject(std::size_t finger) const {
  const grasp::FingerReport& felt = scratch_.fingers[finger];
  return felt.touching && felt.body == scene_.object;
}

bool HandTrial::touchesGround() const {
  return std::any_of(scratch_.fingers.begin(), scratch_.fingers.end(),
                     [&](const grasp::FingerReport& f) { return f.touching && f.body != scene_.object; });
}

bool HandTrial::handIsHome() const {
  for (std::size_t i = 0; i < state_.mounts.size(); ++i) {
    if ((state_.mounts[i].p_WF - scene_.homes_W[i]).norm() > kHomeRadius) return false;
  }
  return true;
}

// The pull is that of the next tick; it goes through the gate like any force.
void HandTrial::leadHome() {
  if (stage_ != Stage::kGoHome) return;
  const double rise = std::min((last_ - stop_) / kLeadRise, 1.0);
  for (std::size_t i = 0; i < state_.mounts.size(); ++i) {
    const Vec3 pull_W = kLeadStiffness * (scene_.homes_W[i] - state_.mounts[i].p_WF);
    state_.mounts[i].f_lead_W = rise * std::min(1.0, kLeadForce / std::max(pull_W.norm(), 1e-9)) * pull_W;
  }
}

bool HandTrial::faulted(std::uint32_t status) {
  for (std::size_t i = 0; i < state_.mounts.size() && trip_ == devices::Trip::kNone; ++i) {
    trip_ = state_.mounts[i].gate.trip;
    tripped_ = i;
  }
  if (trip_ == devices::Trip::kNone && (status & engine::kStateNotFinite) == 0) return false;
  trip(trip_ == devices::Trip::kNone ? devices::Trip::kNotFinite : trip_);
  if (stage_ == Stage::kRun || stage_ == Stage::kPrepare) end("fault", Cue::kEnd);
  note("gate_trip");
  stage_ = Stage::kOver;
  return true;
}

void HandTrial::end(const char* outcome, Cue cue) {
  outcome_ = outcome;
  cue_ = cue;
  note(outcome);
  note("tone", cue == Cue::kSuccess ? "success" : "end");
  stage_ = Stage::kGoHome;
}

void HandTrial::note(const char* kind, const char* detail) {
  if (events_.size() < events_.capacity()) events_.push_back({last_, kind, detail});
}

Vec3 HandTrial::placeTruth() const {
  const Vec3 middle_W = 0.5 * (state_.mounts[0].p_WF + state_.mounts[1].p_WF);
  const Vec3 offset_W = state_.grasp.world.bodies[static_cast<std::size_t>(scene_.object)].X_WI.p - middle_W;
  return {0, offset_W.y(), offset_W.z()};  // the pinch is along x
}

Vec3 HandTrial::gripTruth() const {
  return {0.5 * (scratch_.fingers[0].normal_force + scratch_.fingers[1].normal_force), 0, 0};
}

void HandTrial::record(const std::vector<FingerInputs>& samples, const HandIntent& intent, double now,
                       std::uint32_t status) {
  if (sink_.wantsInputs()) {
    InputRecord input = inputRecord(scene_, state_, scratch_, samples, intent);
    input.trial = head_.trial;
    input.tick = tick_;
    input.time = now;
    input.cut = static_cast<std::uint32_t>(cut_);
    input.status = status;
    sink_.input(input);
  }
  if (!sink_.wantsSample(tick_)) return;
  SampleRecord sample = sampleRecord(scene_, state_, scratch_, samples);
  sample.trial = head_.trial;
  sample.tick = tick_;
  sample.time = now;
  sample.tick_us = 1e6 * tick_seconds_;
  sample.status = status;
  sink_.sample(sample);
}

void HandTrial::parkTactors() {
  for (FingerMount& mount : scene_.model.mounts) mount.display_tactile = false;
}

void HandTrial::keepPassive() {
  scene_.model.passivity.on = true;
  state_.passivity = grasp::PassivityState(scene_.model.mounts.size());
  hands_.passive = 1;
}

void HandTrial::fitTo(int finger, const devices::ArmCapabilities& arm) {
  devices::GateLimits& gate = scene_.model.mounts[static_cast<std::size_t>(finger)].gate;
  gate = devices::within(gate, arm);
  HandsRecord::Finger& kept = hands_.fingers[static_cast<std::size_t>(finger)];
  kept.peak_force = arm.peak_force;
  kept.continuous_force = arm.continuous_force;
  if (arm.peak_torque) kept.peak_torque = {arm.peak_torque->x(), arm.peak_torque->y(), arm.peak_torque->z()};
  std::vector<grasp::ArmPort>& ports = scene_.model.passivity.arms;
  ports.resize(scene_.model.mounts.size());
  ports[static_cast<std::size_t>(finger)] = {arm.tip_mass.value_or(grasp::ArmPort{}.mass), arm.tip_damping};
  kept.tip_mass = arm.tip_mass.value_or(HandsRecord::kNone);
  kept.tip_damping = arm.tip_damping;
}

void HandTrial::standArms(const std::array<ArmBase, kHandFingers>& bases) {
  pincer::tasks::standArms(scene_, bases);
  for (std::size_t i = 0; i < bases.size(); ++i) {
    hands_.fingers[i].base_offset_W = {bases[i].offset_W.x(), bases[i].offset_W.y(), bases[i].offset_W.z()};
    hands_.fingers[i].base_turn = bases[i].turn;
  }
}

void HandTrial::begin() {
  hands_.trial = head_.trial;
  if (sink_.wantsInputs()) sink_.hands(hands_);
}

void HandTrial::trustSamples(double oldest) {
  for (FingerMount& mount : scene_.model.mounts) mount.gate.watchdog_time = oldest;
  hands_.oldest_sample = oldest;
}

void HandTrial::cutForces(devices::Trip cause) {
  cut_ = cause;
  trip(cause);
}

void HandTrial::trip(devices::Trip cause) {
  for (MountState& mount : state_.mounts) devices::trip(mount.gate, cause);
  for (FingerOutputs& output : scratch_.outputs) output.f_D.setZero();
}

// A loop that stalls isn't one finger's affair.
std::string HandTrial::fault() const {
  if (trip_ == devices::Trip::kNone) return "";
  const std::string why = devices::describe(scene_.model.mounts[tripped_].gate, state_.mounts[tripped_].gate);
  return trip_ == devices::Trip::kMissedDeadline
             ? why
             : fmt::format("{}: {}", scene_.model.grasp.fingers[tripped_].name, why);
}

void HandTrial::finish() {
  for (const Event& event : events_) {
    const bool tripped = trip_ != devices::Trip::kNone && std::string(event.kind) == "gate_trip";
    sink_.event({head_.trial, event.time, event.kind, tripped ? fault() : event.detail});
  }
  const auto triple = [](const Vec3& v) { return std::array<double, 3>{v.x(), v.y(), v.z()}; };
  for (const Reading& r : readings_) {
    sink_.reading({head_.trial, r.time, r.said.kind, triple(r.truth), triple(r.said.percept), triple(r.said.estimate),
                   r.said.decision});
  }
  sink_.trial(row());
}

TrialRecord HandTrial::row() const {
  TrialRecord row;
  row.trial = head_.trial;
  row.task = head_.task;
  row.training = head_.training ? 1 : 0;
  row.participant = head_.participant;
  row.condition = head_.condition;
  row.index = head_.index;
  row.outcome = outcome_;
  row.duration = stop_ - start_;
  row.phase_times = phaseTimes();
  fill(row);
  row.tick_us_median = 1e6 * tick_times_.quantile(0.5);
  row.tick_us_p999 = 1e6 * tick_times_.quantile(0.999);
  return row;
}

std::string HandTrial::phaseTimes() const {
  std::string json;
  for (int i = 0; i < kHandPhases; ++i) {
    const double time = phase_times_[static_cast<std::size_t>(i)];
    if (time > 0)
      json += fmt::format("{}\"{}\": {:.3f}", json.empty() ? "" : ", ", nameOf(static_cast<HandPhase>(i)), time);
  }
  return "{" + json + "}";
}

}  // namespace pincer::tasks
