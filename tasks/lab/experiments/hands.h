// hands: whoever wears the fingers of a trial: a simulated participant, a person on a mouse, a person on real devices.
#pragma once
#include <vector>

#include "pincer/tasks/lab/participants/participant.h"
#include "pincer/tasks/run/tick/tick.h"

namespace pincer::tasks {

class Hands {
 public:
  virtual ~Hands() = default;
  // Moves what has no clock of its own to `now` [s]; time never goes back.
  virtual void advanceTo(double now) = 0;
  // The tick's time [s], which the servo says is `now`: another one where it was recorded.
  virtual double time(double now) const { return now; }
  virtual const std::vector<FingerInputs>& sample() = 0;
  // Commands of this tick to the devices, tones to the one who wears them.
  virtual void apply(const std::vector<FingerOutputs>& outputs, Cue cue, double now) = 0;
  virtual const HandIntent& intent() const = 0;
  // False: nothing more will come, the trial ends here.
  virtual bool more() const { return true; }
  // Zero force at once, past the trial's own gate; from any thread.
  virtual void stop() noexcept {}
};

}  // namespace pincer::tasks
