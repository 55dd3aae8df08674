// place_observer: somebody who rests a finger on something, lets it be rolled over it, and says where on the fingerpad the contact is.
//
//   felt place = bias s + sigma n,   s  place of the tactor on the pad [m], n standard normal, one per reading
//
// bias and sigma are those of body.h (SensingLimits), measured in the very experiment that this participant serves.
#pragma once
#include "pincer/tasks/lab/participants/body.h"
#include "pincer/tasks/lab/participants/one_finger.h"

namespace pincer::tasks {

// Where the hand is led; learnt in training, the same whatever the place.
struct PlaceCues {
  std::uint64_t seed = 0;  // of everything that varies from trial to trial within the participant
  Quat q_WD = Quat::Identity();
  Vec3 p_WD = Vec3::Zero();  // arm base [m]
  double radius = 0.12;      // of the circle about W's origin on which the fingertip's centre goes [m]
  double from = 0, to = 0;   // angles on it, from +z towards +y [rad]
};

struct PlaceLimits {
  SensingLimits common;
  double press = 1.0;                         // wanted push of the surface [N] (choice)
  double lower_time = 0.4, raise_time = 0.3;  // [s] (choice)
  double lift = 0.010;                        // of a waiting finger over the path [m] (choice)
};

class PlaceObserver final : public OneFingerObserver {
 public:
  explicit PlaceObserver(std::uint64_t seed, const PlaceLimits& limits = {}, const HandRanges& ranges = {});
  void begin(const PlaceCues& cues);
  OneFingerAction act(const FingerPercept& finger, double time, Cue cue) override;
  double answer() const { return felt_; }  // [m of arc]

 private:
  enum class Phase : std::uint8_t { kWait, kLower, kRoll, kRead, kRaise, kAnswer };
  void enter(Phase phase);
  devices::HandPull pullAt(double angle, double height) const;

  PlaceLimits limits_;
  Body body_;
  PlaceCues cues_;
  Random random_;
  Phase phase_ = Phase::kWait;
  double now_ = 0, entered_ = 0;  // [s]
  double felt_ = 0;               // [m]
};

}  // namespace pincer::tasks
