#include "pincer/tasks/judge/exact/linkages.h"

#include <Eigen/Dense>
#include <cmath>

#include "pincer/contact/elementary.h"
#include "pincer/tasks/judge/exact/runge_kutta.h"

namespace pincer::exact {
namespace {

constexpr double kFineStep = 2e-5;  // [s]

using Long = Eigen::Array<long double, Eigen::Dynamic, 1>;

// Beyond double precision by the first two terms about the double next to x: off by
// 1e-16 at most, as our own functions are.
long double sine(long double x) {
  const auto near = static_cast<double>(x);
  return math::sin(near) + (x - near) * math::cos(near);
}
long double cosine(long double x) {
  const auto near = static_cast<double>(x);
  return math::cos(near) - (x - near) * math::sin(near);
}

// Steps of at most kFineStep from 0 to `time`.
template <typename State, typename Slope>
State integrated(State y, double time, const Slope& slope) {
  const auto steps = static_cast<long>(std::ceil(time / kFineStep));
  const double h = steps > 0 ? time / static_cast<double>(steps) : 0;
  for (long n = 0; n < steps; ++n) y = rungeKutta(y, 0.0, h, slope);
  return y;
}

long double inertiaOf(const RodChain& chain, int i, int j) {
  const long double unit = static_cast<long double>(chain.mass) * chain.length * chain.length;
  return unit * (i == j ? chain.rods - i - 2.0L / 3 : chain.rods - std::max(i, j) - 0.5L);
}
long double weightOf(const RodChain& chain, int i) {
  return static_cast<long double>(chain.mass) * chain.g * chain.length * (chain.rods - i - 0.5L);
}

}  // namespace

std::vector<double> RodChain::angles(const std::vector<double>& start, double time) const {
  const int n = rods;
  const auto slope = [&](double, const Long& y) {
    Eigen::Matrix<long double, Eigen::Dynamic, Eigen::Dynamic> M(n, n);
    Eigen::Matrix<long double, Eigen::Dynamic, 1> f(n);
    for (int i = 0; i < n; ++i) {
      f[i] = -weightOf(*this, i) * sine(y[i]);
      for (int j = 0; j < n; ++j) {
        M(i, j) = inertiaOf(*this, i, j) * cosine(y[i] - y[j]);
        f[i] -= inertiaOf(*this, i, j) * sine(y[i] - y[j]) * y[n + j] * y[n + j];
      }
    }
    Long out(2 * n);
    out << y.tail(n), M.llt().solve(f).array();
    return out;
  };
  Long y = Long::Zero(2 * n);
  for (int i = 0; i < n; ++i) y[i] = start[static_cast<std::size_t>(i)];
  y = integrated(y, time, slope);
  std::vector<double> out;
  for (int i = 0; i < n; ++i) out.push_back(static_cast<double>(y[i]));
  return out;
}

double RodChain::energy(const std::vector<double>& angles, const std::vector<double>& rates) const {
  long double sum = 0;
  for (int i = 0; i < rods; ++i) {
    const auto a = static_cast<std::size_t>(i);
    sum += weightOf(*this, i) * (1 - cosine(static_cast<long double>(angles[a])));
    for (int j = 0; j < rods; ++j) {
      const auto b = static_cast<std::size_t>(j);
      sum +=
          0.5L * inertiaOf(*this, i, j) * cosine(static_cast<long double>(angles[a] - angles[b])) * rates[a] * rates[b];
    }
  }
  return static_cast<double>(sum);
}

double EllipticPendulum::angle(double start, double time) const {
  const long double share = static_cast<long double>(mass) / (block + mass),
                    lever = static_cast<long double>(mass) * distance;
  using State = Eigen::Array<long double, 2, 1>;
  const State y = integrated(State(start, 0), time, [&](double, const State& at) {
    const long double c = cosine(at[0]), s = sine(at[0]);
    const long double inert = inertia + lever * distance * (1 - share * c * c);
    return State(at[1], -(lever * g * s + lever * distance * share * s * c * at[1] * at[1]) / inert);
  });
  return static_cast<double>(y[0]);
}

double EllipticPendulum::way(double start, double angle) const {
  return mass / (block + mass) * distance * (math::sin(start) - math::sin(angle));
}

double DampedOscillator::place(double x_0, double v_0, double time) const {
  const double decay = d / (2 * m), square = k / m - decay * decay;  // of the frequency; negative where it creeps back
  const double v = v_0 + decay * x_0, root = std::sqrt(std::abs(square)), x = root * time;
  if (square > 0) return math::exp(-decay * time) * (x_0 * math::cos(x) + v / root * math::sin(x));
  if (square == 0) return math::exp(-decay * time) * (x_0 + v * time);
  const double up = math::exp((root - decay) * time), down = math::exp(-(root + decay) * time);
  return 0.5 * (x_0 * (up + down) + v / root * (up - down));
}

namespace {

double square(double x) { return x * x; }

template <typename Inertia>
double angleAfter(double start, double rate, double time, const Inertia& inertia) {
  const double momentum = rate * std::sqrt(inertia(start));
  return integrated(start, time, [&](double, double a) { return momentum / std::sqrt(inertia(a)); });
}

}  // namespace

double FourBar::rockerAngle(double angle) const {
  const double k1 = ground / crank, k2 = ground / rocker;
  const double k3 = (square(crank) - square(coupler) + square(rocker) + square(ground)) / (2 * crank * rocker);
  const double c = math::cos(angle), A = c - k1 - k2 * c + k3, B = -2 * math::sin(angle), C = k1 - (k2 + 1) * c + k3;
  return 2 * math::atan2(-B - std::sqrt(B * B - 4 * A * C), 2 * A);
}

double FourBar::miss(double angle, double rocker_angle) const {
  const double k3 = (square(crank) - square(coupler) + square(rocker) + square(ground)) / (2 * crank * rocker);
  return ground / crank * math::cos(rocker_angle) - ground / rocker * math::cos(angle) + k3 -
         math::cos(angle - rocker_angle);
}

double FourBar::ratio(double angle) const {
  const double b = rockerAngle(angle), x = ground + rocker * math::cos(b) - crank * math::cos(angle),
               y = rocker * math::sin(b) - crank * math::sin(angle);
  // The coupler doesn't stretch: (x, y) . d(x, y)/da = 0.
  return crank * (y * math::cos(angle) - x * math::sin(angle)) / (rocker * (y * math::cos(b) - x * math::sin(b)));
}

double FourBar::inertia(double angle) const {
  const double b = rockerAngle(angle), r = ratio(angle);
  const double ax = -crank * math::sin(angle), ay = crank * math::cos(angle), bx = -r * rocker * math::sin(b),
               by = r * rocker * math::cos(b);
  const double turn = std::sqrt(square(bx - ax) + square(by - ay)) / coupler;
  return crank_inertia + rocker_inertia * r * r + coupler_inertia * turn * turn +
         coupler_mass * 0.25 * (square(ax + bx) + square(ay + by));
}

double FourBar::angle(double start, double rate, double time) const {
  return angleAfter(start, rate, time, [&](double a) { return inertia(a); });
}

double SliderCrank::place(double angle) const {
  return crank * math::cos(angle) + std::sqrt(square(rod) - square(crank * math::sin(angle)));
}

double SliderCrank::inertia(double angle) const {
  const double ax = -crank * math::sin(angle), ay = crank * math::cos(angle), across = crank * math::sin(angle);
  const double along = std::sqrt(square(rod) - square(across)), slide = ax - across * ay / along, turn = ay / along;
  return crank_inertia + slider_mass * slide * slide + rod_inertia * turn * turn +
         rod_mass * 0.25 * (square(ax + slide) + ay * ay);
}

double SliderCrank::angle(double start, double rate, double time) const {
  return angleAfter(start, rate, time, [&](double a) { return inertia(a); });
}

}  // namespace pincer::exact
