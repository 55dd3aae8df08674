#include "tests/accuracy/exact_solutions.h"

#include <cmath>

namespace pincer::exact {
namespace {

// One step of the classical Runge-Kutta method for y' = f(t, y).
template <typename State, typename Slope>
State rungeKutta(const State& y, double t, double h, const Slope& f) {
  const State k1 = f(t, y);
  const State k2 = f(t + 0.5 * h, State(y + 0.5 * h * k1));
  const State k3 = f(t + 0.5 * h, State(y + 0.5 * h * k2));
  const State k4 = f(t + h, State(y + h * k3));
  return y + (h / 6) * (k1 + 2 * k2 + 2 * k3 + k4);
}

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

double SlideToRoll::position(double t) const {
  const double t_roll = transitionTime();
  if (t < t_roll) return v0 * t - 0.5 * mu * g * t * t;
  return 12 * v0 * v0 / (49 * mu * g) + 5.0 / 7 * v0 * (t - t_roll);
}

double SlideToRoll::velocity(double t) const { return t < transitionTime() ? v0 - mu * g * t : 5.0 / 7 * v0; }

double Slope::acceleration() const { return g * (std::sin(theta) - mu * std::cos(theta)); }

double SlidingPinch::acceleration(double d, double v) const {
  const double L = sphere_radius + finger_radius;
  const double x = std::sqrt(L * L - d * d);
  const double s = d / L, c = x / L;
  // [sphere_mass, -2 (s - mu c); finger_mass d/x, c + mu s] [d''; N] = [sphere_mass g; F - finger_mass (v^2/x + d^2 v^2/x^3)]
  const double a12 = -2 * (s - mu * c), a21 = finger_mass * d / x, a22 = c + mu * s;
  const double b1 = sphere_mass * g, b2 = force - finger_mass * v * v * (1 / x + d * d / (x * x * x));
  return (b1 * a22 - a12 * b2) / (sphere_mass * a22 - a12 * a21);
}

double SlidingPinch::dropTime(double depth) const {
  using State = Vec2;  // (d, d')
  const auto slope = [this](double, const State& y) { return State(y[1], acceleration(y[0], y[1])); };
  constexpr double kStep = 1e-5;
  State y = State::Zero();
  long steps = 0;
  for (;;) {
    const State next = rungeKutta(y, 0, kStep, slope);
    if (next[0] >= depth) break;
    y = next;
    ++steps;
  }
  double low = 0, high = kStep;  // the depth is reached within this step
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (rungeKutta(y, 0, middle, slope)[0] < depth ? low : high) = middle;
  }
  return static_cast<double>(steps) * kStep + low;
}

std::vector<double> StuckLift::rises(int ticks, double h) const {
  using State = Vec2;  // (z, z')
  const auto slope = [this](double t, const State& y) {
    const Target target = minimumJerk(height, reach_time, t - start_time);
    return State(y[1], 2 / total_mass * (stiffness * (target.height - y[0]) + damping * (target.velocity - y[1])));
  };
  constexpr int kSteps = 20;
  std::vector<double> heights;
  State y = State::Zero();
  for (int i = 0; i < ticks; ++i) {
    for (int k = 0; k < kSteps; ++k) y = rungeKutta(y, h * (i + static_cast<double>(k) / kSteps), h / kSteps, slope);
    heights.push_back(y[0]);
  }
  return heights;
}

Quat freeRotation(const Vec3& moments, const Vec3& w_B, double time) {
  using State = Eigen::Matrix<double, 7, 1>;  // (w, q as x y z w)
  const auto slope = [&](double, const State& y) {
    const Vec3 w = y.head<3>();
    const Quat spin(0, w.x(), w.y(), w.z());
    State dy;
    dy.head<3>() = moments.cwiseProduct(w).cross(w).cwiseQuotient(moments);
    dy.tail<4>() = 0.5 * (Quat(y.tail<4>()) * spin).coeffs();
    return dy;
  };
  const int steps = static_cast<int>(std::lround(time / 2e-5));
  State y;
  y << w_B, 0, 0, 0, 1;
  for (int i = 0; i < steps; ++i) y = rungeKutta(y, 0, time / steps, slope);
  return Quat(y.tail<4>()).normalized();
}

}  // namespace pincer::exact
