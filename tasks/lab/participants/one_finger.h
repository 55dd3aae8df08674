// one_finger: somebody who touches with one finger and answers a question. Behind the
// wall, as all participants (participant.h).
#pragma once
#include "pincer/tasks/lab/participants/participant.h"

namespace pincer::tasks {

struct OneFingerAction {
  devices::HandPull pull;
  double pitch = 0;            // of the finger about W's x axis, its tip up [rad]; 0: it doesn't turn
  std::optional<Quat> q_WF;    // how the finger is held, of who turns it about more than one axis
  bool enters = false;         // presses Enter: here and now is what is meant
  bool interval_over = false;  // what was to be felt has been felt: for one tick
  bool answered = false;
};

class OneFingerObserver {
 public:
  virtual ~OneFingerObserver() = default;
  // One millisecond. Each kStart begins an interval. Allocates nothing, throws nothing.
  virtual OneFingerAction act(const FingerPercept& finger, double time, Cue cue) = 0;
};

}  // namespace pincer::tasks
