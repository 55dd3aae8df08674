#include "pincer/tasks/lab/finger/mouse_finger.h"

namespace pincer::tasks {
namespace {

devices::MouseMount mountAt(const FingerPlace& place) {
  devices::MouseMount mount{place.X_WD.q, place.X_WD.p, place.start_W, {}};
  if (place.q_WF) mount.q_DF = place.X_WD.q.conjugate() * *place.q_WF;
  return mount;
}

}  // namespace

MouseFinger::MouseFinger(const FingerPlace& place, AnswerBox& keys)
    : keys_(keys), hand_({mountAt(place)}), display_(simulatedDisplay(place.finger_radius)) {
  wear_.arm = hand_.arm(0).capabilities();
  wear_.is_person = wear_.draws_touch = true;
}

void MouseFinger::advanceTo(double now) {
  const double dt = now - now_;
  if (!(dt > 0)) return;
  now_ = now;
  hand_.advance(dt);
  display_.advance(dt);
}

const FingerInputs& MouseFinger::sample() {
  inputs_ = {hand_.arm(0).sample(), display_.sample()};
  return inputs_;
}

FingerDeed MouseFinger::apply(const FingerOutputs& outputs, Cue, double) {
  hand_.arm(0).commandForce(outputs.f_D);
  display_.command(outputs.tactile);
  tactor_place_ = inputs_.tactile.place_L.value_or(outputs.tactile.place_L).x();
  return {{}, keys_.take()};
}

}  // namespace pincer::tasks
