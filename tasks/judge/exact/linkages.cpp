#include "pincer/tasks/judge/exact/linkages.h"

#include <Eigen/Dense>
#include <cmath>
#include <complex>

#include "pincer/tasks/judge/exact/runge_kutta.h"

namespace pincer::exact {
namespace {

constexpr double kFineStep = 2e-5;  // [s]

using Long = Eigen::Array<long double, Eigen::Dynamic, 1>;

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
      f[i] = -weightOf(*this, i) * std::sin(y[i]);
      for (int j = 0; j < n; ++j) {
        M(i, j) = inertiaOf(*this, i, j) * std::cos(y[i] - y[j]);
        f[i] -= inertiaOf(*this, i, j) * std::sin(y[i] - y[j]) * y[n + j] * y[n + j];
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
    sum += weightOf(*this, i) * (1 - std::cos(static_cast<long double>(angles[a])));
    for (int j = 0; j < rods; ++j) {
      const auto b = static_cast<std::size_t>(j);
      sum += 0.5L * inertiaOf(*this, i, j) * std::cos(static_cast<long double>(angles[a] - angles[b])) * rates[a] * rates[b];
    }
  }
  return static_cast<double>(sum);
}

double EllipticPendulum::angle(double start, double time) const {
  const long double share = static_cast<long double>(mass) / (block + mass), lever = static_cast<long double>(mass) * distance;
  using State = Eigen::Array<long double, 2, 1>;
  const State y = integrated(State(start, 0), time, [&](double, const State& at) {
    const long double c = std::cos(at[0]), s = std::sin(at[0]);
    const long double inert = inertia + lever * distance * (1 - share * c * c);
    return State(at[1], -(lever * g * s + lever * distance * share * s * c * at[1] * at[1]) / inert);
  });
  return static_cast<double>(y[0]);
}

double EllipticPendulum::way(double start, double angle) const {
  return mass / (block + mass) * distance * (std::sin(start) - std::sin(angle));
}

double DampedOscillator::place(double x_0, double v_0, double time) const {
  using Complex = std::complex<double>;
  const Complex root = std::sqrt(Complex(d * d - 4 * k * m)), p = (-d + root) / (2 * m), q = (-d - root) / (2 * m);
  const Complex b = (p * x_0 - v_0) / (p - q), a = x_0 - b;
  return (a * std::exp(p * time) + b * std::exp(q * time)).real();
}

}  // namespace pincer::exact
