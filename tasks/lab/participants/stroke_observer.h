// stroke_observer: somebody who strokes a curve to and fro with one finger, twice, and says which of the two felt rougher, or in which the
// tactor came later. Behind the wall: it is given samples of arm and display, the push on the finger and tones, nothing else.
//
//   wait - lower - stroke (n times, to and fro) - raise - read - [wait ... read] - answer
//
// It moves a hand of its own impedance at its own speed along the circle that it was told, minimum jerk, whatever is shown, and presses lightly:
// the height of its aim over the circle follows the felt push slowly, h' = (push - press) / (k tau), k the hand's stiffness.
// What it feels of an interval is one reading, drawn once, when the finger is up again:
//
//   rougher  one percept of push and tactor (roughness.h), while a stroke is in its middle
//   later    time from the hand's turn to the tactor's: until the tactor has gone back from its farthest place by what is felt of it; the
//            mean over the turns.   felt = lag + sigma n,   sigma = sqrt(sigma_t^2 + (c lag)^2)
//
// Limits: sigma_t from 60 ms, at which a delay between the hand's motion and a tactile stimulus is noticed (S. Okamoto, M. Konyo, S. Saga,
// S. Tadokoro, IEEE Trans. Haptics 2(2), 2009, 73-84), taken as the point of 75 % right answers in two intervals (choice): / 0.954. What else
// is marked (choice) is ours. None was changed to meet an outcome.
#pragma once
#include <array>
#include <cstdint>

#include "pincer/tasks/lab/participants/body.h"
#include "pincer/tasks/lab/participants/one_finger.h"
#include "pincer/tasks/lab/participants/roughness.h"

namespace pincer::tasks {

struct StrokeLimits {
  SkinLimits skin;
  SensingLimits common;
  double tactor_weight = 0.75;                // w, of touch beside force (roughness.h) [-] (choice)
  double lag_sigma = 0.0629;                  // sigma_t [s]: 60 ms / 0.954 (Okamoto et al. 2009)
  double lag_difference = 0.15;               // c, of a short time [-] (choice)
  double sensitivity_spread = 0.2;            // people differ: all noise times exp(spread n), n drawn once per participant (choice)
  double press = 1.0;                         // wanted push of the surface [N] (choice)
  double press_time = 0.2;                    // tau [s] (choice)
  double lower_time = 0.4, raise_time = 0.3;  // [s] (choice)
  double lift = 0.010;                        // of a waiting finger over the path [m] (choice)
};

enum class StrokeQuestion : std::uint8_t { kRougher, kLater };

// What the participant is told; learnt in training.
struct StrokeCues {
  std::uint64_t seed = 0;  // of everything that varies from trial to trial within the participant
  Quat q_WD = Quat::Identity();
  Vec3 p_WD = Vec3::Zero();      // arm base [m]
  Vec3 centre_W = Vec3::Zero();  // of the circle on which the fingertip's centre goes, in the plane x = centre_W.x [m]
  double radius = 0.12;          // of that circle [m]
  double half_angle = 0.4;       // strokes run between -half_angle and +half_angle from +z [rad]
  int strokes = 4;               // per interval
  StrokeQuestion question = StrokeQuestion::kRougher;
};

class StrokeObserver final : public OneFingerObserver {
 public:
  // `seed` makes the participant: hand, speed, sensitivity.
  explicit StrokeObserver(std::uint64_t seed, const StrokeLimits& limits = {}, const HandRanges& ranges = {});

  void begin(const StrokeCues& cues);
  OneFingerAction act(const FingerPercept& finger, double time, Cue cue) override;
  int answer() const { return compared(); }  // 1 or 2: the interval named

 private:
  enum class Phase : std::uint8_t { kWait, kLower, kStroke, kRaise, kRead, kAnswer };
  void enter(Phase phase);
  void follow(OneFingerAction& action);
  void feel(const FingerPercept& finger);
  void feelTurn(double place);
  void readInterval();
  int compared() const;
  double strokeTime() const { return 2 * cues_.half_angle * cues_.radius / body_.speed; }
  devices::HandPull pullAt(double angle, double height) const;

  StrokeLimits limits_;  // this participant's
  Body body_;
  StrokeCues cues_;
  Random random_;
  RoughnessSense roughness_;
  std::array<double, 2> felt_lags_{};  // [s]

  Phase phase_ = Phase::kWait;
  double now_ = 0, entered_ = 0;  // [s]
  double push_ = 0;               // felt along the path normal [N]
  double height_ = 0;             // of the aim over the path, while stroking [m]
  int interval_ = 0, stroke_ = 0;
  int way_ = 0;           // of the tactor in the last stroke: +1, -1, 0 not known
  double turned_at_ = 0;  // its place at the last turn [m]
  double farthest_ = 0;   // its farthest place since [m]
  bool turning_ = false;  // a stroke has just begun
  bool returned_ = true;  // the turn has been felt
  double lags_ = 0;       // sum over the turns [s]
  int turns_ = 0;
};

}  // namespace pincer::tasks
