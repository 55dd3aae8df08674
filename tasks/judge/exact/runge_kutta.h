// runge_kutta: the classical method of 4th order, for the exact equations of motion that have no closed form.
#pragma once

namespace pincer::exact {

// One step of y' = f(t, y).
template <typename State, typename Slope>
State rungeKutta(const State& y, double t, double h, const Slope& f) {
  const State k1 = f(t, y);
  const State k2 = f(t + 0.5 * h, State(y + 0.5 * h * k1));
  const State k3 = f(t + 0.5 * h, State(y + 0.5 * h * k2));
  const State k4 = f(t + h, State(y + h * k3));
  return y + (h / 6) * (k1 + 2 * k2 + 2 * k3 + k4);
}

// The same until when(y) turns from negative to positive; the time of that is found by halving the last step 60 times.
template <typename State>
struct Passage {
  double t;
  State y;
};
template <typename State, typename Slope, typename When>
Passage<State> integrateUntil(State y, double h, const Slope& f, const When& when) {
  double t = 0;
  State next = rungeKutta(y, t, h, f);
  for (; !(when(next) >= 0); next = rungeKutta(y, t, h, f)) {
    y = next;
    t += h;
  }
  double low = 0, high = h;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (when(rungeKutta(y, t, middle, f)) < 0 ? low : high) = middle;
  }
  return {t + low, rungeKutta(y, t, low, f)};
}

}  // namespace pincer::exact
