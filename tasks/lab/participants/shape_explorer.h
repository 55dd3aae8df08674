// shape_explorer: somebody who feels a solid with one finger, round its middle and over its top, and says which of seven it is.
//
//   listen - approach - follow a great circle - leave - [turn to the next circle: approach] - answer
//
// follow   the hand's aim a goes across the push that is felt, direction n, in the plane of the pass, at the finger's speed, and along n to the
//          depth at which a finger at p is pushed as hard as is wanted:   n . (p - a) = press / k,  k the hand's stiffness; where nothing is
//          felt it sinks. The pad is turned towards the middle. Passes: round the middle, over the top, over the top across.
// read     every reading time, while something is felt: the place of the fingertip and the direction of the surface,
//
//   place      p + m + sigma_p n                 m constant in a trial: placement_sd
//   direction  felt from the push on the finger, direction_sd per axis; and, where the tactor moves, from its place on the pad, s = (b a r + noise),
//              a ~ s / b r with sigma / b r and the felt orientation's error, constant in a trial; the two weighed by their variances.
//              a angle on the fingertip, r its radius, b the felt over the true place: known, as to the other participants (flat_belief.h).
//              How far the tactor goes is known from training: a place felt within sigma of there, or beyond, may be anywhere beyond, and
//              isn't taken for a direction
//
// believe  each solid known by heart (known_solids.h) has its own Gaussian over m, by a Kalman filter: were it this one, the finger would be its tip's
//          radius r away from it,   y = |q - nearest(q)| - r,  q = felt place - mean of m,  S = n' P n + sigma_p^2,  n the solid's normal at q,
//          and it gets  -y^2/2S - ln(S)/2 + ln E[exp(-angle(n, felt direction)^2 / 2 s_n^2)]  per reading, E over where the finger may be on it. The answer is the likeliest, and exploring ends
//          when it is sure.
// The reading's own noise sigma_p and the wanted sureness are ours (choice); the rest is in body.h. The same plan in every condition.
#pragma once
#include <array>
#include <optional>

#include "pincer/tasks/lab/participants/body.h"
#include "pincer/tasks/lab/participants/known_solids.h"
#include "pincer/tasks/lab/participants/one_finger.h"

namespace pincer::tasks {

struct ShapeLimits {
  SensingLimits common;
  double place_sd = 4e-3;        // sigma_p, of one reading of the finger's place, per axis [m] (choice: as between two fingers)
  double press = 0.8;            // wanted push of the surface [N] (choice)
  double sure = 0.95;            // probability of the answer that ends exploring (choice)
  int most_passes = 6;           // (choice)
  double distance = 0.075;       // of the fingertip from the middle while nothing is touched [m] (choice)
  double approach_speed = 0.05;  // [m/s] (choice)
};

// What the participant is told.
struct ShapeCues {
  std::uint64_t seed = 0;  // of everything that varies from trial to trial within the participant
  Quat q_WD = Quat::Identity();
  Vec3 p_WD = Vec3::Zero();      // arm base [m]
  Vec3 middle_W = Vec3::Zero();  // of the solid [m]
  double tip_radius = 8e-3;      // of the finger [m]
  double tactor_reach = 7.5e-3;  // largest place that the tactor can show [m]
};

// It holds its finger with the pad (-z of F) towards the middle.
class ShapeExplorer final : public OneFingerObserver {
 public:
  explicit ShapeExplorer(std::uint64_t seed, const ShapeLimits& limits = {}, const HandRanges& ranges = {});
  void begin(const ShapeCues& cues);
  OneFingerAction act(const FingerPercept& finger, double time, Cue cue) override;
  int answer() const;  // a place in kSolidNames
  double sureness() const;

 private:
  enum class Phase : std::uint8_t { kListen, kApproach, kFollow, kLeave, kTurn, kAnswer };
  struct Pass {
    Vec3 from, towards;  // unit: the circle runs from + towards
    double angle;        // [rad]
  };

  // Were it this solid.
  struct SolidBelief {
    double log_likelihood = 0;
    Vec3 misplacement_W = Vec3::Zero();  // mean [m]
    Mat3 covariance = Mat3::Zero();      // [m^2]
  };

  void enter(Phase phase);
  void believe(SolidBelief& belief, const KnownSolid& solid, const Vec3& felt_W, const Vec3& n_W, double sd_n) const;
  double likelihoodOf(const Vec3& n_W, double sd_n, const KnownSolid& solid, const Vec3& q_W, const Vec3& outward_W, double off,
                      const Mat3& covariance) const;
  void follow(const FingerPercept& finger, double dt);
  void keepTo(const Vec3& p_W, const Vec3& n_W, double dt);
  void moveAim(const Vec3& step_W, double least);
  void read(const FingerPercept& finger, const Vec3& p_W);
  std::optional<Vec3> directionOfTactor(const FingerPercept& finger, const Quat& q_WF);
  Vec3 ray() const;    // from the middle to the finger, now
  Vec3 along() const;  // across it, the way it goes
  const Pass& pass() const;
  Quat held() const;

  ShapeLimits limits_;
  Body body_;
  std::array<KnownSolid, kSolids> solids_;
  ShapeCues cues_;
  Random random_;
  Vec3 misplacement_W_ = Vec3::Zero();
  Quat q_felt_true_ = Quat::Identity();
  std::array<SolidBelief, kSolids> beliefs_{};

  Phase phase_ = Phase::kListen;
  double now_ = 0, entered_ = 0, read_at_ = 0;  // [s]
  int passes_ = 0;
  Vec3 turn_from_ = Vec3::UnitX();   // where the last pass ended, unit
  double angle_ = 0;                 // gone along the pass [rad]
  double reach_ = 0;                 // of the aim from the middle [m]
  std::optional<Vec2> first_place_;  // of the tactor, when the trial began
  bool tactor_moves_ = false;
};

}  // namespace pincer::tasks
