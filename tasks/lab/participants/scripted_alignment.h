// scripted_alignment: a participant who finds the flat of an upright cylinder between index finger and thumb, without
// seeing it, and turns it towards the monitor.
//
//   listen - reach - close - read -+- (probe elsewhere: open - reach - close - read)
//                                  +- (turn: open - reach - close - squeeze - turn - open, then probe again)
//                                  '- answer - return - rest
//
// probe    pinch the cylinder at an angle, hold still and read: where the fingertips are, where the pushes come from,
//          and where the contacts are on the pads (where the tactors stand still there is nothing to read). Three
//          pinches first; more while the direction of the flat is known no better than `sure`; each at the angle that
//          brings a finger nearest to where the flat is believed to be
// turn     pinch, squeeze to `turn_grip`, move the fingers about the axis, at most from
//          one end of the hand's reach to the other
// answer   when the flat is nearer to where the monitor is felt than the direction of
//          the flat is known, or than `close_enough`
// The belief is one over the flat and over the hand's own misplacement
// (flat_belief.h). The same plan in every condition.
//
// `simple`: no belief over the misplacement; the flat is where a finger came nearest to where the axis is
// told to be, or, where a tactor moved, where the pads of the fingers said the normal was; one sweep of
// probes after every turn, two turns at most.
#pragma once
#include "pincer/tasks/lab/participants/flat_belief.h"
#include "pincer/tasks/lab/participants/scripted_hand.h"

namespace pincer::tasks {

struct ScriptedAlignmentOptions {
  double settle_time = 1.0;    // in which the hand drifts to where it believes its place to be [s] (choice)
  double clearance = 0.012;    // between fingertip and surface when the hand is open [m] (choice)
  double close_speed = 0.032;  // [m/s], the slowest that Doxon (2014) measured
  double contact_time = 0.05;  // both fingers must feel something for so long [s] (choice)
  double reach_angle = 0.96;   // that the hand can turn either way [rad], 55 degrees (choice)
  double sure = 0.21;          // [rad], 12 degrees (choice)
  double close_enough = 0.07;  // [rad], 4 degrees (choice)
  int most_probes = 7;         // after a turn (choice)
  int most_turns = 6;          // (choice)
  double turn_grip = 2.0;      // [N] (choice)
  double squeeze_rate = 4.0;   // [N/s] (choice)
  double turn_error = 0.10;    // of a felt turn, relative, SD (choice)
  double probe_sd = 0.05;      // a probe may turn the cylinder, SD [rad], 3 degrees (choice)
  double patience = 4.0;       // without finding both fingers a contact, then reach again [s] (choice)
};

class ScriptedAlignment final : public ScriptedHand {
 public:
  // `seed` makes the participant: hands, speed, and where the monitor is felt. What varies
  // between trials comes from the trial's own seed.
  ScriptedAlignment(std::uint64_t seed, bool simple, const ScriptedAlignmentOptions& options = {},
                    const SensingLimits& limits = {}, const HandRanges& ranges = {});

  void begin(const TrialCues& cues) override;

 private:
  void listen() override;
  void goAlong() override;
  void close() override;
  void read() override;
  void squeeze() override;
  void turn() override;
  void ended() override;
  void mean(HandIntent& intent) const override;

  void openThenReach(double angle);
  void observe();
  void decide();
  void probe(double angle, const char* why);
  double anglesFacing(double direction);
  double believedDirection() const;
  double believedSpread() const;
  Vec3 centre_W() const;
  double openHalf() const;

  bool simple_;
  ScriptedAlignmentOptions options_;
  double target_shared_ = 0;  // of where the monitor is felt [rad]
  FlatBelief belief_;
  bool opening_ = false;   // the reach under way only opens the hand
  double next_angle_ = 0;  // and then the hand goes there [rad]
  bool answers_ = false;
  double target_ = 0;     // where the monitor is felt [rad]
  bool turning_ = false;  // the next pinch is to turn
  double turn_by_ = 0;    // [rad]
  int probes_ = 0, turns_ = 0;
  double simple_best_ = 0, simple_direction_ = 0;  // smallest felt distance from the axis [m], and where
};

}  // namespace pincer::tasks
