// hands_cycle: a trial and the hands that do it, as a cycle of the servo; and who runs such cycles.
#pragma once
#include <atomic>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "pincer/tasks/lab/experiments/hand_trial.h"
#include "pincer/tasks/lab/experiments/hands.h"
#include "pincer/tasks/lab/finger/finger_host.h"
#include "pincer/tasks/run/servo/servo.h"

namespace pincer::tasks {

// Both must outlive it. The servo's time begins with the trial.
class HandsCycle final : public ServoCycle {
 public:
  // `timed`: keep a histogram per stage.
  HandsCycle(HandTrial& trial, Hands& hands, bool timed = false) : trial_(trial), hands_(hands), timed_(timed) {}

  bool tick(double now) override;
  void cutForces() noexcept override;
  std::vector<StageTimes> stages() const override;

  const HandTrial& trial() const { return trial_; }
  Hands& hands() const { return hands_; }

 private:
  bool step(double now);
  bool timedStep(double now);

  HandTrial& trial_;
  Hands& hands_;
  const bool timed_;
  Histogram samples_, step_, commands_;  // [s]
  std::atomic<bool> cut_{false};
};

// Somebody who watches, or whose hands do the trials. Empty functions: nobody does, and simulated participants do them.
struct TrialHost {
  std::function<std::unique_ptr<Hands>(HandTrial& trial)> hands;
  std::function<ServoReport(HandsCycle& cycle, std::size_t trial, std::size_t trials)> serve;
  // Asks the operator whether forces may come on: before the first trial, and before the
  // one after a fault. False ends the session.
  std::function<bool(const std::string& why)> arm;
  // Of people: a page to read, a question to answer; false or absent: the person has left.
  std::function<bool(const StudyPage& page)> show;
  AskPerson ask;
  // Only this one of the study's participants, from 0; absent: all of them.
  std::optional<std::int64_t> person;
};

}  // namespace pincer::tasks
