#include "pincer/tasks/judge/exact/pinch.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "pincer/contact/functions/invariants.h"
#include "pincer/tasks/judge/exact/runge_kutta.h"

namespace pincer::exact {
namespace {

struct Target {
  double height, velocity;
};

Target minimumJerk(double height, double reach_time, double t) {
  if (t <= 0) return {0, 0};
  if (t >= reach_time) return {height, 0};
  const double s = t / reach_time;
  return {height * s * s * s * (10 - 15 * s + 6 * s * s), height / reach_time * 30 * s * s * (1 - s) * (1 - s)};
}

}  // namespace

double SlidingPinch::acceleration(double d, double v) const {
  const double L = sphere_radius + finger_radius;
  PINCER_ASSERT(std::abs(d) < L);  // else the fingers have met
  const double x = std::sqrt(L * L - d * d);
  const double s = d / L, c = x / L;
  // [sphere_mass, -2 (s - mu c); finger_mass d/x, c + mu s] [d''; N] = [sphere_mass
  // g; F - finger_mass (v^2/x + d^2 v^2/x^3)]
  const double a12 = -2 * (s - mu * c), a21 = finger_mass * d / x, a22 = c + mu * s;
  const double b1 = sphere_mass * g, b2 = force - finger_mass * v * v * (1 / x + d * d / (x * x * x));
  return (b1 * a22 - a12 * b2) / (sphere_mass * a22 - a12 * a21);
}

double SlidingPinch::dropTime(double depth) const {
  using State = Vec2;  // (d, d')
  const auto slope = [this](double, const State& y) { return State(y[1], acceleration(y[0], y[1])); };
  return integrateUntil<State>(State::Zero(), 1e-5, slope, [&](const State& y) { return y[0] - depth; }).t;
}

std::vector<double> StuckLift::rises(int ticks, double h) const {
  using State = Vec2;  // (z, z')
  const auto slope = [this](double t, const State& y) {
    const Target target = minimumJerk(height, reach_time, t - start_time);
    return State(y[1], 2 / total_mass * (stiffness * (target.height - y[0]) + damping * (target.velocity - y[1])));
  };
  constexpr int kSteps = 20;  // of Runge and Kutta in a tick: their error falls with the fourth power; chosen
  std::vector<double> heights;
  State y = State::Zero();
  for (int i = 0; i < ticks; ++i) {
    for (int k = 0; k < kSteps; ++k) y = rungeKutta(y, h * (i + static_cast<double>(k) / kSteps), h / kSteps, slope);
    heights.push_back(y[0]);
  }
  return heights;
}

double leastFrictionOfOffsetPlate(double mass, double offset, double torsion_radius, double force, double g) {
  return 0.5 * mass * g * math::hypot(1.0, offset / torsion_radius) / force;
}

PlateRest slidingSpinningPlate(double mass, double inertia, double torsion_radius, double friction_force,
                               const Vec2& v0, double w0) {
  using State = Eigen::Matrix<double, 6, 1>;                                                       // (p, angle, v, w)
  const auto slip = [&](const State& y) { return Vec2(y[3] + y[5] * y[1], y[4] - y[5] * y[0]); };  // v + w x (-p)
  const auto speed = [&](const State& y) { return math::hypot(slip(y).norm(), torsion_radius * y[5]); };
  const auto slope = [&](double, const State& y) {
    const Vec2 f = -friction_force / speed(y) * slip(y);
    const double moment =
        -friction_force * torsion_radius * torsion_radius * y[5] / speed(y) - y[0] * f[1] + y[1] * f[0];
    State dy;
    dy << y[3], y[4], y[5], f / mass, moment / inertia;
    return dy;
  };
  State y;
  y << 0, 0, 0, v0, w0;
  constexpr double kStep = 2e-6, kAtRest = 1e-7;  // [s]; slip at which it rests [m/s]; chosen
  double t = 0;
  for (double s = speed(y); s > kAtRest; s = speed(y)) {
    // finer towards the end, where the direction may still turn
    const double h = std::min(kStep, 0.1 * s * mass / friction_force);
    y = rungeKutta(y, t, h, slope);
    t += h;
  }
  return {y.head<2>(), y[2], t};
}

Vec2 ShakenGrip::target(double time) const {
  return swing * std::min(time, 1.0) * math::sin(2 * M_PI * hertz * time) * along;
}

Vec2 ShakenGrip::targetSpeed(double time) const {
  const double w = 2 * M_PI * hertz, grows = time < 1 ? math::sin(w * time) : 0;
  return swing * (std::min(time, 1.0) * w * math::cos(w * time) + grows) * along;
}

namespace {

constexpr double kShakenStep = 4e-6;  // [s]
constexpr int kCorners = 4, kShakenSweeps = 20;

// Box and pads, from where they hang at rest.
struct ShakenState {
  Vec2 p_box, p_pad, v_box = Vec2::Zero(), v_pad = Vec2::Zero();
  double angle = 0, rate = 0;
  std::array<Vec2, kCorners> arm, impulse;  // rho_i; F_i times the step

  explicit ShakenState(const ShakenGrip& grip) : p_box(0, -0.5 * grip.mass * grip.g / grip.stiffness), p_pad(p_box) {
    impulse.fill(Vec2::Zero());
  }

  // One step with friction of at most `most` in all [N].
  void step(const ShakenGrip& grip, double time, double most) {
    const Vec2 spring =
        2 * grip.stiffness * (grip.target(time) - p_pad) + 2 * grip.damping * (grip.targetSpeed(time) - v_pad);
    v_box += kShakenStep * Vec2(0, -grip.g);
    v_pad += kShakenStep / (2 * grip.pad_mass) * spring;
    rub(grip, most * kShakenStep / kCorners);
    p_box += kShakenStep * v_box;
    p_pad += kShakenStep * v_pad;
    angle += kShakenStep * rate;
  }
  // In the last step [N].
  double friction() const { return (impulse[0] + impulse[1] + impulse[2] + impulse[3]).norm() / kShakenStep; }

 private:
  void push(const ShakenGrip& grip, const Vec2& at, const Vec2& by) {
    v_box += by / grip.mass;
    v_pad -= by / (2 * grip.pad_mass);
    rate += (at.x() * by.y() - at.y() * by.x()) / grip.inertia;
  }
  void rub(const ShakenGrip& grip, double most) {
    for (std::size_t i = 0; i < kCorners; ++i) {
      arm[i] = p_pad - p_box + grip.corner * Vec2(i & 1 ? 1 : -1, i & 2 ? 1 : -1);
      push(grip, arm[i], impulse[i]);
    }
    for (int sweep = 0; sweep < kShakenSweeps; ++sweep) {
      for (std::size_t i = 0; i < kCorners; ++i) relax(grip, i, most);
    }
  }
  void relax(const ShakenGrip& grip, std::size_t i, double most) {
    const double mobility = 1 / grip.mass + 0.5 / grip.pad_mass + arm[i].squaredNorm() / grip.inertia;
    const Vec2 slip = v_box + rate * Vec2(-arm[i].y(), arm[i].x()) - v_pad;
    Vec2 next = impulse[i] - slip / mobility;
    if (next.norm() > most) next *= most / next.norm();
    push(grip, arm[i], next - impulse[i]);
    impulse[i] = next;
  }
};

}  // namespace

double ShakenGrip::leastFriction(double seconds) const {
  ShakenState state(*this);
  double most = 0;
  for (int i = 0; i < seconds / kShakenStep; ++i) {
    state.step(*this, (i + 0.5) * kShakenStep, std::numeric_limits<double>::infinity());
    most = std::max(most, state.friction());
  }
  return most / (2 * press);
}

std::vector<ShakenGrip::Slip> ShakenGrip::slips(int ticks, double h) const {
  ShakenState state(*this);
  std::vector<Slip> slips;
  const int steps = static_cast<int>(h / kShakenStep + 0.5);
  for (int i = 0; i < ticks * steps; ++i) {
    state.step(*this, (i + 0.5) * kShakenStep, 2 * mu * press);
    if ((i + 1) % steps == 0) slips.push_back({state.p_box - state.p_pad, state.angle});
  }
  return slips;
}

}  // namespace pincer::exact
