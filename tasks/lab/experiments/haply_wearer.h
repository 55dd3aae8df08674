// haply_wearer: a simulated participant who holds the knobs of the emulator's two Inverse3 (devices/emulate) and picks
// up the sphere: feels only what they render, and pulls at them.
//
// The service has no tones. So the hand begins when a session arms, which it feels as the test force of
// devices/haply on both knobs, and starts two seconds later, when the session's forces have come up; it notices a
// trial's end by the next one's beginning.
#pragma once
#include "pincer/devices/emulate/haply_service.h"
#include "pincer/tasks/lab/participants/scripted_pickup.h"

namespace pincer::tasks {

class HaplyWearer {
 public:
  // `service` needs two arms that face each other (turn 0).
  explicit HaplyWearer(devices::emulate::HaplyService& service);
  // A millisecond of its life; the arms have been advanced by as much.
  void act(devices::emulate::HaplyService& service);

 private:
  TrialCues cues_;
  ScriptedPickup participant_{1};
  double time_ = 0, starts_ = -1;  // [s]
  bool tested_ = false;
};

}  // namespace pincer::tasks
