// force_gate: the last stage before a motor. Whatever comes in, what goes out is finite, bounded and slow enough; any doubt is zero, latched.
//
// In this order: finiteness, peak (vector clamp that keeps the direction), slew, ramp after arming, thermal i^2 t to the continuous force,
// over-speed, watchdog. (Passivity joins the order with grasp/'s observer; joint torques with the arms that report theirs.)
#pragma once
#include <cstdint>
#include <optional>
#include <string>

#include "devices/arm/arm.h"
#include "devices/math.h"

namespace pincer::devices {

struct GateLimits {
  double peak_force = 8.5;         // [N], > 0
  double continuous_force = 1.4;   // [N], > 0
  double thermal_time = 10;        // the time that peak_force may last from cold [s], > 0
  double slew = 1000;              // [N/s], > 0
  double ramp_time = 2;            // from arming to full force [s], >= 0
  double top_speed = 2.0;          // of the fingertip [m/s], > 0
  double watchdog_time = 3e-3;     // oldest sample that is still trusted [s], > 0
};

enum class Trip : std::uint8_t { kNone, kNotFinite, kOverSpeed, kStaleSample, kInvalidSample, kMissedDeadline, kException, kOperator };
std::string describe(Trip trip);   // one sentence: what happened, what it means, what to do

// State of the gate of one arm; a plain value.
struct GateState {
  bool armed = false;
  Trip trip = Trip::kNone;         // why it is latched; kNone while armed or never armed
  double armed_for = 0;            // [s]
  double heat = 0;                 // integral of (f^2 - f_cont^2), >= 0 [N^2 s]
  Vec3 f_D = Vec3::Zero();         // last force let through [N]
};

struct GateInput {
  Vec3 f_D = Vec3::Zero();         // wanted force [N]
  ArmSample sample;                // the sample that it answers
  Vec3 v_DF = Vec3::Zero();        // best estimate of the fingertip's velocity [m/s]
  double now = 0;                  // on the sample's clock [s]
  double dt = 1e-3;                // since the last call [s], > 0
  bool physics_ok = true;          // false when a stage before reported a fault
};

// Only an operator arms. Clears the latch; the ramp starts anew.
void arm(GateState& state);
// Latches zero force with a cause.
void trip(GateState& state, Trip cause);
// The force that may go to the motor [N]. |result| <= peak, |change| <= slew dt (but for trips: those cut to zero at once).
Vec3 gateForce(const GateLimits& limits, const GateInput& in, GateState& state);

}  // namespace pincer::devices
