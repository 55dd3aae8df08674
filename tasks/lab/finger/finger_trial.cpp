#include "pincer/tasks/lab/finger/finger_trial.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "pincer/devices/window/input.h"
#include "pincer/tasks/lab/finger/finger_records.h"
#include "pincer/tasks/run/measure/timing.h"

namespace pincer::tasks {
namespace {

constexpr double kPauseTime = 0.5;         // between the intervals [s]
constexpr double kFingerMoves = 5e-3;      // slower, it rests [m/s]
constexpr double kTactorMoves = 1e-3;      // likewise [m/s]
constexpr std::int64_t kTactorTicks = 20;  // over which its speed is taken: one count of the encoder is then 0.04 mm/s
constexpr double kIsRaised = 5e-3;         // so far off the surface a person's finger is raised [m]
// more keys than a trial takes; further ones are dropped rather than allocated in the tick
constexpr std::size_t kMostEvents = 1024;

// By the key 1 to 9; 0: none was pressed.
constexpr std::array<const char*, 10> kChosen = {"",
                                                 "you chose 1",
                                                 "you chose 2",
                                                 "you chose 3",
                                                 "you chose 4",
                                                 "you chose 5",
                                                 "you chose 6",
                                                 "you chose 7",
                                                 "you chose 8",
                                                 "you chose 9"};

}  // namespace

Pose movedBase(const Pose& X_WD, const ArmBase& base) {
  return {quatFromRotationVector({0, 0, base.turn}) * X_WD.q, X_WD.p + base.offset_W};
}

FingerTrial::FingerTrial(const FingerTrialSetup& setup, WornFinger& finger, StudySink& sink)
    : asked_(setup), finger_(finger), sink_(sink) {
  entered_places_.reserve(static_cast<std::size_t>(setup.intervals));
  if (isPersons()) events_.reserve(kMostEvents);
}

void FingerTrial::begin() {
  if (!sink_.wantsInputs()) return;
  const FingerWear& wear = finger_.wear();
  HandsRecord hands;
  hands.trial = asked_.trial;
  hands.fingers[0] = handsRecordOf(wear);
  if (wear.oldest_sample) hands.oldest_sample = *wear.oldest_sample;
  hands.passive = wear.has_motors ? 1 : 0;
  sink_.hands(hands);
}

void FingerTrial::cutForces() noexcept {
  cut_ = true;
  finger_.stop();
}

bool FingerTrial::tick(double servo_time) {
  finger_.advanceTo(servo_time);
  const double now = finger_.time(servo_time), dt = now > now_ ? now - now_ : 1e-3;
  now_ = now;
  const bool kept = ticks_ % asked_.stride == 0;  // reading the clock takes as long as the display's tick
  const double start = kept ? steadySeconds() : 0;
  cause_ = cut_ ? devices::Trip::kMissedDeadline : finger_.cut();
  if (cause_ != devices::Trip::kNone) devices::trip(gate(), cause_);
  inputs_ = finger_.sample();
  outputs_ = step(inputs_, now, dt);
  const double took = kept ? steadySeconds() - start : 0;
  if (isCounted()) count(dt);
  const FingerDeed deed = finger_.apply(outputs_, cue_, now);
  const OneFingerAction action = hear(deed);
  if (action.enters && entered_places_.size() < entered_places_.capacity())
    entered_places_.push_back(finger_.tactorPlace());
  advance(action, now);
  record(deed, now, took);
  return stage_ != Stage::kOver && finger_.more();
}

OneFingerAction FingerTrial::hear(const FingerDeed& deed) {
  if (!isPersons()) return deed.action;
  OneFingerAction action;
  if (deed.key != 0) note("key", deed.key);
  if (stage_ == Stage::kInterval) hearInInterval(deed.key, action);
  if (stage_ == Stage::kAnswer) hearAnswer(deed.key, action);
  return action;
}

void FingerTrial::hearInInterval(int key, OneFingerAction& action) {
  const bool raised = felt().gap > kIsRaised, enter = key == devices::kKeyEnter, last = shown_ + 1 == asked_.intervals;
  if (asked_.question == TrialQuestion::kWhich) {
    action.interval_over = enter && raised;
    must_raise_ = !raised && (enter || must_raise_);
  } else if (asked_.question == TrialQuestion::kName) {
    if (key > '0' && key <= '0' + asked_.choices) chosen_ = key - '0';
    action.interval_over = chosen_ != 0;
  } else {
    action.enters = enter && !has_entered_ && felt().touches && isOnTarget();
    has_entered_ = has_entered_ || action.enters;
    action.interval_over = has_entered_ && (last || raised);
  }
}

bool FingerTrial::isOnTarget() const {
  return shown_ > 0 || !asked_.target || std::abs(finger_.tactorPlace() - *asked_.target) <= asked_.tolerance;
}

void FingerTrial::hearAnswer(int key, OneFingerAction& action) {
  if (asked_.question != TrialQuestion::kWhich) {
    action.answered = true;
    return;
  }
  if (key > '0' && key <= '0' + asked_.choices) chosen_ = key - '0';
  action.answered = key == devices::kKeyEnter && chosen_ != 0;
}

void FingerTrial::advance(const OneFingerAction& action, double now) {
  cue_ = Cue::kNone;
  if (gate().trip != devices::Trip::kNone) return end("fault");
  if (!isPersons() && now > asked_.timeout) return end("timeout");
  const bool ready = now >= std::max(asked_.wait, gateLimits().ramp_time) && (!isPersons() || felt().gap > kIsRaised);
  if (stage_ == Stage::kPrepare ? ready : stage_ == Stage::kPause && now >= entered_ + kPauseTime) {
    enter(Stage::kInterval, now);
    cue_ = Cue::kStart;
    note("tone");
  } else if (stage_ == Stage::kInterval && action.interval_over) {
    const bool last = shown_ + 1 == asked_.intervals;
    enter(last ? Stage::kAnswer : Stage::kPause, now);
    if (last) return;
    startInterval(++shown_);
  } else if (stage_ == Stage::kAnswer && action.answered) {
    answered_ = true;
    answered_after_ = now - entered_;
    end("answered");
  }
}

void FingerTrial::enter(Stage stage, double now) {
  stage_ = stage;
  entered_ = now;
  has_entered_ = must_raise_ = false;
}

void FingerTrial::end(const char* outcome) {
  outcome_ = outcome;
  stage_ = Stage::kOver;
  note(outcome);
}

bool FingerTrial::isCounted() {
  if (!asked_.counts_from_touch) return stage_ == Stage::kInterval;
  const bool runs = stage_ == Stage::kInterval || stage_ == Stage::kAnswer;
  has_touched_ = has_touched_ || (runs && felt().touches);
  return runs && has_touched_;
}

void FingerTrial::count(double dt) {
  shown_time_ += dt;
  const Felt felt = this->felt();
  if (felt.touches) {
    contact_time_ += dt;
    if (felt.speed > kFingerMoves) {
      finger_way_ += felt.speed * dt;
      finger_time_ += dt;
    }
  }
  const devices::TactileSample& tactile = inputs_.tactile;
  if (ticks_ % kTactorTicks != 0 || !tactile.valid || !tactile.place_L) return;
  const double time = static_cast<double>(kTactorTicks) * dt;
  const double way = (*tactile.place_L - tactor_mark_.value_or(*tactile.place_L)).norm();
  if (felt.touches && way > kTactorMoves * time) {
    tactor_way_ += way;
    tactor_time_ += time;
  }
  tactor_mark_ = *tactile.place_L;
}

void FingerTrial::record(const FingerDeed& deed, double now, double took) {
  const std::int64_t tick = ticks_++;
  SampleRecord sample;
  sample.q_WB = {1, 0, 0, 0};
  const bool keeps = tick % asked_.stride == 0 && sink_.wantsSample(tick);
  if (keeps || sink_.wantsInputs()) fill(sample);
  if (sink_.wantsInputs()) {
    InputRecord input;
    input.trial = asked_.trial;
    input.tick = tick;
    input.time = now;
    input.cut = static_cast<std::uint32_t>(cause_);
    input.flags = static_cast<std::uint32_t>(deed.key) << InputRecord::kKeyShift;
    input.fingers[0] = fingerInputRecord(inputs_, outputs_);
    input.q_WB = {1, 0, 0, 0};
    input.status = sample.status;
    sink_.input(input);
  }
  if (!keeps) return;
  sample.trial = asked_.trial;
  sample.tick = tick;
  sample.time = now;
  sample.tick_us = 1e6 * took;
  sink_.sample(sample);
}

void FingerTrial::fillFinger(FingerRecord& finger) const {
  finger.f_arm_D = {outputs_.f_D.x(), outputs_.f_D.y(), outputs_.f_D.z()};
  finger.place_wanted_L = {outputs_.tactile.place_L.x(), outputs_.tactile.place_L.y()};
  finger.place_shown_L = {std::nan(""), std::nan("")};
  const devices::TactileSample& tactile = inputs_.tactile;
  if (tactile.valid && tactile.place_L) finger.place_shown_L = {tactile.place_L->x(), tactile.place_L->y()};
  finger.flags = (felt().touches ? kTouching : 0) | (gateState().trip != devices::Trip::kNone ? kGateTripped : 0) |
                 (outputs_.tactile.parked ? kTactorParked : 0);
}

void FingerTrial::fillMount(FingerSnapshot& finger) const {
  finger.has_device = finger.has_display = true;
  finger.device = inputs_.arm.valid ? devices::DeviceState::kReady : devices::DeviceState::kFaulted;
  finger.trip = gateState().trip;
  finger.armed = gateState().armed;
  finger.tactor_L = inputs_.tactile.valid ? inputs_.tactile.place_L : std::nullopt;
  finger.tactor_wanted_L = outputs_.tactile.place_L;
  finger.tactor_parked = outputs_.tactile.parked;
}

void FingerTrial::note(const char* kind, int key) {
  if (events_.size() < events_.capacity()) events_.push_back({now_, kind, key});
}

void FingerTrial::finish() {
  for (const Event& event : events_) {
    const bool enter = event.key == devices::kKeyEnter, shown = event.key > ' ' && event.key < 127;
    const std::string key = enter   ? "Enter"
                            : shown ? std::string(1, static_cast<char>(event.key))
                                    : fmt::format("key {}", event.key);
    sink_.event({asked_.trial, event.time, event.kind,
                 event.key != 0                       ? key
                 : std::string(event.kind) == "fault" ? fault()
                                                      : ""});
  }
}

std::string FingerTrial::fault() const {
  return gateState().trip == devices::Trip::kNone ? "" : devices::describe(gateLimits(), gateState());
}

void FingerTrial::measure(ResponseRecord& r) const {
  r.outcome = outcome_;
  r.duration = shown_time_;
  r.response_time = answered_after_;
  r.contact_share = shown_time_ > 0 ? contact_time_ / shown_time_ : 0;
  r.finger_speed = finger_way_ / finger_time_;  // NaN of nothing
  r.tactor_speed = tactor_way_ / tactor_time_;
}

FingerTold FingerTrial::told() const {
  const bool two = asked_.intervals > 1;
  FingerTold told;
  told.hidden = isPersons() && !asked_.training;
  const bool on_screen = asked_.target && shown_ == 0 && stage_ == Stage::kInterval;
  told.shows_pad = !told.hidden || finger_.wear().draws_touch || on_screen;
  if (on_screen && !has_entered_) told.target = asked_.target;
  const bool ready = stage_ == Stage::kPrepare || stage_ == Stage::kPause;
  told.stage = ready                        ? "wait for the tone"
               : stage_ == Stage::kInterval ? (two ? (shown_ == 0 ? "first" : "second") : "feel")
                                            : "answer";
  if (stage_ == Stage::kPrepare) {
    told.instruction = "Raise the finger, and wait";
  } else if (stage_ == Stage::kPause) {
    told.instruction = "The second comes";
  } else if (stage_ == Stage::kInterval) {
    told.instruction = has_entered_  ? "Raise the finger"
                       : must_raise_ ? "Raise the finger first, then press Enter"
                                     : asked_.texts.feel.c_str();
  } else if (stage_ == Stage::kAnswer) {
    told.instruction = asked_.texts.question.c_str();
    if (chosen_ > 0 && chosen_ < static_cast<int>(kChosen.size()))
      told.stage = kChosen[static_cast<std::size_t>(chosen_)];
  } else {
    told.stage = "over";
  }
  return told;
}

}  // namespace pincer::tasks
