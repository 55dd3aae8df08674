// timeline: what happened when, in the snapshots that were seen: fingers that touch, let go, slip;
// forces that were cut; the end of a sleep.
#pragma once
#include <string>
#include <vector>

#include "pincer/tasks/run/tick/snapshot.h"

namespace pincer::tasks {

enum class MomentKind : std::uint8_t { kTouch, kRelease, kSlip, kStick, kContacts };

struct TimelineMoment {
  double time = 0;  // [s]
  MomentKind kind = MomentKind::kTouch;
  int finger = -1;  // -1: of bodies
};

class Timeline {
 public:
  // `next` comes after the last one that was added; of a time before it, everything later is forgotten.
  void add(const Snapshot& next);
  const std::vector<TimelineMoment>& moments() const { return moments_; }
  // The last one at or before `time` [s]; null if there is none.
  const TimelineMoment* before(double time) const;

 private:
  struct FingerState {
    bool touching = false, sliding = false;
  };
  std::vector<TimelineMoment> moments_;
  std::vector<FingerState> fingers_;
  int body_contacts_ = 0;
  double last_ = -1;
  bool begun_ = false;
};

// "index touches".
std::string momentText(const TimelineMoment& moment, const std::vector<std::string>& finger_names);

// A round distance between the marks of an axis from 0 to `span`, of which at most
// `most` fit: 1, 2 or 5 times a power of ten.
double tickStep(double span, int most);

}  // namespace pincer::tasks
