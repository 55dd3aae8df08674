// finger_trial: one trial with one finger, tick by tick: one thing is felt, or two one after the other,
// and somebody answers. The same code for simulated participants and people, for simulated devices, a
// mouse and real ones; what is felt is the task's.
//
//   prepare   the gate ramps up, the finger is off the surface
//   interval  tone; the finger explores; then a pause and the next
//   answer
//
// A simulated participant says itself what it has felt and what it answers. A person does by keys:
//
//   kWhich   the finger raised, Enter ends an interval; then 1 or 2 says which, Enter that it is meant
//   kName    one of the keys 1, 2, ... names what is felt, at once and for good
//   kMatch   Enter, while touching: here and now is what is meant; an interval before the last
//            ends when the finger is raised after that
//
// tick() allocates nothing; events are kept and handed over at the end (finish).
#pragma once
#include <atomic>
#include <optional>
#include <string>
#include <vector>

#include "pincer/tasks/lab/finger/study_sink.h"
#include "pincer/tasks/lab/finger/worn_finger.h"
#include "pincer/tasks/run/servo/servo.h"
#include "pincer/tasks/run/tick/snapshot.h"

namespace pincer::tasks {

enum class TrialQuestion : std::uint8_t { kWhich, kName, kMatch };

// News for a person while a trial goes on.
struct TrialTexts {
  std::string feel;      // "Stroke to and fro; then raise the finger and press Enter"
  std::string question;  // "Which was the smooth one? 1 or 2, then Enter"
};

struct FingerTrialSetup {
  std::int64_t trial = 0;
  int stride = 50;       // every stride-th tick is recorded
  double timeout = 120;  // of simulated participants [s]
  double wait = 0;       // until the first tone, at least [s]
  // duration and contact are counted from the first touch to the answer; else over the intervals
  bool counts_from_touch = false;
  int intervals = 1;
  TrialQuestion question = TrialQuestion::kWhich;
  int choices = 2;                 // of the keys that answer
  std::optional<double> target{};  // that a screen shows in the first interval: the tactor is to be there [m of arc]
  double tolerance = 0.25e-3;      // of it [m]
  bool training = false;           // what is felt and the finger are seen
  TrialTexts texts = {};
};

// How the trial stands, for somebody who watches and for the person who does it. The texts live as long as the trial.
struct FingerTold {
  const char* instruction = "";
  const char* stage = "";
  bool hidden = false;             // what is felt and the finger
  bool shows_pad = false;          // with the tactor on it
  std::optional<double> target{};  // on the pad [m]
};

// The base of an arm that stands off its place.
Pose movedBase(const Pose& X_WD, const ArmBase& base);

class FingerTrial : public ServoCycle {
 public:
  bool tick(double now) final;
  void cutForces() noexcept final;

  // Hands what the finger is to a sink that wants the trial's inputs. Before the first tick.
  void begin();
  // Hands the trial's events to the sink. After the last tick.
  void finish();

  // Once the servo has returned.
  bool answered() const { return answered_; }  // false after a fault or a time-out
  int chosen() const { return chosen_; }       // by a person: 1, 2, ...; 0: nothing
  // The tactor's place wherever Enter was pressed [m of arc].
  const std::vector<double>& enteredPlaces() const { return entered_places_; }
  // Outcome, duration, response time, share of contact and speeds.
  void measure(ResponseRecord& response) const;
  // Why the forces were cut, with the remedy; empty: they weren't.
  std::string fault() const;

  FingerTold told() const;
  const FingerTrialSetup& asked() const { return asked_; }
  bool isPersons() const { return finger_.wear().is_person; }
  // The picture to draw. The first call makes it.
  virtual const grasp::GraspModel& pictured() = 0;
  virtual void fill(Snapshot& snapshot) const = 0;

 protected:
  struct Felt {
    bool touches = false;
    double gap = 0;    // to the surface; negative: pressed in [m]
    double speed = 0;  // of the finger [m/s]
  };

  // `finger` and `sink` outlive it.
  FingerTrial(const FingerTrialSetup& setup, WornFinger& finger, StudySink& sink);

  // One tick of what is felt: commands for the devices.
  virtual FingerOutputs step(const FingerInputs& inputs, double now, double dt) = 0;
  virtual Felt felt() const = 0;
  virtual void startInterval(int interval) = 0;
  virtual const devices::GateLimits& gateLimits() const = 0;
  virtual devices::GateState& gate() = 0;
  virtual void fill(SampleRecord& sample) const = 0;  // all but trial, tick, times

  const devices::GateState& gateState() const { return const_cast<FingerTrial*>(this)->gate(); }
  WornFinger& finger() { return finger_; }
  const FingerInputs& inputs() const { return inputs_; }
  const FingerOutputs& outputs() const { return outputs_; }
  int interval() const { return shown_; }
  // Of the sample: what the devices said and were told.
  void fillFinger(FingerRecord& finger) const;
  // Of the snapshot: the device's side of its one finger.
  void fillMount(FingerSnapshot& finger) const;

 private:
  enum class Stage : std::uint8_t { kPrepare, kPause, kInterval, kAnswer, kOver };
  struct Event {
    double time;
    const char* kind;
    int key;
  };

  OneFingerAction hear(const FingerDeed& deed);
  void hearInInterval(int key, OneFingerAction& action);
  void hearAnswer(int key, OneFingerAction& action);
  bool isOnTarget() const;
  void advance(const OneFingerAction& action, double now);
  void enter(Stage stage, double now);
  bool isCounted();
  void count(double dt);
  void record(const FingerDeed& deed, double now, double took);
  void end(const char* outcome);
  void note(const char* kind, int key = 0);

  FingerTrialSetup asked_;
  WornFinger& finger_;
  StudySink& sink_;
  FingerInputs inputs_;
  FingerOutputs outputs_;
  Stage stage_ = Stage::kPrepare;
  Cue cue_ = Cue::kNone;
  int shown_ = 0, chosen_ = 0;
  bool answered_ = false, has_entered_ = false, must_raise_ = false, has_touched_ = false;
  double now_ = 0, entered_ = 0;              // [s]
  double shown_time_ = 0, contact_time_ = 0;  // [s]
  double answered_after_ = 0;                 // [s]
  double finger_way_ = 0, finger_time_ = 0;   // while it touched and moved [m], [s]
  double tactor_way_ = 0, tactor_time_ = 0;   // while it moved [m], [s]
  std::optional<Vec2> tactor_mark_;           // its place some ticks ago [m]
  std::int64_t ticks_ = 0;
  std::vector<double> entered_places_;  // room for one per interval
  std::vector<Event> events_;
  const char* outcome_ = "interrupted";
  std::atomic<bool> cut_{false};
  devices::Trip cause_ = devices::Trip::kNone;  // why forces were cut before this tick
};

}  // namespace pincer::tasks
