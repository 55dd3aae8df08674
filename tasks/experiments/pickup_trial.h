// pickup_trial: one trial, tick by tick; the same code for simulated and real devices, in virtual and in real time. Whoever owns the clock
// calls step() once per tick with the latest samples, and sends outputs() to the devices.
//
//   prepare   gates ramp up, the object comes to rest; then the start tone
//   run       until the judge ends it, or a fault
//   go home   a moment to open the fingers and go back, so that a person's next trial can begin
//
// step() allocates nothing; events are kept and handed over with the trial's row at its end (finish).
#pragma once
#include <string>
#include <vector>

#include "tasks/experiments/pickup_judge.h"
#include "tasks/experiments/pickup_scene.h"
#include "tasks/experiments/record_sink.h"
#include "tasks/servo/histogram.h"

namespace pincer::tasks {

class PickupTrial {
 public:
  PickupTrial(const SpherePickupOptions& options, const PickupObject& object, const PickupTrialSpec& spec, RecordSink& sink);

  // One tick at `now` [s on the devices' clock]. `phase` and `wants_lift` are what the participant said last (a person: what the operator
  // or a rule says). Returns false when the trial is over.
  bool step(const std::vector<FingerInputs>& samples, PickupPhase phase, bool wants_lift, double now);

  const std::vector<FingerOutputs>& outputs() const { return scratch_.outputs; }
  Cue cue() const { return cue_; }  // the tone of this tick
  const PickupScene& scene() const { return scene_; }
  const TickState& state() const { return state_; }
  const TickScratch& scratch() const { return scratch_; }

  // Zero force, latched.
  void cutForces(devices::Trip cause);
  // Hands events and the trial's row to the sink. Once, after the last step.
  void finish();

 private:
  enum class Stage : std::uint8_t { kPrepare, kRun, kGoHome, kOver };
  struct Event {
    double time;
    const char* kind;
    const char* detail;
  };

  engine::StepReport timedTick(const std::vector<FingerInputs>& samples, double now);
  void prepare(double now);
  void run(bool wants_lift, double now);
  bool faulted(double now, std::uint32_t status);
  void end(const char* outcome, Cue cue, double now);
  void note(double time, const char* kind, const char* detail = "");
  void noteCounts(const PickupCounts& before, double now);
  PickupView view(bool wants_lift, double now);
  void record(const std::vector<FingerInputs>& samples, double now, std::uint32_t status);
  TrialRecord row() const;

  PickupTrialSpec spec_;
  double smallest_grip_;  // m g / (2 mu_s) [N]
  RecordSink& sink_;
  PickupScene scene_;
  TickState state_;
  TickScratch scratch_;
  PickupJudge judge_;
  Stage stage_ = Stage::kPrepare;
  Cue cue_ = Cue::kNone;
  PickupPhase phase_ = PickupPhase::kRest;
  double start_ = 0, stop_ = 0;  // of the counted time [s]
  double tick_seconds_ = 0;
  std::int64_t tick_ = 0;
  const char* outcome_ = "fault";
  devices::Trip trip_ = devices::Trip::kNone;
  Histogram tick_times_;
  std::vector<Event> events_;
};

}  // namespace pincer::tasks
