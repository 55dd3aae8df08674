// pickup_judge: the one who sees the world, counts, and says when a trial is over.
//
//   squeeze  both normal forces exceed 0.2 N while the participant means to lift. It is the same
//            squeeze until that intent ends, or a finger has carried less than half of it for 0.1 s:
//            one squeeze per attempt, however the forces ring
//   lift     the object's bottom leaves the dish; it is the same lift until it is back.
//            A perfect trial has 1, like its squeezes
//   try_5mm  the bottom clears 5 mm, once per lift
//   slip     a loaded finger that had stuck begins to slide, and slides further than 0.2 mm before it has stuck again
//            for 20 ms. (Without that distance one would count micro-slips: a grip near the limit of friction or
//            torsion creeps at every step of an encoder)
//   drop     held over 5 mm, then no finger touches the object before it is back on the dish
//   failure  a squeeze has ended without success: "not lifted" (the bottom never left the dish), "slipped" (never
//            cleared 5 mm), "dropped", or "squeezed out" (the object went aside by more than 5 mm, across the pinch)
//   success  the bottom stays over 50 mm for 1 s;   timeout: 60 s without (censored data)
//
//   clearance  gap between the object and the dish [m]: the height of the bottom, for a sphere lifted straight up
//   offset at the squeeze  distance of the object's centre of mass from the line through the two contacts
//                          [m]; 0 for an antipodal pinch of a sphere
// Definitions of squeeze, lift, try and success: design of the tasks, but that there lifts and tries count
// when the object is down again, so that a perfect trial would have none and a dropped one as many as a
// held one; the rules' other figures are ours.
#pragma once
#include <array>
#include <cstdint>
#include <limits>

#include "pincer/contact/math.h"
#include "pincer/tasks/lab/experiments/trial_verdict.h"

namespace pincer::tasks {

struct PickupRules {
  double squeeze_force = 0.2;     // [N]
  double release_time = 0.1;      // under half of it, ends a squeeze [s] (ours)
  double off_clearance = 0.5e-3;  // the bottom is off the dish over this [m] (ours)
  double back_clearance = 5e-5;   // and back on it under this [m] (ours)
  double try_clearance = 5e-3;    // [m]
  double aside = 5e-3;            // "squeezed out" [m] (ours)
  double loaded_force = 0.2;      // a finger that carries more is loaded [N] (ours)
  double slip_distance = 2e-4;    // [m] (ours)
  double stick_time = 0.02;       // ends a slide [s] (ours)
  double success_height = 0.050;  // [m]
  double hold_time = 1.0;         // [s]
  double timeout = 60;            // [s]
};

// Everything that a judge sees in one tick.
struct PickupView {
  struct Finger {
    bool on_object = false;
    bool sliding = false;
    double normal_force = 0;   // [N]
    double slide_speed = 0;    // of the finger over the object [m/s]
    Vec3 p_WC = Vec3::Zero();  // [m]
  };
  double time = 0;  // since the start tone [s]
  bool wants_lift = false;
  std::array<Finger, 2> fingers;
  Vec3 p_WBcm = Vec3::Zero();  // object's centre of mass [m]
  double clearance = 0;        // [m]
};

struct PickupCounts {
  std::int64_t squeezes = 0, lifts = 0, tries_5mm = 0, slips = 0, drops = 0, failures = 0;
  const char* last_failure = "";
  double peak_grip = 0;  // [N]
  // mean grip while over the success height, at the success [N]
  double held_grip = std::numeric_limits<double>::quiet_NaN();
  double offset_at_squeeze = std::numeric_limits<double>::quiet_NaN();  // at the last squeeze [m]
};

class PickupJudge {
 public:
  explicit PickupJudge(const PickupRules& rules = {}) : rules_(rules) {}
  // One tick of at most some milliseconds; time never goes back.
  TrialVerdict observe(const PickupView& view);
  const PickupCounts& counts() const { return counts_; }

 private:
  void watchSqueeze(const PickupView& view, double dt);
  void judgeFailure(const PickupView& view);
  void watchHeight(const PickupView& view);
  void watchSlip(const PickupView& view, double dt);
  TrialVerdict watchHold(const PickupView& view, double dt);

  PickupRules rules_;
  PickupCounts counts_;
  double last_time_ = 0;
  bool begun_ = false;
  bool squeezing_ = false;
  bool dropped_in_squeeze_ = false;
  double highest_ = 0;                  // of this squeeze [m]
  Vec3 p_squeeze_W_ = Vec3::Zero();     // of the object when it began [m]
  double released_for_ = 0;             // [s]
  bool off_ = false, cleared_ = false;  // since it was last on the dish: off it; over try_clearance
  bool held_ = false;                   // over try_clearance with a finger on it
  bool dropped_ = false;
  struct Slide {
    double distance = 0;   // since the finger last stuck [m]
    double stuck_for = 0;  // [s]
    bool stuck = false;    // it was stuck before this slide
    bool counted = false;
  };
  std::array<Slide, 2> slides_{};
  double over_since_ = -1;  // when it went over the success height [s]; negative: it isn't
  double grip_time_ = 0, grip_integral_ = 0;
};

}  // namespace pincer::tasks
