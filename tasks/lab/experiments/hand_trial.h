// hand_trial: one trial of a manipulation task, tick by tick; the same code for simulated and real
// devices, in virtual and in real time. Whoever owns the clock calls step() once per tick with the latest
// samples, and sends outputs() to the devices.
//
//   prepare   gates ramp up, the object comes to rest; then the start tone
//   run       until the task's judge ends it, or a fault
//   go home   a weak spring leads the open hand back to where it starts, so that the next trial can begin
//
// step() allocates nothing; events and readings are kept and handed over with the trial's row at its end (finish).
#pragma once
#include <string>
#include <vector>

#include "pincer/tasks/lab/experiments/hand_scene.h"
#include "pincer/tasks/lab/experiments/record_sink.h"
#include "pincer/tasks/lab/experiments/trial_verdict.h"
#include "pincer/tasks/run/servo/histogram.h"

namespace pincer::tasks {

// The part of a trial's row that holds whatever came out.
struct TrialHead {
  std::string task;        // "sphere-pickup"
  std::int64_t trial = 0;  // within the session, from 0
  std::int64_t participant = 0, index = 0;
  std::string condition;  // as the study names it
  bool training = false;
};

// A hint at this moment for somebody who can't feel.
struct HandGuide {
  const char* hint = "";                    // "Too low: a finger touches the dish"
  std::optional<double> goal_height = {};   // of the object's middle [m]
  std::optional<double> goal_heading = {};  // of a mark on the object about W's z axis [rad]
  double time_left = -1;                    // of the trial [s]; negative: it doesn't run
};

class HandTrial {
 public:
  virtual ~HandTrial() = default;

  // One tick at `now` [s on the devices' clock]. `intent` is what the participant said last (a person: what the
  // operator or a rule says). Returns false when the trial is over.
  bool step(const std::vector<FingerInputs>& samples, const HandIntent& intent, double now);

  const std::vector<FingerOutputs>& outputs() const { return scratch_.outputs; }
  Cue cue() const { return cue_; }  // the tone of this tick
  const HandScene& scene() const { return scene_; }
  const std::string& condition() const { return head_.condition; }  // by its name
  virtual const char* instruction() const = 0;                      // what the person is asked to do, a sentence
  // While the trial runs, the task's; else nothing.
  HandGuide guide() const;
  const TickState& state() const { return state_; }
  const TickScratch& scratch() const { return scratch_; }
  // Why the forces were cut, with the remedy; empty: they weren't. Once the trial is over.
  std::string fault() const;

  // The tactors stay where they are, whatever the condition says. Before the first step.
  void parkTactors();
  // The gate keeps to what the finger's arm can do, and passivity builds on what its tip weighs. Before the first step.
  void fitTo(int finger, const devices::ArmCapabilities& arm);
  // So old may a sample be [s]. Before the first step.
  void trustSamples(double oldest);
  // The arms stand so far off their places in the scene. Throws InputError unless
  // they face each other. Before the first step.
  void standArms(const std::array<ArmBase, kHandFingers>& bases);
  // Hands all of this to a sink that wants the trial's inputs. Before the first step.
  void begin();
  // Zero force, latched. Between two steps.
  void cutForces(devices::Trip cause);
  // Passivity at the fingers from now on (grasp/passivity): for arms with motors.
  void keepPassive();
  // Hands events, readings and the trial's row to the sink. Once, after the last step.
  void finish();

 protected:
  HandTrial(HandScene scene, TrialHead head, RecordSink& sink);

  // One tick of the counted time, `time` after the start tone [s].
  virtual TrialVerdict judge(const HandIntent& intent, double time) = 0;
  // Writes the task's measures into the trial's row.
  virtual void fill(TrialRecord& row) const = 0;
  // Its hint, its goal, and how long a trial may last [s].
  virtual HandGuide taskGuide() const = 0;
  virtual double timeout() const = 0;
  // The truth that a reading of this kind should have told.
  virtual Vec3 truthOf(const HandReading& reading) const = 0;

  void note(const char* kind, const char* detail = "");  // an event, now
  Vec3 placeTruth() const;                               // of a reading "place"
  Vec3 gripTruth() const;                                // of a reading "grip"
  bool touchesObject(std::size_t finger) const;
  bool touchesGround() const;  // a finger does
  TickScratch& scratch() { return scratch_; }

 private:
  enum class Stage : std::uint8_t { kPrepare, kRun, kGoHome, kOver };
  struct Event {
    double time;
    const char* kind;
    const char* detail;
  };
  struct Reading {
    double time;
    HandReading said;
    Vec3 truth;
  };

  engine::StepReport timedTick(const std::vector<FingerInputs>& samples, double now);
  void hear(const HandIntent& intent);
  void prepare(double now);
  void run(const HandIntent& intent, double now);
  bool handIsHome() const;
  void leadHome();
  bool faulted(std::uint32_t status);
  void end(const char* outcome, Cue cue);
  void trip(devices::Trip cause);
  void record(const std::vector<FingerInputs>& samples, const HandIntent& intent, double now, std::uint32_t status);
  TrialRecord row() const;
  std::string phaseTimes() const;

  TrialHead head_;
  RecordSink& sink_;
  HandScene scene_;
  TickState state_;
  TickScratch scratch_;
  Stage stage_ = Stage::kPrepare;
  Cue cue_ = Cue::kNone;
  HandPhase phase_ = HandPhase::kRest;
  std::array<double, kHandPhases> phase_times_{};  // within the counted time [s]
  double start_ = 0, stop_ = 0;                    // of the counted time [s]
  double last_ = 0;                                // the last tick [s]
  double tick_seconds_ = 0;
  std::int64_t tick_ = 0;
  const char* outcome_ = "fault";
  devices::Trip trip_ = devices::Trip::kNone;
  std::size_t tripped_ = 0;  // the finger
  Histogram tick_times_;
  HandsRecord hands_;
  devices::Trip cut_ = devices::Trip::kNone;  // from outside, since the last step
  std::vector<Event> events_;
  std::vector<Reading> readings_;
};

}  // namespace pincer::tasks
