// place_observer: somebody who finds a touched place on the fingerpad again.
//
//   memorise  rolls the finger over a cylinder until the tactor, which a screen shows, is within a
//             tolerance of the target; holds still; Enter
//             m = (1 - k) (s1 + sigma n1)
//   match     raised, the finger comes down elsewhere on another cylinder, and rolls until it feels the same; Enter
//             s2 + sigma n2 = m
//   s1      true place of the tactor [m], k  draw of the memory towards the pad's middle [-]
//   n1, n2  standard normal, one per reading
//
// The match's error is s2 - s1. sigma from the published match: mean absolute error 1.3 mm, rebuilt to a standard
// deviation of 1.57 mm, by sqrt 2 for two readings; k from the published trend of the signed error, -0.11 mm per mm:
// both calibrated by the very experiment that this participant serves.
#pragma once
#include <array>

#include "pincer/tasks/lab/participants/body.h"
#include "pincer/tasks/lab/participants/one_finger.h"

namespace pincer::tasks {

// A cylinder under the finger, along x.
struct PlacePath {
  Vec3 centre_W = Vec3::Zero();  // [m]
  double radius = 0.108;         // of the circle on which the fingertip's centre goes [m]
  double from = 0;               // where the finger comes down, from +z towards +y [rad]
};

struct PlaceCues {
  std::uint64_t seed = 0;  // of everything that varies from trial to trial within the participant
  Quat q_WD = Quat::Identity();
  Vec3 p_WD = Vec3::Zero();  // arm base [m]
  std::array<PlacePath, 2> paths;
  double target = 0;             // on the screen [m of arc]
  double tolerance = 0.25e-3;    // [m]
  double finger_radius = 0.013;  // [m]
  double reach = 8e-3;           // of the tactor, either way [m]
};

struct PlaceLimits {
  SensingLimits common;
  double reading_sd = 1.11e-3;                // sigma [m] (calibrated)
  double memory_draw = 0.11;                  // k [-] (calibrated)
  double match_tolerance = 0.1e-3;            // nearer than this to what feels the same, the finger stays [m] (choice)
  double correction_time = 0.3;               // in which the finger goes what is left [s] (choice)
  double hold_time = 0.3;                     // within the tolerance until Enter [s] (choice)
  double press = 1.0;                         // wanted push of the surface [N] (choice)
  double lower_time = 0.4, raise_time = 0.3;  // [s] (choice)
  double lift = 0.010;                        // of a waiting finger over the path [m] (choice)
};

class PlaceObserver final : public OneFingerObserver {
 public:
  explicit PlaceObserver(std::uint64_t seed, const PlaceLimits& limits = {}, const HandRanges& ranges = {});
  void begin(const PlaceCues& cues);
  OneFingerAction act(const FingerPercept& finger, double time, Cue cue) override;

 private:
  enum class Phase : std::uint8_t { kWait, kLower, kRoll, kRaise, kAnswer };
  void enter(Phase phase);
  bool roll(double place, double goal, double tolerance);
  void remember(double place);
  const PlacePath& path() const { return cues_.paths[interval_]; }
  double heightAt(double t) const;
  devices::HandPull pullAt(double height) const;

  PlaceLimits limits_;
  Body body_;
  PlaceCues cues_;
  Random random_;
  Phase phase_ = Phase::kWait;
  std::size_t interval_ = 0;
  double now_ = 0, entered_ = 0;  // [s]
  double angle_ = 0;              // of the aim on the path [rad]
  double held_ = 0;               // within the tolerance since [s]
  double match_ = 0;              // place that will feel the same [m]
};

}  // namespace pincer::tasks
