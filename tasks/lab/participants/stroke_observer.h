// stroke_observer: somebody who strokes a curve along one finger, twice, and says which of the two felt
// rougher, had more play or more delay. Behind the wall: it is given samples of arm and display, the
// push on the finger and tones, nothing else.
//
//   rougher   wait - lower - strokes to and fro - raise - read; one percept of push and tactor
//             (roughness.h), while a stroke is in its middle
//   looser    each stroke ends in a stop; the finger goes back a small way of its choosing,
//             stops, and feels both ways (stroke_senses.h)
//   later     each stroke ends in a stop, quick, at which the tactor's motion is felt while the finger rests
//   onset     each stroke begins from rest on one side and ends with the finger raised: the tactor's
//             start is felt during the hand's own motion
//
// It moves a hand of its own impedance along the circle that it was told and presses lightly: the height of its aim
// over the circle follows the felt push slowly, h' = (push - press) / (k tau), k the hand's stiffness. Strokes are of
// minimum jerk, or, where a stop is felt, of even speed with ramps. The longer the way the faster, but not in
// proportion: mean speed = own speed sqrt(way / 0.1 m) (isochrony; P. Viviani, G. McCollum, Neuroscience 10, 1983,
// from memory; the root is a choice). Where the arm lets the finger turn, it rolls: its pitch is a share of its angle
// on the circle, drawn per person, so that the tactor goes further than the finger takes it. What is marked (choice)
// is ours; none was changed to meet an outcome.
#pragma once
#include <array>
#include <cstdint>

#include "pincer/tasks/lab/participants/body.h"
#include "pincer/tasks/lab/participants/one_finger.h"
#include "pincer/tasks/lab/participants/roughness.h"
#include "pincer/tasks/lab/participants/stroke_senses.h"

namespace pincer::tasks {

struct StrokeLimits {
  SkinLimits skin;
  SensingLimits common;
  LagLimits lag;
  double tactor_weight = 0.75;  // w, of touch beside force (roughness.h) [-] (choice)
  // people differ: all noise times exp(spread n), n drawn once per participant (choice)
  double sensitivity_spread = 0.2;
  double press = 1.0;                          // wanted push of the surface [N] (choice)
  double press_time = 0.2;                     // tau [s] (choice)
  double lower_time = 0.4, raise_time = 0.3;   // [s] (choice)
  double lift = 0.013;                         // of a waiting finger over the path [m] (choice)
  double ramp_time = 0.1;                      // of a stroke of even speed, at either end [s] (choice)
  double rest_time = 0.7;                      // at a stop [s]: longer than any delay shown (choice)
  double probe_min = 4e-3, probe_max = 10e-3;  // the way back, drawn once per participant [m] (choice)
  double roll_min = 0, roll_max = 1;           // pitch per angle on the circle, drawn once per participant [-] (choice)
};

enum class StrokeQuestion : std::uint8_t { kRougher, kLooser, kLater, kOnset };

// Facts that the participant is told; learnt in training.
struct StrokeCues {
  std::uint64_t seed = 0;  // of everything that varies from trial to trial within the participant
  Quat q_WD = Quat::Identity();
  Vec3 p_WD = Vec3::Zero();      // arm base [m]
  Vec3 centre_W = Vec3::Zero();  // of the circle on which the fingertip's centre goes, in the plane x = centre_W.x [m]
  double radius = 0.12;          // of that circle [m]
  // strokes run between -half_angle and +half_angle from +z towards +y, of who doesn't roll the finger [rad]
  double half_angle = 0.4;
  double tactor_gain = 0.02 / 0.12;  // way of the tactor per way of the finger's centre, of who doesn't roll it [-]
  bool rolls = false;                // the arm lets the finger turn
  int strokes = 4;                   // per interval
  StrokeQuestion question = StrokeQuestion::kRougher;
};

class StrokeObserver final : public OneFingerObserver {
 public:
  // `seed` makes the participant: hand, speed, sensitivity, ways of stroking.
  explicit StrokeObserver(std::uint64_t seed, const StrokeLimits& limits = {}, const HandRanges& ranges = {});

  void begin(const StrokeCues& cues);
  OneFingerAction act(const FingerPercept& finger, double time, Cue cue) override;
  int answer() const;  // 1 or 2: the interval named
  double roll() const { return cues_.rolls ? roll_ : 0; }

 private:
  enum class Phase : std::uint8_t { kWait, kLower, kTouch, kStroke, kStopped, kProbe, kBack, kRaise, kRead, kAnswer };

  void enter(Phase phase);
  void setOut(double to, double way_time);
  void startStroke();
  void next();
  void follow(OneFingerAction& action);
  bool phaseOver(double t) const;
  void endPhase(OneFingerAction& action);
  void endStroke();
  void endStop();
  void endReading(OneFingerAction& action);
  void feel(const FingerPercept& finger);
  void readInterval();
  bool isTouching() const { return phase_ >= Phase::kTouch && phase_ <= Phase::kBack; }
  double halfAngle() const { return cues_.half_angle / (1 + roll()); }
  double timeFor(double angle) const;
  double angleAt(double t) const;
  double heightAt(double t);
  devices::HandPull pullAt(double angle, double height) const;

  StrokeLimits limits_;  // this participant's
  Body body_;
  double roll_ = 0, probe_ = 0;  // [-], [m]
  StrokeCues cues_;
  Random random_;
  RoughnessSense roughness_;
  PlaySense play_;
  DelaySense delay_;

  Phase phase_ = Phase::kWait;
  double now_ = 0, entered_ = 0;    // [s]
  double from_ = 0, to_ = 0;        // of the movement [rad]
  double way_time_ = 1;             // that it takes [s]
  double push_ = 0;                 // felt along the path normal [N]
  double height_ = 0;               // of the aim over the path, while touching [m]
  double finger_ = 0, tactor_ = 0;  // where they are: along the path, on the pad [m]
  int interval_ = 0, stroke_ = 0;
};

}  // namespace pincer::tasks
