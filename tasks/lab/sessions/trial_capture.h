// trial_capture: a trial's ticks as snapshots: the grasp, what the devices deliver, and what the person is told.
#pragma once
#include "pincer/tasks/lab/experiments/hands_cycle.h"
#include "pincer/tasks/run/tick/snapshot.h"

namespace pincer::tasks {

class TrialCapture {
 public:
  // The `trial`-th, from 0, of `trials`; the cycle must outlive it. `blind`: nothing of the world
  // is seen. `guided`: with hints and goals.
  TrialCapture(HandsCycle& cycle, std::size_t trial, std::size_t trials, bool blind = false, bool guided = false);

  // After each tick: what the person hears changes what the person is told.
  void hear();
  // `snapshot` is sized for the trial's model. Allocates nothing.
  void fill(Snapshot& snapshot);

 private:
  HandsCycle& cycle_;
  TrialSnapshot told_;
  bool guided_;
};

}  // namespace pincer::tasks
