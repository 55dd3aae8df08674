#include "pincer/grasp/passivity.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "pincer/contact/error.h"
#include "pincer/contact/functions/invariants.h"

namespace pincer::grasp {
namespace {

void checkPassivityRange(const char* what, double value, double low, double high, const char* remedy) {
  if (value >= low && value <= high) return;
  throw InputError(fmt::format("passivity: {} = {} is out of range [{}, {}]. {}", what, value, low, high, remedy));
}

// Energy that a force scaled by s pays out in the coming tick: linear s + quadratic s^2 [J].
struct Flow {
  double linear = 0, quadratic = 0;
  double whole() const { return linear + quadratic; }
};

ArmPort armOf(const PassivityOptions& options, std::size_t finger) {
  return finger < options.arms.size() ? options.arms[finger] : ArmPort{};
}

// Of finger i.
Flow flowOf(const PassivityOptions& options, const PassivityState& state, std::size_t i, const Vec3& f_W, double h) {
  const PortState& port = state.ports[i];
  PINCER_ASSERT(armOf(options, i).mass > 0);
  const double mobility = 0.5 * h / armOf(options, i).mass;
  return {h * f_W.dot(port.v_W + mobility * port.f_held_W), h * mobility * f_W.squaredNorm()};
}

// The largest scale, at most 1, with which no more than `allowed` >= 0 flows out.
double scaleFor(const Flow& flow, double allowed) {
  PINCER_ASSERT(!(allowed < 0));
  if (!(flow.whole() > allowed)) return 1;
  if (flow.quadratic <= 0) return allowed / flow.linear;
  const double root = std::sqrt(flow.linear * flow.linear + 4 * flow.quadratic * allowed);
  // the form that doesn't cancel
  const double s = flow.linear > 0 ? 2 * allowed / (flow.linear + root) : (root - flow.linear) / (2 * flow.quadratic);
  return std::min(s, 1.0);
}

// Dissipates up to `deficit` in the coming tick.
bool damp(const PassivityOptions& options, double h, double deficit, PortState& port, Vec3& f_W) {
  const double v2 = port.v_W.squaredNorm();
  if (!(deficit > 0) || v2 < options.still_speed * options.still_speed) return false;
  const double alpha = std::min(deficit / (h * v2), options.most_damping);
  f_W -= alpha * port.v_W;
  port.damped += alpha * h * v2;
  return alpha > 0;
}

void scale(double s, double flow, PortState& port, Vec3& f_W) {
  f_W *= s;
  port.withheld += (1 - s) * flow;
}

bool boundEach(const PassivityOptions& options, double h, PassivityState& state, std::span<Vec3> f_W) {
  bool acted = false;
  for (std::size_t i = 0; i < f_W.size(); ++i) {
    const Flow flow = flowOf(options, state, i, f_W[i], h);
    const double s = scaleFor(flow, std::max(state.ports[i].balance, 0.0));
    if (s < 1) scale(s, flow.whole(), state.ports[i], f_W[i]);
    acted |= s < 1;
  }
  return acted;
}

bool boundSum(const PassivityOptions& options, double h, PassivityState& state, std::span<Vec3> f_W) {
  Flow out;
  double allowed = state.balance;
  for (std::size_t i = 0; i < f_W.size(); ++i) {
    const Flow flow = flowOf(options, state, i, f_W[i], h);
    if (flow.whole() > 0) {
      out.linear += flow.linear;
      out.quadratic += flow.quadratic;
    } else {
      allowed -= flow.whole();
    }
  }
  const double s = scaleFor(out, std::max(allowed, 0.0));
  if (!(s < 1)) return false;
  for (std::size_t i = 0; i < f_W.size(); ++i) {
    const double flow = flowOf(options, state, i, f_W[i], h).whole();
    if (flow > 0) scale(s, flow, state.ports[i], f_W[i]);
  }
  return true;
}

// The missing energy, shared out by that which each finger gave, or would give, by itself.
bool dampSum(const PassivityOptions& options, double h, PassivityState& state, std::span<Vec3> f_W) {
  const auto own = [&](std::size_t i) {
    return std::max(flowOf(options, state, i, f_W[i], h).whole() - state.ports[i].balance, 0.0);
  };
  double missing = -state.balance, given = 0;
  for (std::size_t i = 0; i < f_W.size(); ++i) {
    missing += flowOf(options, state, i, f_W[i], h).whole();
    given += own(i);
  }
  if (!(missing > 0 && given > 0)) return false;
  bool acted = false;
  for (std::size_t i = 0; i < f_W.size(); ++i)
    acted |= damp(options, h, missing * own(i) / given, state.ports[i], f_W[i]);
  return acted;
}

bool dampEach(const PassivityOptions& options, double h, PassivityState& state, std::span<Vec3> f_W) {
  bool acted = false;
  for (std::size_t i = 0; i < f_W.size(); ++i) {
    PortState& port = state.ports[i];
    acted |= damp(options, h, flowOf(options, state, i, f_W[i], h).whole() - port.balance, port, f_W[i]);
  }
  return acted;
}

}  // namespace

void check(const PassivityOptions& options) {
  checkPassivityRange("most_damping", options.most_damping, 0, 1000, "In N s/m; arms of 50 g bear about 30 at 1 kHz.");
  checkPassivityRange("still_speed", options.still_speed, 1e-9, 1, "In m/s; 1e-4 is the usual one.");
  checkPassivityRange("reserve", options.reserve, 0, 1e3,
                      "In joules; 0 unless fingers are to lower what begins high up.");
  for (const ArmPort& arm : options.arms) {
    checkPassivityRange("mass of an arm", arm.mass, 1e-4, 100,
                        "In kilograms, at the tip; a Phantom Premium has 0.03 to 0.15.");
    checkPassivityRange("damping of an arm", arm.damping, 0, 1000, "In N s/m; 0 if nobody measured it.");
  }
}

double PassivityState::energy() const {
  double sum = 0;
  for (const PortState& port : ports) sum += port.energy;
  return sum;
}

void observePorts(const PassivityOptions& options, std::span<const Vec3> p_WF, double stored, double h,
                  PassivityState& state) {
  PINCER_DEMAND(p_WF.size() == state.ports.size(), "observePorts: one place per finger");
  PINCER_DEMAND(h > 0, "observePorts: the tick's length is positive");
  state.least_stored = state.started ? std::min(state.least_stored, stored) : stored;
  state.started = true;
  const double most = stored - state.least_stored + options.reserve;
  for (std::size_t i = 0; i < p_WF.size(); ++i) {
    PortState& port = state.ports[i];
    const Vec3 way = port.seen ? Vec3(p_WF[i] - port.p_W) : Vec3::Zero();
    const double in = -port.f_held_W.dot(way);
    port.energy += in;
    const double credit = in + armOf(options, i).damping * way.squaredNorm() / h;
    port.balance = std::min(port.balance + credit, most);
    state.balance += credit;
    port.p_W = p_WF[i];
    port.v_W = way / h;
    port.seen = true;
  }
  state.balance = std::min(state.balance, most);
}

void controlPorts(const PassivityOptions& options, double h, PassivityState& state, std::span<Vec3> f_W) {
  if (!options.on) return;
  PINCER_DEMAND(f_W.size() == state.ports.size(), "controlPorts: one force per finger");
  PINCER_DEMAND(h > 0, "controlPorts: the tick's length is positive");
  bool acted = dampSum(options, h, state, f_W);
  if (options.each) acted |= dampEach(options, h, state, f_W);
  if (options.bound) acted |= boundSum(options, h, state, f_W);
  if (options.bound && options.each) acted |= boundEach(options, h, state, f_W);
  state.acted += acted;
}

void holdPorts(std::span<const Vec3> f_W, PassivityState& state) {
  PINCER_DEMAND(f_W.size() == state.ports.size(), "holdPorts: one force per finger");
  for (std::size_t i = 0; i < f_W.size(); ++i) state.ports[i].f_held_W = f_W[i];
}

}  // namespace pincer::grasp
