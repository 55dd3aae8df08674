#include "pincer/devices/gate/force_gate.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace pincer::devices {
namespace {

// Rounding must not carry a force over its bound.
constexpr double kJustBelow = 1 - 4 * std::numeric_limits<double>::epsilon();

// `v` shortened to `longest` with its direction kept; safe where |v|^2 overflows.
Vec3 shortened(const Vec3& v, double longest) {
  const double largest = v.cwiseAbs().maxCoeff();
  if (largest <= longest && v.norm() <= longest) return v;
  return (v / largest).normalized() * (longest * kJustBelow);
}

// `f` scaled so that no joint bears more than its torque; safe where J^T f overflows, because |f| is bounded before.
Vec3 withinTorque(const GateLimits& limits, const ArmSample& sample, const Vec3& f) {
  if (!limits.peak_torque || !sample.J) return f;
  const double load = (sample.J->transpose() * f).cwiseQuotient(*limits.peak_torque).cwiseAbs().maxCoeff();
  if (load <= 1) return f;
  return std::isfinite(load) ? Vec3(f * (kJustBelow / load)) : Vec3::Zero();
}

bool clockIsSound(const GateLimits& limits, double dt) { return dt > 0 && dt <= limits.watchdog_time; }

bool isFresh(const GateLimits& limits, const GateInput& in, double newest) {
  return std::abs(in.now - in.sample.time) <= limits.watchdog_time && in.sample.time >= newest;
}

// Comparisons are written so that NaN trips.
Trip findTrip(const GateLimits& limits, const GateInput& in, const GateState& state) {
  if (!in.f_D.allFinite() || !in.v_DF.allFinite()) return Trip::kNotFinite;
  if (!in.physics_ok) return Trip::kException;
  if (!in.sample.valid) return in.sample.gave_up ? Trip::kGaveUp : Trip::kInvalidSample;
  if (!isFinite(in.sample)) return Trip::kNotFinite;
  if (!(in.v_DF.norm() <= limits.top_speed)) return Trip::kOverSpeed;
  if (!clockIsSound(limits, in.dt)) return Trip::kMissedDeadline;
  if (!isFresh(limits, in, state.sample_time)) return Trip::kStaleSample;
  return Trip::kNone;
}

// The measured value that was beyond its limit.
double measuredAt(Trip cause, const GateInput& in) {
  if (cause == Trip::kOverSpeed) return in.v_DF.norm();
  if (cause == Trip::kMissedDeadline) return in.dt;
  return cause == Trip::kStaleSample ? in.now - in.sample.time : 0;
}

double ramp(const GateLimits& limits, double armed_for) {
  return armed_for < limits.ramp_time ? armed_for / limits.ramp_time : 1.0;
}

// The force that the motors can bear now [N].
double thermalForce(const GateLimits& limits, double heat) {
  const double continuous = limits.continuous_force * limits.continuous_force;
  const double excess = std::max(0.0, limits.peak_force * limits.peak_force - continuous);
  const double tau = limits.thermal_time / 10;
  const double budget = excess * (limits.thermal_time + tau);
  return std::sqrt(continuous + std::clamp((budget - heat) / tau, 0.0, excess));
}

double heatAfter(const GateLimits& limits, double heat, const Vec3& f_D, double dt) {
  return std::max(0.0, heat + (f_D.squaredNorm() - limits.continuous_force * limits.continuous_force) * dt);
}

// From the last force towards `f`, within what this tick may change and what the joints bear now.
Vec3 slewed(const GateLimits& limits, const GateInput& in, const Vec3& last, const Vec3& f) {
  const Vec3 start = withinTorque(limits, in.sample, last);
  return start + shortened(f - start, std::max(0.0, limits.slew * in.dt - (start - last).norm()));
}

Vec3 shaped(const GateLimits& limits, const GateInput& in, const GateState& state) {
  Vec3 f = withinTorque(limits, in.sample, shortened(in.f_D, limits.peak_force));
  f *= ramp(limits, state.armed_for);
  f = shortened(f, thermalForce(limits, state.heat));
  f = shortened(slewed(limits, in, state.f_D, f), limits.peak_force);
  return withinTorque(limits, in.sample, f);
}

struct TripWords {
  const char* what;
  const char* remedy;
};

// For trips that a busy computer causes.
constexpr const char* kBusyRemedy =
    "close other programs, permit real-time priority (docs/devices/setup.md), or allow longer stalls with --watchdog; "
    "then arm again.";

TripWords wordsOf(Trip trip) {
  switch (trip) {
    case Trip::kNone:
      return {"No trip", "forces are on, or were never armed; arm the arm to feel forces."};
    case Trip::kNotFinite:
      return {"A force, velocity or position was not a number", "keep the log, then arm again."};
    case Trip::kOverSpeed:
      return {"The fingertip was too fast", "hold the arm, then arm again."};
    case Trip::kStaleSample:
      return {"The arm's last sample was too old, or its clock ran backward",
              "check the arm's cable; if the computer is busy, close other programs, permit real-time priority "
              "(docs/devices/setup.md), or "
              "allow "
              "older samples with --watchdog; then arm again."};
    case Trip::kInvalidSample:
      return {"The arm's sample was marked unusable", "check cable and power (pincer devices list), then arm again."};
    case Trip::kGaveUp:
      return {"The arm took its force away by itself, because no command came before its deadline", kBusyRemedy};
    case Trip::kMissedDeadline:
      return {"The servo loop stalled", kBusyRemedy};
    case Trip::kException:
      return {"The simulation reported a fault", "read the log, then arm again."};
    case Trip::kOperator:
      return {"The operator switched the forces off", "arm again to feel forces."};
  }
  return {"Unknown trip", "arm again."};
}

std::string sentence(Trip trip, const std::string& measured) {
  const TripWords words = wordsOf(trip);
  return fmt::format("{}{}{}: {}", words.what, measured, trip == Trip::kNone ? "" : ". Forces are zero and stay so",
                     words.remedy);
}

}  // namespace

GateLimits within(GateLimits limits, const ArmCapabilities& arm) {
  if (arm.peak_force > 0) limits.peak_force = std::min(limits.peak_force, arm.peak_force);
  if (arm.continuous_force > 0) limits.continuous_force = std::min(limits.continuous_force, arm.continuous_force);
  if (arm.peak_torque)
    limits.peak_torque = limits.peak_torque ? limits.peak_torque->cwiseMin(*arm.peak_torque) : *arm.peak_torque;
  return limits;
}

std::optional<std::string> problemWith(const GateLimits& limits) {
  const auto wrong = [](const char* field, double value, const char* range) {
    return std::string(field) + " = " + std::to_string(value) + " is out of range " + range +
           ". Take the arm's data sheet.";
  };
  const auto positive = [](double value) { return value > 0 && std::isfinite(value); };
  if (!positive(limits.peak_force)) return wrong("peak_force", limits.peak_force, "(0, inf) N");
  if (!positive(limits.continuous_force)) return wrong("continuous_force", limits.continuous_force, "(0, inf) N");
  if (!positive(limits.thermal_time)) return wrong("thermal_time", limits.thermal_time, "(0, inf) s");
  if (!positive(limits.slew)) return wrong("slew", limits.slew, "(0, inf) N/s");
  if (!(limits.ramp_time >= 0 && std::isfinite(limits.ramp_time)))
    return wrong("ramp_time", limits.ramp_time, "[0, inf) s");
  if (!positive(limits.top_speed)) return wrong("top_speed", limits.top_speed, "(0, inf) m/s");
  if (!positive(limits.watchdog_time)) return wrong("watchdog_time", limits.watchdog_time, "(0, inf) s");
  for (int i = 0; limits.peak_torque && i < 3; ++i) {
    if (!positive((*limits.peak_torque)[i])) return wrong("peak_torque", (*limits.peak_torque)[i], "(0, inf) N m");
  }
  return std::nullopt;
}

std::string describe(Trip trip) { return sentence(trip, ""); }

std::string describe(const GateLimits& limits, const GateState& state) {
  const auto measured = [&](double scale, const char* unit, double limit) {
    return fmt::format(" ({:.3g} {}, limit {:.3g})", scale * state.tripped_at, unit, scale * limit);
  };
  if (state.tripped_at == 0) return describe(state.trip);
  if (state.trip == Trip::kOverSpeed) return sentence(state.trip, measured(1, "m/s", limits.top_speed));
  return sentence(state.trip, measured(1e3, "ms", limits.watchdog_time));
}

void arm(GateState& state) {
  const double heat = state.heat;
  state = GateState{};
  state.armed = true;
  state.heat = heat;
}

void trip(GateState& state, Trip cause) {
  state.armed = false;
  if (state.trip == Trip::kNone) state.trip = cause;
  state.f_D = Vec3::Zero();
}

Vec3 gateForce(const GateLimits& limits, const GateInput& in, GateState& state) {
  if (state.armed) {
    const Trip cause = findTrip(limits, in, state);
    if (cause != Trip::kNone) {
      trip(state, cause);
      state.tripped_at = measuredAt(cause, in);
    }
  }
  if (state.armed) {
    state.sample_time = in.sample.time;
    state.armed_for += in.dt;
    state.f_D = shaped(limits, in, state);
  } else {
    state.f_D = Vec3::Zero();
  }
  if (clockIsSound(limits, in.dt)) state.heat = heatAfter(limits, state.heat, state.f_D, in.dt);
  return state.f_D;
}

}  // namespace pincer::devices
