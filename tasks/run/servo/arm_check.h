// arm_check: does an arm of any kind do what a session needs? A few seconds, which nobody wears:
//
//   rest    [0, kRest)      forces off: samples, their ages, the device's rate, noise
//   push    [kRest, end)    armed: a weak spring pulls the tip 15 mm along D's z and back;
//                           f = k (p_target - p) - b v, |f| <= force
//
// The spring ends by itself what a constant force on a free arm wouldn't: it never runs into a stop. All of it goes
// through the gate, with limits narrower than a session's: half a newton, half a metre per second.
#pragma once
#include <string>
#include <vector>

#include "pincer/devices/gate/force_gate.h"
#include "pincer/tasks/run/servo/hand_devices.h"
#include "pincer/tasks/run/servo/histogram.h"
#include "pincer/tasks/run/servo/servo.h"

namespace pincer::tasks {

struct ArmCheckOptions {
  double force = 0.3;      // at most [N], 0 .. 0.5; 0: forces stay off
  double watchdog = 5e-3;  // as of a session [s]
};

struct ArmFindings {
  std::string arm;
  std::int64_t ticks = 0, valid = 0, fresh = 0;  // fresh: with a new time
  Histogram ages;                                // of samples at the tick [s]
  double noise = 0;                              // farthest from the first place while at rest [m]
  double smallest_step = 0;                      // between two places; 0: it never moved [m]
  double moved = 0;                              // along z while pushed [m]
  double speed_error = 0;  // rms of the told velocity against differences over 10 ms; of arms that tell [m/s]
  bool tells_speed = false;
  double strongest = 0;  // force let through [N]
  std::string trip;      // what the gate said, empty: nothing
};

class ArmCheck final : public ServoCycle {
 public:
  static constexpr double kRest = 1, kPushed = 2.6;  // [s]

  ArmCheck(HandDevices& devices, int arms, const ArmCheckOptions& options);
  bool tick(double now) override;
  void cutForces() noexcept override;
  const std::vector<ArmFindings>& findings() const { return findings_; }

 private:
  struct Past {
    std::vector<Vec3> places;  // of the last 10 ticks, in turn
    Vec3 first = Vec3::Zero(), v = Vec3::Zero();
    double time = -1, squares = 0;
    std::int64_t seen = 0, speeds = 0;
  };
  void drive(std::size_t arm, double now);
  void learn(std::size_t arm, const devices::ArmSample& sample, double now);
  void learnSpeed(std::size_t arm, const devices::ArmSample& sample);
  Vec3 pull(std::size_t arm, const devices::ArmSample& sample, double now) const;

  HandDevices& devices_;
  ArmCheckOptions options_;
  std::vector<devices::GateLimits> limits_;
  std::vector<devices::GateState> gates_;
  std::vector<ArmFindings> findings_;
  std::vector<Past> past_;
  std::int64_t epoch_ns_ = 0;
  bool begun_ = false, armed_ = false;
};

// The findings in words, and what is odd in them: one sentence each, with a remedy; none: the arm is fit for a session.
std::string armCheckText(const ArmFindings& findings);
std::vector<std::string> oddities(const ArmFindings& findings, const ArmCheckOptions& options);

}  // namespace pincer::tasks
