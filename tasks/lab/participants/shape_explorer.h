// shape_explorer: somebody who feels a solid that lies with its axis from left to right, with one finger that
// points away, and says which of seven it is.
//
//   listen - approach the top - sweeps over it - answer
//
// sweeps   left to its end, right to the other, back to the middle: whether it ends round, in a point or in a
//          face; then away, towards the body, back. So did all people (Doxon 2014, ch. 2). Two rounds at the most;
//          the answer may come at the middle of any.
// follow   the hand's aim a goes across the push that is felt, direction n, in the plane of the sweep,
//          at the finger's speed, and along n to the depth at which a finger at p is pushed as hard as is wanted:
//          n . (p - a) = press / k,  k  the hand's stiffness. Where nothing is felt it sinks. The finger points away
//          and is only tilted: by a share, drawn per person, of what would keep its pad square to a ball.
// read     every reading time, while something is felt: the place of the fingertip and the direction of the surface,
//
//   place      p + m + sigma_p n                 m constant in a trial: placement_sd
//   push       its direction, direction_sd per axis
//   tactor     where it moves: its place on the pad, s = clamp(r (a - tilt), travel), a the fore-aft angle of the
//              contact, with sigma / b along the finger and the felt tilt's error, constant in a trial; b the felt over
//              the true place: known, as to the other participants (flat_belief.h). The travel's ends are known from
//              training: a place felt there tells that the contact is there or beyond
//
// believe  each way each solid may lie (known_solids.h) has its own Gaussian over m and the solid's size
//          c, whose name is known and whose size isn't, by a Kalman filter: were it this one, the finger
//          would be its tip's radius r away from it,
//
//            y = c |q/c - nearest(q/c)| - r,   H = (n, n . nearest(q/c)),   S = H' P H + sigma_p^2
//
//          q the felt place less the mean of m, n the solid's normal there; and it gets  -y^2/2S - ln(S)/2 + ln
//          E[exp(-angle(n, push)^2 / 2 s^2)] per reading, E over where the finger may be on it. Likewise the
//          fore-aft angle, by another step of the filter:
//
//            y = s - clamp(r (angle fore-aft of n - tilt), travel),   H by differences
//            S = H' P H + (s_s / |n fore-aft|)^2
//
//          but that one reading in a hundred tells nothing.
//
//          A name is as likely as all its ways together. The answer is the likeliest
//          name, and exploring ends when it is sure.
// The reading's own noise sigma_p, the sizes' error and the wanted sureness are ours (choice); the rest is in
// body.h. The same plan in every condition.
#pragma once
#include <array>
#include <optional>

#include "pincer/tasks/lab/participants/body.h"
#include "pincer/tasks/lab/participants/known_solids.h"
#include "pincer/tasks/lab/participants/one_finger.h"

namespace pincer::tasks {

struct ShapeLimits {
  SensingLimits common;
  // sigma_p, of one reading of the finger's place, per axis [m] (choice: as between two fingers)
  double place_sd = 4e-3;
  double size_sd = 0.15;              // of a solid's size, relative (choice: its name was read, it was never seen)
  double press = 0.8;                 // wanted push of the surface [N] (choice)
  double sure = 0.95;                 // probability of the answer that ends exploring (choice)
  int most_rounds = 2;                // of sweeps (choice)
  double distance = 0.09;             // of the waiting fingertip over the middle [m] (choice)
  double approach_speed = 0.05;       // [m/s] (choice)
  double tilt_min = 0, tilt_max = 1;  // of what keeps the pad square, drawn once per participant [-] (choice)
};

// Facts that the participant is told.
struct ShapeCues {
  std::uint64_t seed = 0;  // of everything that varies from trial to trial within the participant
  Quat q_WD = Quat::Identity();
  Vec3 p_WD = Vec3::Zero();      // arm base [m]
  Vec3 middle_W = Vec3::Zero();  // of the solid [m]
  double tip_radius = 0.02;      // of the finger [m]
  double tactor_reach = 8e-3;    // largest place that the tactor can show [m]
};

// It holds its finger with distal (x of F) away and tilted, the pad (-z) down.
class ShapeExplorer final : public OneFingerObserver {
 public:
  explicit ShapeExplorer(std::uint64_t seed, const ShapeLimits& limits = {}, const HandRanges& ranges = {});
  void begin(const ShapeCues& cues);
  // Allocates nothing, throws nothing.
  OneFingerAction act(const FingerPercept& finger, double time, Cue cue) override;
  int answer() const;  // a place in kSolidNames
  double sureness() const;

 private:
  enum class Phase : std::uint8_t { kListen, kApproach, kFollow, kAnswer };
  struct Sweep {
    Vec3 side;      // unit: the way from up is  angle  towards it
    double target;  // [rad]
  };
  static constexpr int kUnknowns = 4;  // misplacement and size
  using Gain = Eigen::Matrix<double, kUnknowns, 1>;
  using Spread = Eigen::Matrix<double, kUnknowns, kUnknowns>;

  // Were it this one, lying this way.
  struct SolidBelief {
    double log_likelihood = 0;
    Vec3 misplacement_W = Vec3::Zero();  // mean [m]
    double size = 1;                     // mean, of what is imagined [-]
    Spread covariance = Spread::Zero();
  };
  struct Reading {
    Vec3 p_W = Vec3::Zero();      // felt place of the fingertip from the middle [m]
    Vec3 push_W = Vec3::UnitZ();  // felt direction of the push
    std::optional<double> shown;  // felt place of the tactor over the finger's radius [rad]
    double shown_sd = 1;          // [rad]
    double tilt = 0;              // felt, of the finger [rad]
  };
  // The solid where the finger is felt to be.
  struct Meeting {
    Vec3 at;          // felt place in the imagined solid's own size
    Vec3 nearest, n;  // there
    double off = 0;   // of the finger's surface from it [m]
  };

  void enter(Phase phase);
  void follow(const FingerPercept& finger, double dt);
  void keepTo(const Vec3& p_W, const Vec3& n_W, double dt);
  void moveAim(const Vec3& step_W, double least);
  void endSweep();
  void read(const FingerPercept& finger, const Vec3& p_W);
  Meeting meet(const SolidBelief& belief, const KnownSolid& solid, const Vec3& p_W) const;
  void believe(SolidBelief& belief, const KnownSolid& solid, const Reading& reading) const;
  void believeTactor(SolidBelief& belief, const KnownSolid& solid, const Reading& reading) const;
  double tactorAngleFor(const Vec3& n_W, double tilt) const;
  double likelihoodOf(const Reading& reading, const SolidBelief& belief, const KnownSolid& solid,
                      const Meeting& meeting) const;
  void readTactor(const FingerPercept& finger, Reading& reading);
  std::array<double, kSolids> chances() const;  // of the names
  const Sweep& sweep() const;
  double direction() const;  // of the sweep: -1, +1
  Vec3 ray() const;          // from the middle to the finger, now
  Vec3 along() const;        // across it, the way it goes
  double tilt() const;       // tip up [rad]
  Quat held() const;

  ShapeLimits limits_;
  Body body_;
  double tilt_share_ = 0;
  std::vector<LyingSolid> solids_;
  ShapeCues cues_;
  Random random_;
  Vec3 misplacement_W_ = Vec3::Zero();
  double felt_tilt_error_ = 0;  // [rad]
  std::vector<SolidBelief> beliefs_;

  Phase phase_ = Phase::kListen;
  double now_ = 0, entered_ = 0, read_at_ = 0;  // [s]
  int sweeps_ = 0;                              // done
  double from_ = 0, angle_ = 0;                 // of the sweep, gone [rad]
  double reach_ = 0;                            // of the aim from the middle [m]
  std::optional<double> first_place_;           // of the tactor, when the trial began [m]
  bool tactor_moves_ = false;
};

}  // namespace pincer::tasks
