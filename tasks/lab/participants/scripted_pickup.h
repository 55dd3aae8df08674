// scripted_pickup: a participant who picks up an object between index finger and thumb, without seeing it.
//
//   listen - reach - close - read - (shift: reach) - squeeze - lift - hold - return - rest
//                ^-------------------- force lost, or nothing found --------'
//
// close    both fingers move inwards until both feel a contact; the one that feels it first waits for the other
// read     hold still, then read the pads; when the object seems further than `shift_threshold` from the
//          middle between the fingertips, open, shift the pinch by gain x estimate and close again; where the
//          tactors stand still there is nothing to read
// squeeze  go on inwards until the felt grip is the wanted one; lift straight up; hold until the tone
// A finger that is pushed from below while reaching or closing stands on the dish: the object's middle is higher than
// believed by what it is above a fingertip on the dish; open and begin again there.
// A loss of force for longer than the reflex time means that the object got away (slipped out, dropped, or was
// expelled): open, go down, grip 1.3 times as hard, a random step away from where the object is believed to be.
// Beliefs change by readings, by the dish and by the first touch alone, never by a random step. The same
// plan in every condition; no parameter knows an outcome. Where the tactors are of use as a cue of slip only (a
// control), a tactor that runs during lift or hold makes the grip 1.3 times as hard. That is the "simple"
// strategy. The "rational" one keeps a belief over the offset of its pinch and over the friction (place_belief.h):
// it shifts when the gain in the chance to hold, times the time that a failure costs, pays for the time that a
// shift takes, both from its own speed; a failure is evidence too, and the next pinch is where the belief says
// that it holds best. Grip grows 1.3 times alike.
//
// The hand pulls each fingertip towards a place (its equilibrium); grip comes from equilibria inside the object.
#pragma once
#include "pincer/tasks/lab/participants/place_belief.h"
#include "pincer/tasks/lab/participants/scripted_hand.h"

namespace pincer::tasks {

struct ScriptedPickupOptions {
  // in which the hand, put to its place by the arms, drifts to where it believes that place to be [s] (choice)
  double settle_time = 1.0;
  double clearance = 0.015;       // between fingertip and believed surface before closing [m] (choice)
  double close_speed = 0.032;     // [m/s], the slowest that Doxon (2014) measured
  double contact_time = 0.05;     // both fingers must feel something for so long [s] (choice)
  double shift_threshold = 5e-3;  // [m] (design)
  // placement_sd^2 / (placement_sd^2 + error^2 of a reading, 4 mm): the best linear estimate [-]
  double shift_gain = 0.75;
  int max_shifts = 3;  // per attempt (choice)
  // after a loss, per axis across the pinch [m]: as far as what is worth a shift (choice)
  double random_shift_sd = 5e-3;
  double search_shift_sd = 14e-3;  // after nothing was found [m]: as far as the placement can be wrong (choice)
  double farthest_shift = 14e-3;   // from the place told, per axis [m]: twice the placement error's SD
  // of where the object lies in its dish after it was let go, across the pinch [m] (choice)
  double object_rolls_sd = 5e-3;
  // before the first failure [-]: geometric mean of the frictions met in training, 0.3 .. 0.9
  double expected_mu = 0.52;
  double grip_safety = 2.0;    // wanted grip over m g / (2 expected_mu) [-] (choice)
  double grip_growth = 1.3;    // after a failure [-] (design)
  double grip_max = 5.0;       // [N] (choice; the arm's peak is 8.5 N)
  double squeeze_rate = 4.0;   // [N/s] (choice)
  double lift_margin = 0.010;  // lifted further than asked for [m] (choice)
  double patience = 2.0;       // without a tone, then lift a little more [s] (choice)
  double lift_more = 0.010;    // [m] (choice)
  double gravity = 9.81;       // [m/s^2]
};

class ScriptedPickup final : public ScriptedHand {
 public:
  // `seed` makes the participant: hands and speed. What varies between trials comes from the trial's own seed.
  explicit ScriptedPickup(std::uint64_t seed, const ScriptedPickupOptions& options = {},
                          const SensingLimits& limits = {}, const HandRanges& ranges = {}, bool rational = false);

  void begin(const TrialCues& cues) override;

 private:
  void listen() override;
  void goAlong() override;
  void close() override;
  void read() override;
  void squeeze() override;
  void lift() override;
  void hold() override;
  void mean(HandIntent& intent) const override;

  void readSimply(const std::optional<Vec3>& offset_W);
  void readRationally(const std::optional<Vec3>& offset_W);
  bool pays(const Vec2& shift) const;
  void shiftBy(const Vec3& shift_W);
  void say(const char* kind, const Vec3& percept, const Vec3& estimate, const char* decision);
  Vec2 across(const Vec3& v_W) const { return {v_W.dot(side_W_), v_W.z()}; }
  Vec3 along(const Vec2& v) const { return v.x() * side_W_ + v.y() * Vec3::UnitZ(); }

  void raise(double height);
  void believe(const Vec3& place_W);
  void retry(double step_sd);
  bool lostIt();
  void tightenWhereItSlips();
  bool standsOnDish();
  Posture besideThePinch() const;
  double heightOnDish(double beside) const;
  double touchingHalf() const;

  ScriptedPickupOptions options_;
  bool rational_;
  PlaceBelief belief_;
  Vec3 side_W_ = Vec3::UnitY();     // across the pinch, level
  Vec3 believed_W_ = Vec3::Zero();  // place of the object's centre [m]
  Vec3 step_W_ = Vec3::Zero();      // random step from there to where the pinch is tried [m]
  double wanted_grip_ = 0;          // [N]
  double felt_factor_ = 1;          // of felt over true magnitude, in this squeeze [-]
  int shifts_ = 0;                  // in this attempt
};

}  // namespace pincer::tasks
