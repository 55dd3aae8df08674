// touch: what the skin of two fingers tells, within the limits of body.h.
//
//   grip force of a finger   f = max(0, -f_W . n_W),   low-passed:  f' = (f_now - f)/lag
//   place of the object      p_fo = (r + w) (d - (d . n) n),   d = cos(a) n + sin(a) t
//                            a = |place_L|/r,   t = place_L/|place_L| in F
//
//   f_W   the arm's push [N], n_W  the pad's normal as felt
//   r     radius of the fingertip, w  expected half width of the object [m]
//   d     direction from the fingertip's centre to the contact
//   p_fo  from the fingertip to the object's centre, across the pad [m]
// A spherical fingertip on a spherical object touches on the line of the centres, hence the second equation.
//
// The direction of a force tells only whether a finger stands on the dish or touches the object's side. It doesn't
// tell where on the object: in a quasi-static pinch both forces lie along the line that joins the contacts,
// whether or not the fingers oppose each other.
#pragma once
#include <array>
#include <optional>

#include "pincer/tasks/lab/participants/body.h"
#include "pincer/tasks/lab/participants/participant.h"
#include "pincer/tasks/lab/participants/random.h"

namespace pincer::tasks {

class Touch {
 public:
  void begin(const SensingLimits& limits, const TrialCues& cues, const BodySense& sense);
  void feel(const Percept& percept);

  bool feels(int finger) const { return force(finger) > limits_.force_floor; }
  bool feelsBoth() const { return feels(0) && feels(1); }
  double force(int finger) const { return force_[static_cast<std::size_t>(finger)]; }  // [N]
  double grip() const { return 0.5 * (force_[0] + force_[1]); }                        // [N]
  // whatever its direction [N]
  double push(int finger) const { return push_W_[static_cast<std::size_t>(finger)].norm(); }
  // How long at least one finger has felt nothing [s].
  double lossTime() const { return loss_time_; }
  // Both fingers feel something, and a tactor has gone further than `tactor_moves` within the reflex time: what is held
  // slips or rolls. Never, unless the tactors are of use for it.
  bool feelsSlip() const { return slips_; }

  // Reads the direction of the push on a finger that has felt one for the reflex time, and again every reading time.
  // Returns a finger whose push seems to come from below rather than against its pad.
  std::optional<int> pushedFromBelow(Random& random);
  // A deliberate reading of the direction of the push on a finger that feels one: unit, W.
  std::optional<Vec3> readPush(int finger, Random& random) const;
  // A deliberate reading of where on its pad a finger is touched: direction from the fingertip's centre to the contact,
  // unit, W. Absent unless its tactor has moved since the trial began.
  std::optional<Vec3> readContact(int finger, Random& random) const;
  // Where the body believes a fingertip's centre is [m].
  Vec3 feltTip_W(int finger) const;

  // A deliberate reading of the pads: where the object's centre lies from the middle between the fingertips, across the
  // pads [m], W. Absent unless both tactors have moved since the trial began: a still one tells nothing.
  std::optional<Vec3> readPlace(Random& random) const;

 private:
  void feelSlip();
  Vec3 padAxis_W(int finger, const Vec3& axis_F) const;
  std::optional<Vec2> readPad(int finger, Random& random) const;  // felt place on the pad [m]
  std::optional<Vec3> readPlace(int finger, Random& random) const;

  SensingLimits limits_;
  TrialCues cues_;
  BodySense sense_;
  Percept percept_;
  std::array<double, kHandFingers> force_{};        // against the pad [N]
  std::array<Vec3, kHandFingers> push_W_;           // felt push [N]
  std::array<double, kHandFingers> touched_for_{};  // [s]
  std::array<bool, kHandFingers> moved_{};
  std::array<std::optional<Vec2>, kHandFingers> place_at_start_;
  std::array<Vec2, kHandFingers> place_before_;  // at the begin of this stretch of reflex time [m]
  double stretch_begin_ = 0;                     // [s]
  bool slips_ = false;
  double loss_time_ = 0;
  bool begun_ = false;
};

}  // namespace pincer::tasks
