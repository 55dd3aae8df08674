// force_gate: the last stage before a motor. Whatever comes in, what goes out is finite,
// bounded and slow; any doubt is zero, latched.
//
//   trips      not finite, fault before, invalid sample, over-speed, missed deadline, stale sample: zero at once,
//              until an operator arms
//   peak       |f| <= peak_force, direction kept
//   torque     f / max(1, max_i |(J^T f)_i| / peak_torque_i): one common scale, direction kept
//   ramp       f min(1, t_armed / ramp_time)
//   thermal    |f|^2 <= f_cont^2 + (H - heat) / tau,   d heat / dt = |f|^2 - f_cont^2,   heat >= 0
//              tau = thermal_time / 10,   H = (f_peak^2 - f_cont^2) (thermal_time + tau):
//              peak_force from cold lasts thermal_time, then sinks smoothly to f_cont
//   slew       f = s + (f - s) min(1, (slew dt - |s - f_last|) / |f - s|)
//              s = f_last within the torques of now:   |f - f_last| <= slew dt
//
// in this order, behind the passivity controller of grasp/passivity (tasks/run/tick/tick.cpp). Slew comes last,
// because its bound is one on what the motor gets: a stage behind it could break it. It can delay the thermal stage
// by peak_force / slew at most. It keeps to the torque bound: both s and f do, and so does the straight line between
// them. Only where the arm moved so far within a tick that the last force overloads a joint by more than the slew
// can take back, torque wins over slew. The torque stage needs both `peak_torque` and a sample that knows its
// joints. The stages and their order are ours.
#pragma once
#include <cstdint>
#include <limits>
#include <optional>
#include <string>

#include "pincer/devices/arm/arm.h"
#include "pincer/devices/math.h"

namespace pincer::devices {

struct GateLimits {
  double peak_force = 8.5;               // [N], > 0
  double continuous_force = 1.4;         // [N], > 0
  double thermal_time = 10;              // the time that peak_force may last from cold [s], > 0
  double slew = 1000;                    // [N/s], > 0
  double ramp_time = 2;                  // from arming to full force [s], >= 0
  double top_speed = 2.0;                // of the fingertip [m/s], > 0
  double watchdog_time = 3e-3;           // oldest sample that is still trusted, longest time between two calls [s], > 0
  std::optional<Vec3> peak_torque = {};  // of the joints [N m], each > 0; absent: not limited
};

// `limits` made narrower by what the arm can do; what it doesn't tell (0, absent) stays as it is.
GateLimits within(GateLimits limits, const ArmCapabilities& arm);

// The mistake in `limits`, as a sentence with field, value and range; absent if there is none.
std::optional<std::string> problemWith(const GateLimits& limits);

enum class Trip : std::uint8_t {
  kNone,
  kNotFinite,
  kOverSpeed,
  kStaleSample,
  kInvalidSample,
  kGaveUp,
  kMissedDeadline,
  kException,
  kOperator
};
std::string describe(Trip trip);  // what happened, what it means, what to do

// State of the gate of one arm; a plain value.
struct GateState {
  bool armed = false;
  Trip trip = Trip::kNone;  // why it is latched; kNone while armed or never armed
  double tripped_at = 0;    // what was beyond its limit then: speed [m/s], age or time [s]; 0: nothing
  double armed_for = 0;     // [s]
  double heat = 0;          // integral of (f^2 - f_cont^2), >= 0 [N^2 s]
  Vec3 f_D = Vec3::Zero();  // last force let through [N]
  double sample_time = -std::numeric_limits<double>::infinity();  // of the last sample trusted since arming [s]
};

// The same of a gate that has tripped, with what was measured and its limit.
std::string describe(const GateLimits& limits, const GateState& state);

struct GateInput {
  Vec3 f_D = Vec3::Zero();   // wanted force [N]
  ArmSample sample;          // the sample that it answers
  Vec3 v_DF = Vec3::Zero();  // best estimate of the fingertip's velocity [m/s]
  double now = 0;            // on the sample's clock [s]
  double dt = 1e-3;          // since the last call [s], > 0
  bool physics_ok = true;    // false when a stage before reported a fault
};

// Only an operator arms. Clears the latch; the ramp starts anew. The heat stays: motors don't cool by being armed.
void arm(GateState& state);
// Latches zero force with a cause. The first cause stays until the next arm().
void trip(GateState& state, Trip cause);
// The force that may go to the motor [N]. |result| <= peak, |change| <= slew dt
// (but for trips: those cut to zero at once).
Vec3 gateForce(const GateLimits& limits, const GateInput& in, GateState& state);

}  // namespace pincer::devices
