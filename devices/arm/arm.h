// arm: a force-feedback arm that carries one fingertip. Back-ends implement Arm; nobody else does.
//
// Positions and forces are in the arm's own base frame D (x right, y up, z towards the operator for a Premium-like
// arm); the base pose X_WD is calibration data of the scene.
#pragma once
#include <cstdint>
#include <optional>
#include <string>

#include "pincer/devices/math.h"

namespace pincer::devices {

enum class DeviceState : std::uint8_t { kClosed, kConnecting, kHoming, kReady, kFaulted };
std::string nameOf(DeviceState state);

// Abilities of a device; constants of its type.
struct ArmCapabilities {
  double peak_force = 0;            // [N]
  double continuous_force = 0;      // [N], bearable for ever
  double resolution = 0;            // of position at the tip [m]
  double stiffness_limit = 0;       // that the arm renders stably [N/m]
  double rate = 1000;               // of samples [Hz]
  std::optional<Vec3> peak_torque;  // of the joints [N m], of arms that tell
  std::optional<double> tip_mass;   // the least felt at the tip [kg], of arms that tell
  double tip_damping = 0;           // the least viscous friction at the tip [N s/m], 0: not told
  Vec3 workspace_min_D = Vec3::Zero(), workspace_max_D = Vec3::Zero();  // [m]
};

// One reading. What a device can't measure is absent, never zero.
struct ArmSample {
  double time = 0;           // device clock [s]
  bool valid = false;        // false: nothing in here may be used
  bool gave_up = false;      // the device took its force away by itself after it was armed: its deadline passed
  Vec3 p_DF = Vec3::Zero();  // fingertip centre [m]
  std::optional<Vec3> v_DF;  // measured velocity [m/s]
  std::optional<Quat> q_DF;  // gimbal orientation
  std::optional<std::uint32_t> switches;  // bit per button
  std::optional<Mat3> J;                  // d p_DF / d q [m/rad], of arms whose joints are known; tau = J^T f_D
};

// True if every number in `sample` that is there is one.
bool isFinite(const ArmSample& sample);

class Arm {
 public:
  virtual ~Arm() = default;
  virtual std::string identity() const = 0;  // make, model, serial number
  virtual const ArmCapabilities& capabilities() const = 0;
  virtual DeviceState state() const = 0;
  // The latest sample; never blocks. Real time only through the caller's clock.
  virtual ArmSample sample() = 0;
  // Force on the finger [N], in D. Only the gate (devices/gate) calls it.
  virtual void commandForce(const Vec3& f_D) = 0;
  // The operator armed the gate: an arm with a latch of its own may take forces again.
  virtual void arm() {}
  // Zero force at once, from any thread, until arm(): for who finds that the servo doesn't answer.
  virtual void stop() noexcept {}
};

}  // namespace pincer::devices
